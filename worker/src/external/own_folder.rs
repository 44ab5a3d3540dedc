//! Folder for temporary files that other users of the machine cannot enter, below a parent that they may write to.
//!
//! A stranger may have put anything at a name in the system's folder for temporary files: a symbolic link, a folder
//! of his own, a lock that he holds. The folder is therefore used only if it belongs to this user and is closed to
//! all others, and everything in it is opened and deleted relative to a descriptor of it, without following links.
use rustix::{
    fs::{
        AtFlags, Dir, FileType, Mode, OFlags, Stat, fstat, mkdir, open, openat, statat, unlinkat,
    },
    io::Errno,
    process::geteuid,
};
use std::{
    ffi::CStr,
    fs, io,
    os::fd::{AsFd, BorrowedFd, OwnedFd},
    path::{Path, PathBuf},
};

const FOLDER: OFlags = OFlags::DIRECTORY
    .union(OFlags::NOFOLLOW)
    .union(OFlags::CLOEXEC);

/// Maximum number of names that are tried for a new folder.
const TRIES: u32 = 100;

/// Returns the folder of this user below `parent` and creates it if there is none: `horsehead-UID` or, if a stranger
/// has taken that name, one with a random suffix, which later processes use as well.
///
/// # Errors
/// The error of the operating system if no folder can be created.
pub(super) fn below(parent: &Path) -> io::Result<PathBuf> {
    let plain = plain_name();
    for try_number in 0..TRIES {
        if let Some(found) = existing(parent) {
            return Ok(found);
        }
        let name = if try_number == 0 {
            plain.clone()
        } else {
            format!("{plain}-{}", random()?)
        };
        match mkdir(parent.join(name), Mode::RWXU) {
            // two processes that create folders at the same time agree on the first of them
            Ok(()) | Err(Errno::EXIST) => {}
            Err(error) => return Err(error.into()),
        }
    }
    let message = format!(
        "no folder of this user's own can be made in {}",
        parent.display()
    );
    Err(io::Error::other(message))
}

/// Returns the first name that [`below`] tries.
fn plain_name() -> String {
    format!("horsehead-{}", geteuid().as_raw())
}

/// Returns the first folder below `parent` by name that [`below`] has created for this user; `None` if there is none.
pub(super) fn existing(parent: &Path) -> Option<PathBuf> {
    let plain = plain_name();
    let entries = fs::read_dir(parent).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| {
            let rest = name.strip_prefix(&plain);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
        })
        .collect();
    names.sort();
    let mut paths = names.iter().map(|name| parent.join(name));
    paths.find(|path| {
        let folder = open(path, FOLDER, Mode::empty());
        folder.is_ok_and(|folder| is_private(&folder))
    })
}

fn is_private(folder: &OwnedFd) -> bool {
    fstat(folder).is_ok_and(|found| {
        let all = Mode::RWXU | Mode::RWXG | Mode::RWXO;
        let mode = Mode::from_raw_mode(found.st_mode) & all;
        found.st_uid == geteuid().as_raw() && mode == Mode::RWXU
    })
}

/// Returns eight random hexadecimal digits.
fn random() -> io::Result<String> {
    let mut bytes = [0; 4];
    io::Read::read_exact(&mut fs::File::open("/dev/urandom")?, &mut bytes)?;
    Ok(format!("{:08x}", u32::from_ne_bytes(bytes)))
}

/// Folder that is open for deletion of what is in it.
pub(super) struct OpenFolder(OwnedFd);

impl OpenFolder {
    /// Opens a folder of this user; a symbolic link is not followed.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        Self::checked(open(path, FOLDER, Mode::empty())?)
    }

    /// Opens a folder of this user in this one; a symbolic link is not followed.
    pub(super) fn folder(&self, name: &CStr) -> io::Result<Self> {
        Self::checked(openat(&self.0, name, FOLDER, Mode::empty())?)
    }

    fn checked(folder: OwnedFd) -> io::Result<Self> {
        if fstat(&folder)?.st_uid == geteuid().as_raw() {
            Ok(Self(folder))
        } else {
            Err(io::ErrorKind::PermissionDenied.into())
        }
    }

    /// Opens a file in this folder for reading; a symbolic link is not followed.
    pub(super) fn file(&self, name: &CStr) -> io::Result<fs::File> {
        let flags = OFlags::RDONLY | OFlags::NOFOLLOW | OFlags::CLOEXEC | OFlags::NONBLOCK;
        Ok(openat(&self.0, name, flags, Mode::empty())?.into())
    }

    /// Returns whether the folder has an entry of this name.
    pub(super) fn has(&self, name: &CStr) -> bool {
        statat(&self.0, name, AtFlags::SYMLINK_NOFOLLOW).is_ok()
    }

    /// Returns the attributes of the folder itself.
    pub(super) fn attributes(&self) -> io::Result<Stat> {
        Ok(fstat(&self.0)?)
    }

    /// Returns the names of the entries of this folder that satisfy a condition.
    pub(super) fn names(&self, wanted: impl Fn(&CStr) -> bool) -> io::Result<Vec<Box<CStr>>> {
        let mut names = Vec::new();
        for entry in Dir::read_from(&self.0)? {
            let entry = entry?;
            let name = entry.file_name();
            if name != c"." && name != c".." && wanted(name) {
                names.push(name.into());
            }
        }
        Ok(names)
    }

    /// Deletes a folder in this one with all that is in it, the entry `last` at the end: if this process is killed
    /// meanwhile, what is left still has that entry.
    pub(super) fn remove(&self, name: &CStr, last: &CStr) -> io::Result<()> {
        let folder = self.folder(name)?;
        for entry in folder.names(|entry| entry != last)? {
            remove_entry(folder.0.as_fd(), &entry)?;
        }
        if folder.has(last) {
            remove_entry(folder.0.as_fd(), last)?;
        }
        unlinkat(&self.0, name, AtFlags::REMOVEDIR)?;
        Ok(())
    }
}

/// Deletes an entry of a folder with all that is in it; of a symbolic link the link alone.
fn remove_entry(folder: BorrowedFd<'_>, name: &CStr) -> io::Result<()> {
    let found = statat(folder, name, AtFlags::SYMLINK_NOFOLLOW)?;
    if FileType::from_raw_mode(found.st_mode) != FileType::Directory {
        return Ok(unlinkat(folder, name, AtFlags::empty())?);
    }
    let inner = OpenFolder(openat(folder, name, FOLDER, Mode::empty())?);
    for entry in inner.names(|_| true)? {
        remove_entry(inner.0.as_fd(), &entry)?;
    }
    Ok(unlinkat(folder, name, AtFlags::REMOVEDIR)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    /// Checks that a folder with the expected name is used only if it is this user's own and closed, and that
    /// otherwise all processes use the same other one.
    #[test]
    fn a_name_that_a_stranger_has_taken_is_not_used() {
        let victim = tempfile::tempdir().unwrap();
        let name = format!("horsehead-{}", geteuid().as_raw());
        for trap in ["nothing", "a link", "an open folder"] {
            let parent = tempfile::tempdir().unwrap();
            let place = parent.path().join(&name);
            match trap {
                "nothing" => {}
                "a link" => symlink(victim.path(), &place).unwrap(),
                _ => {
                    fs::create_dir(&place).unwrap();
                    fs::set_permissions(&place, fs::Permissions::from_mode(0o755)).unwrap();
                }
            }
            let own = below(parent.path()).unwrap();
            assert_eq!(own == place, trap == "nothing", "{trap}");
            let mode = fs::symlink_metadata(&own).unwrap().permissions().mode();
            assert_eq!(mode & 0o777, 0o700);
            assert_eq!(below(parent.path()).unwrap(), own, "again");
        }
    }

    #[test]
    fn what_a_link_leads_to_is_not_deleted() {
        let (parent, victim) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let precious = victim.path().join("precious");
        fs::write(&precious, "").unwrap();
        let run = parent.path().join("run");
        fs::create_dir_all(run.join("a/b")).unwrap();
        fs::write(run.join("a/b/c"), "").unwrap();
        symlink(victim.path(), run.join("a/link")).unwrap();
        symlink(victim.path(), parent.path().join("other")).unwrap();
        let own = OpenFolder::open(parent.path()).unwrap();
        assert!(own.remove(c"other", c"lock").is_err());
        own.remove(c"run", c"lock").unwrap();
        assert!(precious.exists() && !run.exists());
        assert!(OpenFolder::open(&parent.path().join("other")).is_err());
    }
}
