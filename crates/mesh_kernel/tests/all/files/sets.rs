//! Files that belong together.

use std::fs;

use mesh_kernel::files::FileSet;

#[test]
fn sets_are_placed_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two, taken] = ["one", "two", "taken"].map(|n| folder.path().join(n));
    fs::write(&one, "old").unwrap();
    let mut set = FileSet::default();
    set.add(&one, b"new").unwrap();
    set.add(&two, b"new").unwrap();
    assert_eq!(fs::read(&one).unwrap(), b"old", "not yet");
    set.place().unwrap();
    assert_eq!((fs::read(&one).unwrap(), fs::read(&two).unwrap()), (b"new".to_vec(), b"new".to_vec()));

    fs::create_dir(&taken).unwrap();
    let mut set = FileSet::default();
    set.add(&one, b"newer").unwrap();
    set.add(&taken, b"newer").unwrap();
    assert_eq!(set.place().unwrap_err().path, taken);
    let mut set = FileSet::default();
    set.add(&one, b"newer").unwrap();
    assert!(set.add(&folder.path().join("no/where"), b"newer").is_err());
    assert_eq!(set.add(&one, b"another").unwrap_err().path, one, "two for one place");
    drop(set);
    assert_eq!(fs::read(&one).unwrap(), b"new");
    let mut names: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["one", "taken", "two"], "nothing is left over");
}
