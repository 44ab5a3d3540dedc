//! Default names of run folders: the case's folder, the command, and what distinguishes the run.
use crate::{folder::MANIFEST, hash::short_hash};
use protocol::case::Case;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Maximum length of one part of a name (bytes), such as the settings; a longer one is replaced by its hash.
const LONGEST_PART: usize = 60;

/// What determines the default name of a run folder; a command that is repeated on an unchanged case finds its run by
/// it.
#[derive(Clone, Copy, Debug)]
pub struct RunName<'a> {
    /// Folder of the case, after which the run is named.
    pub case_folder: &'a Path,
    /// Case; a name states its effects.
    pub case: &'a Case,
    /// Preset of a search, or command.
    pub what: &'a str,
    /// Settings that differ from the default, and hashes of other inputs.
    pub set: &'a [String],
    /// Folder of the records that replace those of the case.
    pub measured: Option<&'a Path>,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl RunName<'_> {
    /// Returns the path `runs/CASE-WHAT[-SETTING...][-with-EFFECT...][-RECORDS-HASH][-HASH]-seedN`, relative to the
    /// current folder. Since many folders of records have the same name, the start of the records' hash is appended. The
    /// last hash is that of the case folder's path, and is there if the name without it belongs to another case folder.
    ///
    /// # Errors
    /// If the current folder does not exist, or an input cannot be encoded for its hash.
    pub fn path(&self) -> anyhow::Result<PathBuf> {
        let folder = std::path::absolute(self.case_folder)?;
        let folder = fs::canonicalize(&folder).unwrap_or(folder);
        let case = folder.file_name().unwrap_or_default().to_string_lossy();
        let case = plain(&case).replace('.', "-");
        let set = part("set", self.set.iter().map(String::as_str))?;
        let effects = self.case.effects.iter().map(|effect| effect.id.as_str());
        let mut effects = part("with", effects)?;
        if !effects.is_empty() && !effects.starts_with("-with-") {
            effects.insert_str(0, "-with");
        }
        let mut records = String::new();
        if let Some(folder) = self.measured {
            if let Some(name) = folder.file_name() {
                records = format!("-{}", name.to_string_lossy());
            }
            records.extend([
                "-",
                &short_hash(&(&self.case.model, &self.case.conditions))?,
            ]);
        }
        let (what, seed) = (self.what, self.seed);
        let name = format!("{case}-{what}{set}{effects}{records}");
        let path = |name: &str| Path::new("runs").join(format!("{name}-seed{seed}"));
        if belongs_to_another(&path(&name), &folder) {
            let hash = short_hash(&folder.to_string_lossy())?;
            return Ok(path(&format!("{name}-{hash}")));
        }
        Ok(path(&name))
    }
}

/// Joins words to a part of a name, each after a hyphen; a part that is too long becomes `-KEY-HASH`.
fn part(key: &str, words: impl Iterator<Item = impl AsRef<str>>) -> anyhow::Result<String> {
    let words = words.flat_map(|one| ["-".to_owned(), plain(one.as_ref())]);
    let joined: String = words.collect();
    if joined.len() > LONGEST_PART {
        return Ok(format!("-{key}-{}", short_hash(&joined)?));
    }
    Ok(joined)
}

/// Returns a text with lower-case letters, digits and full stops alone; all else becomes a hyphen.
fn plain(text: &str) -> String {
    let one = |c: char| match c {
        '.' => '.',
        c if c.is_ascii_alphanumeric() => c.to_ascii_lowercase(),
        _ => '-',
    };
    text.chars().map(one).collect()
}

/// Returns whether a run folder holds a run of another case folder that still exists.
pub fn belongs_to_another(run: &Path, case_folder: &Path) -> bool {
    let manifest = fs::read(run.join(MANIFEST)).unwrap_or_default();
    let manifest: serde_json::Value = serde_json::from_slice(&manifest).unwrap_or_default();
    let other = manifest["case_folder"].as_str().map(fs::canonicalize);
    other.is_some_and(|other| other.is_ok_and(|other| other != case_folder))
}
