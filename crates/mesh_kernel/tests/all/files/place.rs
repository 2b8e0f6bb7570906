//! Files put in place: links, permissions, what is no file.
#![cfg(unix)]

use std::fs;
use std::io::ErrorKind;
use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _, symlink};
use std::path::Path;

use mesh_kernel::files::write_atomically;

#[test]
fn links_stay_links_and_what_they_lead_to_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let [file, link, far, new] = ["file", "link", "far", "new"].map(|n| folder.path().join(n));
    fs::create_dir(folder.path().join("deep")).unwrap();
    fs::write(&file, "old").unwrap();
    symlink("../file", folder.path().join("deep/near")).unwrap();
    symlink("deep/near", &link).unwrap();
    write_atomically(&link, b"new").unwrap();
    assert_eq!(fs::read(&file).unwrap(), b"new");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    symlink("new", &far).unwrap();
    write_atomically(&far, b"first").unwrap();
    assert_eq!(fs::read(&new).unwrap(), b"first");
    let [here, there] = ["here", "there"].map(|n| folder.path().join(n));
    symlink("there", &here).unwrap();
    symlink("here", &there).unwrap();
    assert!(write_atomically(&here, b"round").is_err());
    assert!(!fs::read_dir(folder.path()).unwrap().flatten().any(|e| e.path().extension().is_some()));
}

#[test]
fn permissions_stay() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("own");
    fs::write(&file, "old").unwrap();
    for mode in [0o600, 0o640, 0o664] {
        fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
        write_atomically(&file, b"new").unwrap();
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, mode);
        assert_eq!(fs::read(&file).unwrap(), b"new");
    }
    fs::set_permissions(&file, fs::Permissions::from_mode(0o444)).unwrap();
    assert_eq!(write_atomically(&file, b"newer").unwrap_err().kind(), ErrorKind::PermissionDenied);
    assert_eq!(fs::read(&file).unwrap(), b"new");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// What a program has open is written on, by whatever links it is called.
#[test]
fn what_is_open_keeps_what_it_held() {
    use std::os::fd::AsRawFd as _;
    let folder = tempfile::tempdir().unwrap();
    let [file, link] = ["file", "link"].map(|n| folder.path().join(n));
    fs::write(&file, "old ").unwrap();
    let open = fs::File::options().append(true).open(&file).unwrap();
    symlink(format!("/dev/fd/{}", open.as_raw_fd()), &link).unwrap();
    write_atomically(&link, b"new").unwrap();
    assert_eq!(fs::read(&file).unwrap(), b"old new");
    // Memory that systems lend as a disk has files as any other.
    if let Ok(folder) = tempfile::tempdir_in("/dev/shm") {
        let file = folder.path().join("file");
        write_atomically(&file, b"old").unwrap();
        write_atomically(&file, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
    }
}

#[test]
fn what_is_no_file_is_written_and_stays() {
    write_atomically(Path::new("/dev/null"), b"gone").unwrap();
    assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
}
