//! Atomic replacement of files: new content is written to a temporary file in the same folder, which is then
//! renamed, so that readers and a power failure find either the old file or the new one. Independent of the
//! content of the files.
use std::{
    fs::{self, Permissions},
    io::{self, Write},
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};
use tempfile::NamedTempFile;

/// New content of a file, complete and synchronised to disk, that has not yet replaced the target; deleted
/// unless [`Self::publish`] is called.
#[derive(Debug)]
pub struct Draft {
    file: NamedTempFile,
    place: PathBuf,
}

impl Draft {
    /// Writes the content to a temporary file beside the target. An existing target passes on its
    /// permissions; a symbolic link is followed.
    ///
    /// # Errors
    /// The error of the operating system; the temporary file is deleted.
    pub fn new(place: &Path, content: &[u8]) -> io::Result<Self> {
        let place = fs::canonicalize(place).unwrap_or_else(|_| place.to_owned());
        let permissions = match fs::metadata(&place) {
            Ok(there) => there.permissions(),
            // what a file gets that is simply created: the system takes the user's mask off
            Err(_) => Permissions::from_mode(0o666),
        };
        let folder = match place.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            Some(_) | None => Path::new("."),
        };
        let mut file = tempfile::Builder::new()
            .prefix(".horsehead-")
            .permissions(permissions)
            .tempfile_in(folder)?;
        file.write_all(content)?;
        file.as_file().sync_all()?;
        Ok(Self { file, place })
    }

    /// Creates a temporary file beside the target and has `fill` write its content.
    ///
    /// # Errors
    /// The error of the operating system or of `fill`; the temporary file is deleted.
    pub fn filled<E: From<io::Error>>(
        place: &Path,
        fill: impl FnOnce(fs::File) -> Result<(), E>,
    ) -> Result<Self, E> {
        let draft = Self::new(place, &[])?;
        fill(draft.file.reopen()?)?;
        draft.file.as_file().sync_all()?;
        Ok(draft)
    }

    /// Replaces the target file by the new content.
    ///
    /// # Errors
    /// The error of the operating system; the old file is kept.
    pub fn publish(self) -> io::Result<()> {
        let persisted = self.file.persist(self.place);
        persisted.map(drop).map_err(|failed| failed.error)
    }
}

/// Replaces or creates a file atomically.
///
/// # Errors
/// The error of the operating system; the old file is kept.
pub fn replace(place: &Path, content: &[u8]) -> io::Result<()> {
    Draft::new(place, content)?.publish()
}

#[cfg(test)]
mod tests {
    use super::{Draft, replace};
    use std::{
        fs,
        io::{self, Write as _},
        os::unix::fs::PermissionsExt as _,
    };

    #[test]
    fn a_file_is_replaced_whole_with_its_permissions_and_through_its_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("a.toml"), folder.path().join("b.toml"));
        replace(&file, b"one").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let draft = Draft::new(&link, b"two").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"one");
        draft.publish().unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"two");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(
            fs::metadata(&file).unwrap().permissions().mode() & 0o777,
            0o640
        );
        drop(Draft::new(&file, b"three").unwrap());
        assert_eq!(fs::read(&file).unwrap(), b"two");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        assert!(replace(&folder.path().join("no/such"), b"").is_err());
    }

    /// Checks that a full disk leaves the old file and no incomplete one.
    #[test]
    fn a_file_that_cannot_be_filled_leaves_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("report.csv");
        replace(&place, b"old").unwrap();
        let full = Draft::filled(&place, |mut file: fs::File| {
            file.write_all(b"half")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        assert_eq!(full.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read(&place).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        let whole = Draft::filled(&place, |mut file: fs::File| file.write_all(b"new"));
        whole.unwrap().publish().unwrap();
        assert_eq!(fs::read(&place).unwrap(), b"new");
    }

    /// Checks that a new file has the default permissions of the process.
    #[test]
    fn a_new_file_has_the_permissions_of_any_other() {
        let folder = tempfile::tempdir().unwrap();
        let (own, plain) = (folder.path().join("own"), folder.path().join("plain"));
        replace(&own, b"x").unwrap();
        fs::write(&plain, b"x").unwrap();
        let mode = |path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(own), mode(plain));
    }
}
