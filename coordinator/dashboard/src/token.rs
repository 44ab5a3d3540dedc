//! Token that a browser must show to the dashboard: a secret of this user, kept in a file that only he can read, so that
//! an open page is answered again after the dashboard was started again.
use std::{
    env,
    fs::{DirBuilder, File, OpenOptions},
    io::{self, Read as _, Write as _},
    os::unix::fs::{DirBuilderExt as _, MetadataExt as _, OpenOptionsExt as _},
    path::{Path, PathBuf},
};

/// Number of hexadecimal digits of the token: 128 bits.
const DIGITS: usize = 32;

/// Returns the token of this user, kept below `$XDG_STATE_HOME` or `~/.local/state`; one for this process alone if it
/// cannot be kept there.
///
/// # Errors
/// If the system supplies no random numbers.
pub fn token() -> io::Result<String> {
    let folder = |name: &str| env::var_os(name).map(PathBuf::from);
    let state = folder("XDG_STATE_HOME").or_else(|| Some(folder("HOME")?.join(".local/state")));
    match state.filter(|path| path.is_absolute()) {
        Some(state) => kept_in(&state.join("horsehead")),
        None => random(),
    }
}

fn kept_in(folder: &Path) -> io::Result<String> {
    let file = folder.join("dashboard-token");
    if let Some(token) = read(&file) {
        return Ok(token);
    }
    let token = random()?;
    match write(&file, &token) {
        // another process may have made it meanwhile
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            return Ok(read(&file).unwrap_or(token));
        }
        Err(error) => tracing::debug!(%error, "the dashboard's token is not kept"),
        Ok(()) => {}
    }
    Ok(token)
}

/// Reads the token; `None` if the file does not belong to this user alone or holds no token.
fn read(path: &Path) -> Option<String> {
    let mut file = File::open(path).ok()?;
    let found = file.metadata().ok()?;
    let is_own = found.uid() == rustix::process::geteuid().as_raw();
    if !found.is_file() || !is_own || found.mode() & 0o777 != 0o600 {
        return None;
    }
    let mut token = String::new();
    file.read_to_string(&mut token).ok()?;
    let is_token = token.len() == DIGITS && token.bytes().all(|byte| byte.is_ascii_hexdigit());
    is_token.then_some(token)
}

fn write(path: &Path, token: &str) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        DirBuilder::new()
            .recursive(true)
            .mode(0o700)
            .create(folder)?;
    }
    let mut options = OpenOptions::new();
    let mut file = options
        .write(true)
        .create_new(true)
        .mode(0o600)
        .open(path)?;
    file.write_all(token.as_bytes())
}

fn random() -> io::Result<String> {
    let mut bytes = [0; 16];
    File::open("/dev/urandom")?.read_exact(&mut bytes)?;
    Ok(format!("{:032x}", u128::from_ne_bytes(bytes)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{fs, os::unix::fs::PermissionsExt as _};

    #[test]
    fn the_token_is_kept_for_its_owner_alone() {
        let state = tempfile::tempdir().unwrap();
        let folder = state.path().join("horsehead");
        let token = kept_in(&folder).unwrap();
        assert_eq!(kept_in(&folder).unwrap(), token);
        let file = folder.join("dashboard-token");
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!((mode(&folder), mode(&file)), (0o700, 0o600));
        // what others could read or have written is not used
        fs::set_permissions(&file, fs::Permissions::from_mode(0o644)).unwrap();
        assert_ne!(kept_in(&folder).unwrap(), token);
        fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
        fs::write(&file, "short").unwrap();
        assert_eq!(kept_in(&folder).unwrap().len(), DIGITS);
    }
}
