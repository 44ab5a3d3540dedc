//! Selection of table rows by the text in a column.
use super::super::error::{CaseError, damaged};
use std::path::Path;

/// Returns a CSV table with only the header and the rows whose cell in `column` equals `word`; other rows
/// become empty lines, so that line numbers in messages match the file.
///
/// # Errors
/// Returns an error if the column is missing, no row contains the word, or the text is not valid CSV.
pub(super) fn of(
    path: &Path,
    bytes: &[u8],
    column: &str,
    word: &str,
) -> Result<Vec<u8>, CaseError> {
    let mut lines = bytes.split_inclusive(|byte| *byte == b'\n');
    let header = lines.next().unwrap_or_default();
    let words = cells(path, header)?;
    let Some(at) = words
        .iter()
        .position(|name| name.trim_start_matches('#').trim() == column)
    else {
        return Err(CaseError::Column {
            path: path.into(),
            column: column.into(),
            found: words.join(", ").into(),
            help: "`rows` names a column of words".into(),
        });
    };
    let (mut kept, mut found) = (header.to_vec(), false);
    for line in lines {
        if cells(path, line)?.get(at).is_some_and(|own| own == word) {
            kept.extend_from_slice(line);
            found = true;
        } else {
            kept.push(b'\n');
        }
    }
    if found {
        return Ok(kept);
    }
    Err(damaged(
        path,
        format!("no row has `{word}` in column `{column}`"),
        "correct the word in `rows`, or add the rows",
    ))
}

/// Splits a CSV line into its cells.
fn cells(path: &Path, line: &[u8]) -> Result<Vec<String>, CaseError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .from_reader(line);
    let mut record = csv::StringRecord::new();
    reader.read_record(&mut record).map_err(|error| {
        damaged(
            path,
            format!("a line cannot be read as CSV: {error}"),
            "use commas between cells and no line breaks in quotes",
        )
    })?;
    Ok(record.iter().map(str::to_owned).collect())
}
