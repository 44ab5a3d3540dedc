//! File of sealed answers, and the cryptographic commitment to it.
//!
//! The commitment is the BLAKE3 hash of the file's bytes, which contain a random salt, so that answers cannot
//! be guessed and checked against the hash. Names of sets depend on the salt, not on the hidden effects.
use crate::plan::Answer;
use anyhow::{Context as _, bail};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::io::Read as _;
use std::path::Path;

/// Answers by the names of their sets, with a salt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sealed {
    /// Version of the file format.
    format: u32,
    /// Random salt, hexadecimal.
    salt: String,
    /// Answers by set name.
    pub sets: BTreeMap<String, Answer>,
}

const FORMAT: u32 = 1;

impl Sealed {
    /// Creates an empty collection with a new salt from `/dev/urandom`.
    ///
    /// # Errors
    /// A system without a readable `/dev/urandom`.
    pub fn new() -> anyhow::Result<Self> {
        let mut salt = [0_u8; 32];
        fs::File::open("/dev/urandom")
            .and_then(|mut source| source.read_exact(&mut salt))
            .context("reading a salt from /dev/urandom")?;
        Ok(Self {
            format: FORMAT,
            salt: blake3::Hash::from_bytes(salt).to_hex().to_string(),
            sets: BTreeMap::new(),
        })
    }

    /// Loads the answers of a file; creates an empty collection if there is no file.
    ///
    /// # Errors
    /// A file that cannot be read or is of another format version.
    pub fn load_or_new(path: &Path) -> anyhow::Result<Self> {
        if path.exists() {
            Self::load(path).map(|(sealed, _)| sealed)
        } else {
            Self::new()
        }
    }

    /// Loads the answers of a file and computes its commitment.
    ///
    /// # Errors
    /// A file that cannot be read or is of another format version.
    pub fn load(path: &Path) -> anyhow::Result<(Self, String)> {
        let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
        let sealed: Self = serde_json::from_slice(&bytes)
            .with_context(|| format!("{} holds no answers", path.display()))?;
        if sealed.format != FORMAT {
            bail!(
                "{} has the unsupported format version {}",
                path.display(),
                sealed.format
            );
        }
        Ok((sealed, commitment(&bytes)))
    }

    /// Returns the name of the next set of records: a hash of the salt and the number of sets.
    pub fn name(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.salt.as_bytes());
        hasher.update(&(self.sets.len() as u64).to_le_bytes());
        let hex = hasher.finalize().to_hex();
        hex.chars().take(10).collect()
    }

    /// Writes the answer file and returns its commitment.
    ///
    /// # Errors
    /// File system errors.
    pub fn save(&self, path: &Path) -> anyhow::Result<String> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        // whole or not at all: a stop in between loses no answer
        let beside = path.with_extension("json.part");
        fs::write(&beside, &text)
            .and_then(|()| fs::rename(&beside, path))
            .with_context(|| format!("writing {}", path.display()))?;
        Ok(commitment(text.as_bytes()))
    }
}

/// Returns the hexadecimal BLAKE3 hash of the bytes of an answer file.
pub fn commitment(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Stratum;

    fn answer(seed: u64) -> Answer {
        Answer {
            seed,
            stratum: Stratum::Zero,
            case: "case".to_owned(),
            noise: 1.0,
            cycles: 5,
            genes: BTreeMap::new(),
            effects: Vec::new(),
            nuisances: crate::law::Nuisances::default(),
            channels: crate::files::Channels::default(),
        }
    }

    #[test]
    fn a_commitment_holds_for_these_answers_and_no_others() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("answers.json");
        let mut sealed = Sealed::new().unwrap();
        let name = sealed.name();
        sealed.sets.insert(name.clone(), answer(7));
        let committed = sealed.save(&path).unwrap();
        let (loaded, found) = Sealed::load(&path).unwrap();
        assert_eq!((loaded, &found), (sealed.clone(), &committed));
        // another size, another salt: another commitment
        sealed.sets.insert(name.clone(), answer(8));
        assert_ne!(sealed.save(&path).unwrap(), committed);
        let mut other = Sealed::new().unwrap();
        other.sets.insert(name.clone(), answer(7));
        assert_ne!(other.save(&path).unwrap(), committed);
        assert_ne!(other.name(), name);
        fs::write(&path, "{}").unwrap();
        let refused = Sealed::load(&path).unwrap_err().to_string();
        assert!(refused.contains("holds no answers"), "{refused}");
    }
}
