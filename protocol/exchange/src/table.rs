//! Reading of columns from a table with a header.
use crate::{Problem, number, problem::clip};

/// Returns the named column of a table. The header determines the separator: commas, semicolons or white
/// space. A `#` before the header is allowed.
///
/// # Errors
/// A table without the column, a row of a different length, a cell that is not a finite number, or a table
/// without rows.
pub fn column(file: &str, text: &str, name: &str) -> Result<Vec<f64>, Problem> {
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty());
    let (_, header) = lines.next().ok_or_else(|| Problem {
        file: file.to_owned(),
        line: None,
        found: "nothing".to_owned(),
        allowed: "a table with a header".to_owned(),
        remedy: "check that the program has finished writing the file".to_owned(),
    })?;
    let header = header.trim_start_matches(['\u{feff}', '#']);
    let between = [Some(','), Some(';'), None]
        .into_iter()
        .find(|mark| mark.is_none_or(|mark| header.contains(mark)))
        .flatten();
    let cells = |line: &'_ str| -> Vec<String> {
        match between {
            Some(mark) => line
                .split(mark)
                .map(|cell| cell.trim().trim_matches('"').to_owned())
                .collect(),
            None => line.split_whitespace().map(str::to_owned).collect(),
        }
    };
    let names = cells(header);
    let Some(at) = names.iter().position(|own| own == name) else {
        let found = format!("columns {}", clip(&names.join(", ")));
        let allowed = format!("a table with a column `{name}`");
        return Err(Problem::at(
            file,
            1,
            found,
            allowed,
            "correct the column's name in the case",
        ));
    };
    let mut values = Vec::new();
    for (line, row) in lines {
        let row = cells(row);
        let value = row.get(at).and_then(|cell| number(cell));
        match value {
            Some(value) if row.len() == names.len() => values.push(value),
            Some(_) | None => {
                let found = row
                    .get(at)
                    .map_or("a row that is cut off".to_owned(), |cell| {
                        format!("`{}` in a row of {} cells", clip(cell), row.len())
                    });
                let allowed = format!("a finite number in a row of {} cells", names.len());
                return Err(Problem::at(
                    file,
                    line + 1,
                    found,
                    allowed,
                    "check the program's results file",
                ));
            }
        }
    }
    if values.is_empty() {
        let allowed = "a table with rows";
        return Err(Problem::at(
            file,
            1,
            "a header alone",
            allowed,
            "check the program's results file",
        ));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::column;

    #[test]
    fn columns_are_found_between_commas_semicolons_and_blanks() {
        for text in [
            "# time,force\n0,1\n1,2.5\n",
            "time; force\n0; 1\n\n1; 2.5",
            "time force\n 0  1 \n 1\t2.5D0\n",
        ] {
            assert_eq!(column("f", text, "force").unwrap(), [1.0, 2.5], "{text}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_named_by_line() {
        for (text, words) in [
            ("", "nothing"),
            ("a,b\n", "header alone"),
            ("a,c\n1,2\n", "column `b`"),
            ("a,b\n1,2\n3\n", "line 3"),
            ("a,b\n1,NaN\n", "line 2: `NaN`"),
            ("a,b\n1,2,3\n", "3 cells"),
        ] {
            let error = column("f", text, "b").unwrap_err().to_string();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }
}
