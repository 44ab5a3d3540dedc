//! Reading of a case's files as bytes or text, independent of their content.
use super::error::{CaseError, damaged};
use exchange::{decoded, is_utf16};
use std::{
    fs, io,
    io::{BufRead, BufReader, Read, Write as _},
    path::Path,
};

/// Maximum size of a file after decompression (bytes), enough for 40 hours of a 100 Hz record; a larger file
/// is a mistake or a compression bomb.
pub const LIMIT: u64 = 1 << 30;

/// First bytes of gzip data.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Checks that a file exists.
///
/// # Errors
/// Returns an error that states `role`, the purpose of the file, if it is missing.
pub fn require_exists(path: &Path, role: &str) -> Result<(), CaseError> {
    if path.exists() {
        return Ok(());
    }
    Err(CaseError::Missing {
        path: path.into(),
        role: role.into(),
        help: MISSING.into(),
    })
}

/// Remedy that is suggested where a file of a case is missing.
const MISSING: &str = "put the file there, or correct the name where it is stated";

/// Opens a file that must be neither a folder nor a pipe, which would wait for somebody to write into it.
fn opened(path: &Path, role: &str) -> Result<fs::File, CaseError> {
    let opened = fs::metadata(path).and_then(|there| {
        if there.is_file() {
            fs::File::open(path)
        } else {
            let what = if there.is_dir() {
                "a folder"
            } else {
                "a device or a pipe"
            };
            Err(io::Error::other(format!("it is {what}, not a file")))
        }
    });
    opened.map_err(|source| {
        if source.kind() == io::ErrorKind::NotFound {
            CaseError::Missing {
                path: path.into(),
                role: role.into(),
                help: MISSING.into(),
            }
        } else {
            CaseError::Unreadable {
                path: path.into(),
                source,
            }
        }
    })
}

/// Returns whether a file is gzipped by its name.
pub fn is_packed(path: &Path) -> bool {
    path.extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("gz"))
}

/// Opens a file for reading, decompressed if it is gzip data; `role` is its purpose, for the error message.
///
/// # Errors
/// Returns an error for a file that is missing or unreadable.
pub fn open(path: &Path, role: &str) -> Result<Box<dyn BufRead>, CaseError> {
    let mut file = BufReader::new(opened(path, role)?);
    let start = file.fill_buf().map_err(|source| CaseError::Unreadable {
        path: path.into(),
        source,
    })?;
    Ok(if start.starts_with(&GZIP) {
        Box::new(BufReader::new(flate2::bufread::MultiGzDecoder::new(file)))
    } else {
        Box::new(file)
    })
}

/// Reads a whole file; `role` is its purpose, for the error message.
///
/// # Errors
/// Returns an error for a file that is missing, unreadable, empty or larger than 1 GiB.
pub fn read(path: &Path, role: &str) -> Result<Vec<u8>, CaseError> {
    let file = opened(path, role)?;
    let bytes = read_limited(file, path)?.map_err(|source| CaseError::Unreadable {
        path: path.into(),
        source,
    })?;
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(damaged(
            path,
            "the file is empty",
            "copy it again from its source",
        ));
    }
    Ok(bytes)
}

/// Reads and decompresses a gzip file.
///
/// # Errors
/// As [`read`], and for a file that is not gzip data, is truncated or fails its checksum.
pub fn read_gzip(path: &Path, role: &str) -> Result<Vec<u8>, CaseError> {
    let packed = read(path, role)?;
    if !packed.starts_with(&GZIP) {
        return Err(damaged(
            path,
            "the file is not gzip data",
            "compress the table with gzip, or name it .csv",
        ));
    }
    let decoder = flate2::read::MultiGzDecoder::new(packed.as_slice());
    let bytes = read_limited(decoder, path)?.map_err(|source| {
        let problem = if source.kind() == io::ErrorKind::UnexpectedEof {
            "the gzip data ends too early: the file is truncated".to_owned()
        } else {
            format!("the gzip data is damaged: {source}")
        };
        damaged(
            path,
            problem,
            "copy the file again from its source; `gzip -t` tests it",
        )
    })?;
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(damaged(
            path,
            "the file is empty after unpacking",
            "copy it again from its source",
        ));
    }
    Ok(bytes)
}

/// Returns the bytes of a file of the given name: gzipped if it ends in `.gz`, with the same bytes for the
/// same content.
///
/// # Errors
/// Returns an error if the data cannot be compressed.
pub fn packed(path: &Path, content: &[u8]) -> Result<Vec<u8>, CaseError> {
    if !is_packed(path) {
        return Ok(content.to_vec());
    }
    let mut to = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    let written = to.write_all(content).and_then(|()| to.finish());
    written.map_err(|source| CaseError::Unwritable {
        path: path.into(),
        source,
    })
}

/// Reads a file or stream to its end; refuses more than [`LIMIT`] bytes.
fn read_limited(from: impl Read, path: &Path) -> Result<io::Result<Vec<u8>>, CaseError> {
    let mut bytes = Vec::new();
    let outcome = from.take(LIMIT + 1).read_to_end(&mut bytes);
    if bytes.len() as u64 > LIMIT {
        return Err(too_large(path));
    }
    Ok(outcome.map(|_| bytes))
}

/// Builds the error for a file of more than [`LIMIT`] bytes.
pub fn too_large(path: &Path) -> CaseError {
    damaged(
        path,
        "the file is larger than 1 GiB",
        "split the record: a few dozen revolutions are enough",
    )
}

/// Converts bytes in UTF-8 or UTF-16 to text, without a byte-order mark.
///
/// # Errors
/// Returns an error with the number of the first line that is not UTF-8.
pub fn text(path: &Path, bytes: Vec<u8>) -> Result<String, CaseError> {
    if is_utf16(&bytes) {
        return Ok(decoded(&bytes).into_owned());
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let start = error.as_bytes().get(..valid).unwrap_or_default();
        let line = start.split(|byte| *byte == b'\n').count();
        damaged(
            path,
            format!("line {line} is not UTF-8 text"),
            "save the file as UTF-8",
        )
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}
