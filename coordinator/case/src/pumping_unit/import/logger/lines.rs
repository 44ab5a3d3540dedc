//! Lines of a text file, plain or gzipped, in UTF-8, UTF-16 or Latin-1.
use crate::{
    error::{CaseError, damaged},
    file,
};
use exchange::{decoded, is_utf16, utf8_or_latin1};
use std::{
    io::{BufRead, Cursor, Read},
    path::Path,
};

/// Maximum length of a line \[bytes\]; a longer one is not a table of text.
const LONGEST: u64 = 1 << 20;

/// Reader of the lines of a file, with their numbers from 1.
pub(super) struct Lines<'a> {
    path: &'a Path,
    from: Box<dyn BufRead>,
    number: u64,
    bytes: u64,
    buffer: Vec<u8>,
}

impl<'a> Lines<'a> {
    /// Opens a file; one that ends in `.gz` is decompressed.
    ///
    /// # Errors
    /// Returns an error for a file that is missing, unreadable or not gzip data despite its name.
    pub(super) fn open(path: &'a Path) -> Result<Self, CaseError> {
        let mut from = file::open(path, "a file to import")?;
        let start = from.fill_buf().map_err(|source| unreadable(path, source))?;
        let wide = is_utf16(start);
        // line ends of old Macintosh programs
        let returns = !wide && start.contains(&b'\r') && !start.contains(&b'\n');
        if wide || returns {
            let mut bytes = Vec::new();
            from.take(file::LIMIT + 1)
                .read_to_end(&mut bytes)
                .map_err(|source| unreadable(path, source))?;
            if bytes.len() as u64 > file::LIMIT {
                return Err(file::too_large(path));
            }
            let mut text = decoded(&bytes).into_owned();
            if returns {
                text = text.replace('\r', "\n");
            }
            from = Box::new(Cursor::new(text.into_bytes()));
        }
        Ok(Self {
            path,
            from,
            number: 0,
            bytes: 0,
            buffer: Vec::new(),
        })
    }

    /// Returns the next line without its end, with its number; `None` at the end of the file.
    ///
    /// # Errors
    /// Returns an error for a file that cannot be read on, damaged gzip data, a line of more than 1 MiB, and more
    /// than 1 GiB of text.
    pub(super) fn next(&mut self) -> Result<Option<(u64, &[u8])>, CaseError> {
        self.buffer.clear();
        let mut limited = self.from.by_ref().take(LONGEST + 1);
        let read = limited
            .read_until(b'\n', &mut self.buffer)
            .map_err(|source| unreadable(self.path, source))?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        self.bytes += read as u64;
        if self.bytes > file::LIMIT {
            return Err(file::too_large(self.path));
        }
        if self.buffer.len() as u64 > LONGEST || self.buffer.contains(&0) {
            return Err(damaged(
                self.path,
                format!("line {} is not text", self.number),
                "export the measurement as text (CSV); binary files of a logger cannot be read",
            ));
        }
        let mut line = self.buffer.as_slice();
        line = line.strip_suffix(b"\n").unwrap_or(line);
        line = line.strip_suffix(b"\r").unwrap_or(line);
        if self.number == 1 {
            line = line.strip_prefix("\u{feff}".as_bytes()).unwrap_or(line);
        }
        Ok(Some((self.number, line)))
    }
}

fn unreadable(path: &Path, source: std::io::Error) -> CaseError {
    if source.kind() == std::io::ErrorKind::UnexpectedEof {
        return damaged(
            path,
            "the gzip data ends too early: the file is truncated",
            "copy the file again from its source; `gzip -t` tests it",
        );
    }
    CaseError::Unreadable {
        path: path.into(),
        source,
    }
}

/// Reads the whole text of a small file: plain or gzipped, in UTF-8, UTF-16 or Latin-1.
///
/// # Errors
/// As [`Lines::open`] and [`Lines::next`].
pub(crate) fn content(path: &Path) -> Result<String, CaseError> {
    let mut lines = Lines::open(path)?;
    let mut all = String::new();
    while let Some((_, line)) = lines.next()? {
        all.push_str(&utf8_or_latin1(line));
        all.push('\n');
    }
    Ok(all)
}
