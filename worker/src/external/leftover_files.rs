//! Collects the files of a failed run in a form small enough to send with the failure.
//!
//! Files of the case that the program did not change are omitted, because every holder of the case has them.
//! Small files come first and whole; of longer ones only the end is kept.
use protocol::{
    file::File,
    job::{FailureFiles, TruncatedFile},
};
use std::{
    fs,
    io::{self, Read, Seek, SeekFrom},
    os::unix::fs::PermissionsExt,
    path::Path,
};

/// Limit on the total size of the files that are sent whole (bytes); `MAX_TAIL_BYTES` is the limit on the total
/// size of the ends of longer files.
const MAX_WHOLE_BYTES: u64 = 256 << 10;
const MAX_TAIL_BYTES: u64 = 64 << 10;
/// Number of bytes kept of the end of a file that is too long to be sent whole.
const TAIL_BYTES: u64 = 16 << 10;
/// Largest number of files of a failed run that are listed in its failure.
const MOST_FILES: usize = 1000;

/// File or other directory item found in the folder of a failed run.
struct Leftover {
    path: String,
    bytes: u64,
    is_file: bool,
}

/// Collects the contents of a run's folder, except files of the case (`own`, below `work/`) that the run did
/// not change.
pub(super) fn collect(root: &Path, own: &[File]) -> FailureFiles {
    let mut found = Vec::new();
    // what cannot be listed is not there for anybody
    drop(list(root, "", &mut found));
    found.retain(|one| !(one.is_file && is_unchanged(root, one, own)));
    found.sort_by(|a, b| (a.bytes, &a.path).cmp(&(b.bytes, &b.path)));
    let (mut whole, mut ends) = (MAX_WHOLE_BYTES, MAX_TAIL_BYTES);
    let mut left = FailureFiles::default();
    for one in found {
        let room = if one.bytes <= whole {
            one.bytes
        } else {
            TAIL_BYTES.min(one.bytes).min(ends)
        };
        let read = if one.is_file && (room > 0 || one.bytes == 0) {
            end(&root.join(&one.path), room)
        } else {
            None
        };
        let Some((content, executable)) = read else {
            left.shortened.push(TruncatedFile {
                path: one.path,
                bytes: one.bytes,
                kept: 0,
            });
            continue;
        };
        let kept = content.len() as u64;
        if kept < one.bytes {
            ends = ends.saturating_sub(kept);
            left.shortened.push(TruncatedFile {
                path: one.path.clone(),
                bytes: one.bytes,
                kept,
            });
        } else {
            whole = whole.saturating_sub(kept);
        }
        left.files.push(File {
            path: one.path,
            content,
            executable,
        });
    }
    left
}

/// Lists everything below a folder except the folders themselves; links are not followed.
fn list(root: &Path, below: &str, found: &mut Vec<Leftover>) -> io::Result<()> {
    for entry in fs::read_dir(root.join(below))? {
        let entry = entry?;
        // a file whose name is not valid UTF-8 cannot be sent
        let Ok(name) = entry.file_name().into_string() else {
            continue;
        };
        let path = if below.is_empty() {
            name
        } else {
            format!("{below}/{name}")
        };
        let Ok(metadata) = entry.metadata() else {
            continue;
        };
        if metadata.is_dir() {
            drop(list(root, &path, found));
        } else if found.len() < MOST_FILES {
            found.push(Leftover {
                path,
                bytes: metadata.len(),
                is_file: metadata.is_file(),
            });
        }
    }
    Ok(())
}

/// Returns whether a file of the run's folder is unchanged from the case, or is the folder's lock file.
fn is_unchanged(root: &Path, one: &Leftover, own: &[File]) -> bool {
    let name = one.path.strip_prefix(super::scratch_folder::WORK);
    let name = name.and_then(|rest| rest.strip_prefix('/'));
    let Some(name) = name else {
        // the lock of the folder
        return one.path == super::scratch_folder::LOCK;
    };
    let same = own.iter().find(|file| file.path == name);
    same.is_some_and(|file| {
        file.content.len() as u64 == one.bytes
            && fs::read(root.join(&one.path)).is_ok_and(|bytes| bytes == file.content)
    })
}

/// Returns the last `bytes` bytes of a file, and whether the file is executable.
fn end(path: &Path, bytes: u64) -> Option<(Vec<u8>, bool)> {
    let read = || -> io::Result<(Vec<u8>, bool)> {
        let mut file = fs::File::open(path)?;
        let metadata = file.metadata()?;
        file.seek(SeekFrom::Start(metadata.len().saturating_sub(bytes)))?;
        let mut content = Vec::new();
        file.take(bytes).read_to_end(&mut content)?;
        Ok((content, metadata.permissions().mode() & 0o100 != 0))
    };
    read().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_files_travel_whole_long_ones_with_their_end_and_the_case_s_own_stay() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        fs::create_dir_all(root.join("work/deep")).unwrap();
        fs::write(root.join("work/mesh.dat"), "as it came").unwrap();
        fs::write(root.join("work/changed.dat"), "changed").unwrap();
        fs::write(root.join("work/deep/log"), "short").unwrap();
        fs::write(root.join("work/long"), vec![b'x'; 1 << 20]).unwrap();
        fs::write(root.join("output"), "last words").unwrap();
        std::os::unix::fs::symlink("/etc/passwd", root.join("work/link")).unwrap();
        let own = ["mesh.dat", "changed.dat"].map(|path| File {
            path: path.to_owned(),
            content: b"as it came".to_vec(),
            executable: false,
        });
        let left = collect(root, &own);
        let names: Vec<(&str, usize)> = left
            .files
            .iter()
            .map(|file| (file.path.as_str(), file.content.len()))
            .collect();
        let expected = [
            ("work/deep/log", 5),
            ("work/changed.dat", 7),
            ("output", 10),
            ("work/long", 16 << 10),
        ];
        assert_eq!(names, expected);
        let short: Vec<(&str, u64)> = left
            .shortened
            .iter()
            .map(|one| (one.path.as_str(), one.kept))
            .collect();
        assert_eq!(short, [("work/link", 0), ("work/long", 16 << 10)]);
    }

    #[test]
    fn however_much_there_is_little_of_it_travels() {
        let folder = tempfile::tempdir().unwrap();
        for number in 0..40 {
            fs::write(
                folder.path().join(format!("{number}")),
                vec![b'x'; 30 << 10],
            )
            .unwrap();
        }
        let left = collect(folder.path(), &[]);
        let all: usize = left.files.iter().map(|file| file.content.len()).sum();
        assert!(all as u64 <= MAX_WHOLE_BYTES + MAX_TAIL_BYTES, "{all}");
        assert_eq!(
            left.files.len() - 8,
            left.shortened.iter().filter(|one| one.kept > 0).count()
        );
    }
}
