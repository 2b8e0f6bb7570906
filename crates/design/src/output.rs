//! Files made in memory, then put into a folder so that none is ever half-written.

use std::io;
use std::path::{Path, PathBuf};

use mesh_kernel::files::{FileSet, NotPlaced};

/// A file that is ready to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    /// Name inside the folder of results.
    pub name: std::borrow::Cow<'static, str>,
    /// All of its bytes.
    pub bytes: Vec<u8>,
}

/// A result that could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {path}: {source}", path = path.display())]
pub struct OutputError {
    /// The file or folder.
    pub path: PathBuf,
    /// What the system says.
    pub source: io::Error,
}

impl From<NotPlaced> for OutputError {
    fn from(NotPlaced { path, source }: NotPlaced) -> Self {
        Self { path, source }
    }
}

/// Writes `files` into `folder`, which is made when missing.
///
/// All are written beside their places before the first is renamed, so a failure leaves what was there.
///
/// # Errors
/// [`OutputError`] names the first file or folder that could not be written.
pub fn write_all(folder: &Path, files: &[OutputFile]) -> Result<(), OutputError> {
    let mut set = FileSet::default();
    add_all(&mut set, folder, files)?;
    Ok(set.place()?)
}

/// The same with a file that is made when all others are written beside their places, and put in its place last: what
/// says that all is done.
///
/// # Errors
/// As [`write_all`].
pub fn write_all_and(
    folder: &Path,
    files: &[OutputFile],
    last: impl FnOnce() -> Result<OutputFile, OutputError>,
) -> Result<(), OutputError> {
    let mut set = FileSet::default();
    add_all(&mut set, folder, files)?;
    add_all(&mut set, folder, &[last()?])?;
    Ok(set.place()?)
}

fn add_all(set: &mut FileSet, folder: &Path, files: &[OutputFile]) -> Result<(), OutputError> {
    std::fs::create_dir_all(folder).map_err(|source| OutputError { path: folder.to_path_buf(), source })?;
    for file in files {
        set.add(&folder.join(&*file.name), &file.bytes)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_appear_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("new/deep");
        let files = [
            OutputFile { name: "a.txt".into(), bytes: b"first".to_vec() },
            OutputFile { name: "b.txt".into(), bytes: b"second".to_vec() },
        ];
        write_all(&place, &files).unwrap();
        let mut names: Vec<_> = std::fs::read_dir(&place)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        assert_eq!(names, ["a.txt", "b.txt"]);
        assert_eq!(std::fs::read(place.join("b.txt")).unwrap(), b"second");
    }

    #[test]
    fn a_set_is_written_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path();
        std::fs::create_dir(place.join("taken")).unwrap();
        std::fs::write(place.join("a.txt"), "old").unwrap();
        let file = |name: &'static str| OutputFile { name: name.into(), bytes: b"new".to_vec() };
        let unmade =
            OutputError { path: place.join("report"), source: io::Error::other("it cannot be made") };
        assert!(write_all(place, &[file("a.txt"), file("taken")]).is_err());
        assert!(write_all_and(place, &[file("a.txt")], || Ok(file("taken"))).is_err());
        assert!(write_all_and(place, &[file("a.txt")], || Err(unmade)).is_err());
        assert_eq!(std::fs::read(place.join("a.txt")).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(place).unwrap().count(), 2, "nothing is left over");
        write_all_and(place, &[file("a.txt")], || Ok(file("report"))).unwrap();
        assert_eq!(std::fs::read(place.join("a.txt")).unwrap(), b"new");
        assert!(place.join("report").is_file());
    }

    #[test]
    fn a_folder_that_is_a_file_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("taken");
        std::fs::write(&file, "x").unwrap();
        let error = write_all(&file, &[]).unwrap_err();
        assert_eq!(error.path, file);
    }
}
