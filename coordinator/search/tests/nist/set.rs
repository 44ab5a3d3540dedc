//! NIST data set as its file states it: starting values, certified values and observations.
use crate::{dual::Dual, model::Model};
use search::least_squares::EvaluatedPoint;
use std::{fs, path::Path};

/// Number of lines before the data in the file of a data set.
const HEAD: usize = 60;

/// NIST data set with its regression model and certified values.
pub(crate) struct Set {
    model: Model,
    /// Two sets of starting values of the parameters: far from and near the solution.
    pub(crate) starts: [Vec<f64>; 2],
    /// Certified values of the parameters; the field `errors` holds their standard errors.
    pub(crate) parameters: Vec<f64>,
    pub(crate) errors: Vec<f64>,
    /// Response and predictors of each observation.
    pub(crate) data: Vec<(f64, Vec<f64>)>,
}

impl Set {
    pub(crate) fn read(name: &'static str, model: Model) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/nist/data");
        let text =
            fs::read_to_string(folder.join(format!("{name}.dat"))).expect("a file for every set");
        let numbers = |line: &str| -> Option<Vec<f64>> {
            line.split_whitespace()
                .map(|word| word.parse().ok())
                .collect()
        };
        let stated: Vec<Vec<f64>> = text
            .lines()
            .take(HEAD)
            .filter_map(|line| numbers(line.trim().strip_prefix('b')?.split_once('=')?.1))
            .collect();
        let column = |k: usize| stated.iter().map(|row| row[k]).collect::<Vec<f64>>();
        let data = text.lines().skip(HEAD).filter_map(|line| {
            let row = numbers(line).filter(|row| row.len() > 1)?;
            // the file's model is that of the logarithm
            let response = if name == "Nelson" {
                row[0].ln()
            } else {
                row[0]
            };
            Some((response, row[1..].to_vec()))
        });
        Self {
            model,
            starts: [column(0), column(1)],
            parameters: column(2),
            errors: column(3),
            data: data.collect(),
        }
    }

    /// Returns the residual (model minus data) at parameters `x` with its Jacobian columns; `None` if any
    /// value is not finite.
    pub(crate) fn evaluate(&self, x: &[f64]) -> Option<EvaluatedPoint> {
        let parameters = x.iter().enumerate();
        let parameters: Vec<Dual> = parameters.map(|(k, x)| Dual::parameter(k, *x)).collect();
        let rows = self.data.iter();
        let rows: Vec<Dual> = rows
            .map(|(y, at)| (self.model)(&parameters, at) - *y)
            .collect();
        let finite = |row: &Dual| row.value.is_finite() && row.by.iter().all(|by| by.is_finite());
        let column = |k: usize| {
            Some(
                rows.iter()
                    .map(|row| row.by[k])
                    .collect::<Vec<f64>>()
                    .into(),
            )
        };
        rows.iter().all(finite).then(|| EvaluatedPoint {
            residual: rows
                .iter()
                .map(|row| row.value)
                .collect::<Vec<f64>>()
                .into(),
            columns: (0..x.len()).map(column).collect(),
        })
    }
}
