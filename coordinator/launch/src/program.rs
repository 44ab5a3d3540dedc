//! Worker program files: processor architecture, and the oldest C library that can run them.
use object::{
    Endianness,
    elf::{FileHeader64, VER_FLG_WEAK},
    read::elf::{FileHeader, SectionHeader},
};
use std::path::{Path, PathBuf};
use support::Problem;

/// Worker program that can be copied to other machines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Path of the program file.
    pub path: PathBuf,
    /// Architecture of the program, in the notation of `uname -m`.
    pub machine: String,
    /// Newest glibc version whose symbols the program needs, as `[2, 34]`; empty if none.
    pub glibc: Vec<u32>,
    /// File size \[bytes\].
    pub bytes: usize,
    /// First 16 digits of the hash of the program's content; part of the program's file name on the hosts to
    /// which it is copied.
    pub hash: String,
}

impl Program {
    /// Reads a program file.
    ///
    /// # Errors
    /// If it cannot be read or is no 64-bit ELF program.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let wrong = |why: String| {
            Problem::new(
                format!("{} is no worker program: {why}", path.display()),
                "`cargo build --release` makes one, `deploy/portable.sh` one for older systems; \
                 name it with --worker-program ARCH=PATH",
            )
        };
        let bytes = std::fs::read(path).map_err(|error| wrong(error.to_string()))?;
        let (machine, glibc) = needs(&bytes).map_err(|error| wrong(error.to_string()))?;
        let machine = machine.ok_or_else(|| wrong("it is for an unknown processor".to_owned()))?;
        Ok(Self {
            path: std::path::absolute(path).unwrap_or_else(|_| path.to_owned()),
            machine: machine.to_owned(),
            glibc,
            bytes: bytes.len(),
            hash: blake3::hash(&bytes).to_hex().chars().take(16).collect(),
        })
    }

    /// Returns the glibc version that the worker program requires, as `2.34`; `0` if none is required.
    pub fn glibc_text(&self) -> String {
        let numbers: Vec<String> = self.glibc.iter().map(u32::to_string).collect();
        if numbers.is_empty() {
            "0".to_owned()
        } else {
            numbers.join(".")
        }
    }
}

/// Returns the processor architecture of a program and the newest `GLIBC_` version that the loader requires
/// for it.
fn needs(bytes: &[u8]) -> Result<(Option<&'static str>, Vec<u32>), object::read::Error> {
    let header = FileHeader64::<Endianness>::parse(bytes)?;
    let endian = header.endian()?;
    let machine = match header.e_machine(endian) {
        object::elf::EM_X86_64 => Some("x86_64"),
        object::elf::EM_AARCH64 => Some("aarch64"),
        object::elf::EM_RISCV => Some("riscv64"),
        object::elf::EM_PPC64 => Some("ppc64le"),
        _ => None,
    };
    let sections = header.sections(endian, bytes)?;
    let mut newest = Vec::new();
    for section in sections.iter() {
        let Some((mut needs, names)) = section.gnu_verneed(endian, bytes)? else {
            continue;
        };
        let names = sections.strings(endian, bytes, names)?;
        while let Some((_, mut versions)) = needs.next()? {
            while let Some(version) = versions.next()? {
                if version.vna_flags.get(endian).contains(VER_FLG_WEAK) {
                    continue;
                }
                let name = String::from_utf8_lossy(version.name(endian, names)?);
                let numbers = name.strip_prefix("GLIBC_").unwrap_or_default();
                let numbers = numbers.split('.').map_while(|number| number.parse().ok());
                newest = newest.max(numbers.collect());
            }
        }
    }
    Ok((machine, newest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_needs_of_a_program_are_those_that_objdump_tells() {
        // this very test is a program of this machine
        let own = Program::read(&std::env::current_exe().unwrap()).unwrap();
        assert_eq!(own.machine, std::env::consts::ARCH);
        if cfg!(target_env = "gnu") {
            // it runs here, so this machine's C library is no older than what it needs
            let said = std::process::Command::new("getconf")
                .arg("GNU_LIBC_VERSION")
                .output();
            let said = String::from_utf8(said.unwrap().stdout).unwrap();
            let here: Vec<u32> = said
                .trim()
                .strip_prefix("glibc ")
                .unwrap()
                .split('.')
                .map(|number| number.parse().unwrap())
                .collect();
            assert!(
                own.glibc >= vec![2, 2] && own.glibc <= here,
                "{own:?} on {here:?}"
            );
        }
        let text = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(text.path(), "#!/bin/sh\n").unwrap();
        let error = Program::read(text.path()).unwrap_err();
        assert!(error.message.contains("no worker program"), "{error}");
    }
}
