//! Writer of PEST's Jacobian matrix files.
//!
//! Source: the reader and writer of pyemu (`Matrix.read_binary`), which PEST++ shares. Integers have 4 bytes, numbers 8, both
//! little-endian; entries that are zero are left out.

/// Longest names of parameters and observations in PEST's own format (characters).
const SHORT: [usize; 2] = [12, 20];
/// Length of the names in the format of PEST++ (characters).
const LONG: usize = 200;

/// Formats a Jacobian matrix as a file, and returns it with its name: `jacobian.jco` in PEST's own format, or `jacobian.jcb` in
/// that of PEST++ if a name is longer than PEST allows. `columns` has a column for each parameter, with a value for each
/// observation.
pub fn jacobian(
    parameters: &[String],
    observations: &[String],
    columns: &[Vec<f64>],
) -> (&'static str, Vec<u8>) {
    let longest = |names: &[String]| names.iter().map(String::len).max().unwrap_or(0);
    let is_short = longest(parameters) <= SHORT[0] && longest(observations) <= SHORT[1];
    let entries = columns.iter().enumerate().flat_map(|(column, values)| {
        let values = values.iter().enumerate();
        values
            .filter(|(_, value)| **value != 0.0)
            .map(move |(row, value)| (row, column, *value))
    });
    let entries: Vec<(usize, usize, f64)> = entries.collect();
    let whole = |number: usize| i32::try_from(number).unwrap_or(i32::MAX);
    let [rows, count] = [observations.len(), parameters.len()];
    let sign = if is_short { -1 } else { 1 };
    let mut file = Vec::new();
    for number in [
        sign * whole(count),
        sign * whole(rows),
        whole(entries.len()),
    ] {
        file.extend(number.to_le_bytes());
    }
    for (row, column, value) in entries {
        if is_short {
            file.extend(whole(row + 1 + column * rows).to_le_bytes());
        } else {
            file.extend(whole(row).to_le_bytes());
            file.extend(whole(column).to_le_bytes());
        }
        file.extend(value.to_le_bytes());
    }
    let lengths = if is_short { SHORT } else { [LONG; 2] };
    for (names, length) in [(parameters, lengths[0]), (observations, lengths[1])] {
        for name in names {
            let padding = std::iter::repeat(b' ');
            file.extend(name.bytes().chain(padding).take(length));
        }
    }
    let name = if is_short {
        "jacobian.jco"
    } else {
        "jacobian.jcb"
    };
    (name, file)
}

#[cfg(test)]
mod tests {
    use super::jacobian;

    /// Checks every byte of a small file in PEST's format, and the size of one with long names.
    #[test]
    fn entries_and_names_stand_where_pyemu_reads_them() {
        let names = |all: &[&str]| {
            all.iter()
                .map(|name| (*name).to_owned())
                .collect::<Vec<_>>()
        };
        let (parameters, observations) = (names(&["k", "c"]), names(&["o1", "o2", "o3"]));
        let columns = [vec![1.0, 0.0, 3.0], vec![0.0, 5.0, 0.0]];
        let (name, file) = jacobian(&parameters, &observations, &columns);
        let mut expected = Vec::new();
        for number in [-2_i32, -3, 3] {
            expected.extend(number.to_le_bytes());
        }
        for (at, value) in [(1_i32, 1.0_f64), (3, 3.0), (5, 5.0)] {
            expected.extend(at.to_le_bytes());
            expected.extend(value.to_le_bytes());
        }
        expected.extend(b"k           c           ");
        expected.extend(b"o1                  o2                  o3                  ");
        assert_eq!((name, file), ("jacobian.jco", expected));
        let long = names(&["a_name_longer_than_12", "c"]);
        let (name, file) = jacobian(&long, &observations, &columns);
        assert_eq!((name, file.len()), ("jacobian.jcb", 12 + 3 * 16 + 5 * 200));
    }
}
