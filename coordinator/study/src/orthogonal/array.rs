//! Orthogonal arrays: designs of few rows in which every pair of columns contains every pair of levels
//! exactly once.
use serde::{Deserialize, Serialize};

/// Orthogonal array of q^2 rows with q + 1 columns of q levels.
///
/// Rows are the pairs (a, b) of a field of q elements; columns are a, b and a + k b for every nonzero k
/// (Bose's construction, R. C. Bose 1938).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Array {
    /// Array of 9 runs, up to 4 factors of 3 levels.
    L9,
    /// Array of 16 runs, up to 5 factors of 4 levels.
    L16,
    /// Array of 25 runs, up to 6 factors of 5 levels.
    L25,
}

impl Array {
    /// All arrays, the smallest first.
    pub const ALL: [Self; 3] = [Self::L9, Self::L16, Self::L25];

    /// Returns the name of the array in the literature, for example `L9`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::L9 => "L9",
            Self::L16 => "L16",
            Self::L25 => "L25",
        }
    }

    /// Returns the number of levels of every factor of the array.
    pub const fn levels(self) -> usize {
        match self {
            Self::L9 => 3,
            Self::L16 => 4,
            Self::L25 => 5,
        }
    }

    /// Returns the maximum number of factors of the array, one per column.
    pub const fn columns(self) -> usize {
        self.levels() + 1
    }

    /// Returns the levels of the first `factors` factors in each run, run by run.
    pub fn rows(self, factors: usize) -> Vec<Vec<usize>> {
        let levels = self.levels();
        let pairs = (0..levels).flat_map(|a| (0..levels).map(move |b| (a, b)));
        let row = |(a, b)| {
            let lines = (1..levels).map(|k| self.sum(a, self.product(k, b)));
            [a, b].into_iter().chain(lines).take(factors).collect()
        };
        pairs.map(row).collect()
    }

    const fn sum(self, a: usize, b: usize) -> usize {
        match self {
            Self::L16 => a ^ b,
            Self::L9 | Self::L25 => (a + b) % self.levels(),
        }
    }

    /// Returns the product in the field; that of four elements consists of polynomials over {0, 1} modulo x^2
    /// + x + 1.
    const fn product(self, a: usize, b: usize) -> usize {
        match self {
            Self::L16 => [[0, 0, 0, 0], [0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2]][a][b],
            Self::L9 | Self::L25 => a * b % self.levels(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_columns_meets_every_pair_of_levels_once() {
        for array in Array::ALL {
            let (levels, columns) = (array.levels(), array.columns());
            let rows = array.rows(columns);
            assert_eq!(array.name(), format!("L{}", rows.len()));
            for first in 0..columns {
                for second in first + 1..columns {
                    let mut met = vec![0; levels * levels];
                    for row in &rows {
                        met[row[first] * levels + row[second]] += 1;
                    }
                    assert!(met.iter().all(|count| *count == 1), "{array:?} {met:?}");
                }
            }
        }
    }

    #[test]
    fn fewer_factors_take_the_first_columns() {
        assert!(Array::L9.rows(2).iter().all(|row| row.len() == 2));
    }
}
