//! Files made in memory, then put into a folder so that none is ever half-written.

use std::io;
use std::path::{Path, PathBuf};

use mesh_kernel::files::write_atomically;

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

/// Writes `files` into `folder`, which is made when missing, in the order given: what says that all is done goes last.
///
/// Each file is written beside its place and renamed, so a failure leaves whole files or none.
///
/// # Errors
/// [`OutputError`] names the first file or folder that could not be written.
pub fn write_all(folder: &Path, files: &[OutputFile]) -> Result<(), OutputError> {
    let fail = |path: &Path| {
        let path = path.to_path_buf();
        move |source| OutputError { path, source }
    };
    std::fs::create_dir_all(folder).map_err(fail(folder))?;
    for file in files {
        let path = folder.join(&*file.name);
        write_atomically(&path, &file.bytes).map_err(fail(&path))?;
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
    fn a_folder_that_is_a_file_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("taken");
        std::fs::write(&file, "x").unwrap();
        let error = write_all(&file, &[]).unwrap_err();
        assert_eq!(error.path, file);
    }
}
