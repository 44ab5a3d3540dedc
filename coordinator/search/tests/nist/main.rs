//! Comparison of the least-squares solver of `calibrate` and `diagnose` with the certified values of NIST's
//! Statistical Reference Datasets for nonlinear regression: correct digits of parameters and of standard
//! errors, from both starts, with exact Jacobian columns and with the search's own differences.
//!
//! `cargo test -p search --test nist -- --nocapture` prints the table.
mod dual;
mod model;
mod set;

use model::MODELS;
use nalgebra::DMatrix;
use search::least_squares::{LeastSquares, LeastSquaresSettings, Variable};
use set::Set;

/// Maximum number of digits counted, as certified values are not more precise.
const MOST: f64 = 10.0;

/// Data sets for which no fit converges from start 1, because the first step leads to where the model is flat
/// in a parameter, or to another minimum.
const FAR: [&str; 4] = ["MGH17", "BoxBOD", "MGH10", "Eckerle4"];

/// Accuracy of a fit: fewest correct digits of any parameter and of any standard error, and number of points
/// evaluated.
struct Fit {
    parameters: f64,
    errors: f64,
    points: u64,
}

/// Fits a data set from a start, with exact Jacobian columns or by central differences.
fn fit(set: &Set, start: &[f64], exact: bool) -> Fit {
    let variable = |start: &f64| Variable {
        start: *start,
        lower: f64::NEG_INFINITY,
        upper: f64::INFINITY,
        // the cube root of rounding, which suits central differences
        step: 6e-6 * start.abs(),
        longest: f64::INFINITY,
        prior: None,
    };
    let settings = LeastSquaresSettings {
        iterations: 2000,
        gradient: 1e-11,
        decrease: 0.0,
        step_range: 1.0,
        central: true,
        exact,
        ..LeastSquaresSettings::default()
    };
    let mut search = LeastSquares::new(start.iter().map(variable).collect(), settings);
    while search.ended().is_none() {
        let mut found = Vec::new();
        for x in search.plan() {
            found.push(set.evaluate(&x).map(|mut found| {
                if !search.wants_columns() {
                    found.columns.clear();
                }
                found
            }));
        }
        search.absorb(found);
    }
    let best = search.best();
    let errors = standard_errors(&best.jacobian, best.residual.norm_squared());
    Fit {
        parameters: digits(&best.x, &set.parameters),
        errors: digits(&errors, &set.errors),
        points: search.work().0,
    }
}

/// Returns the standard errors of the fitted parameters: roots of the diagonal of `s^2 (J^T J)^-1` with `s^2
/// = |r|^2 / (n - p)`, by QR factorisation of `J` with columns scaled to norm 1.
fn standard_errors(jacobian: &DMatrix<f64>, square: f64) -> Vec<f64> {
    let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let mut scaled = jacobian.clone();
    for (mut column, length) in scaled.column_iter_mut().zip(&lengths) {
        column /= *length;
    }
    let Some(inverse) = scaled.qr().r().try_inverse() else {
        return vec![f64::NAN; lengths.len()];
    };
    let freedom = (jacobian.nrows() - jacobian.ncols()) as f64;
    let rows = inverse.row_iter().zip(&lengths);
    rows.map(|(row, length)| row.norm() / length * (square / freedom).sqrt())
        .collect()
}

/// Returns the smallest number of decimal digits in which any value agrees with its certified one, at most
/// [`MOST`].
fn digits(values: &[f64], certified: &[f64]) -> f64 {
    let pairs = values.iter().zip(certified);
    let one = pairs.map(|(value, known)| -((value - known) / known).abs().log10());
    one.fold(MOST, |least, own| {
        if own.is_nan() {
            0.0
        } else {
            least.min(own).max(0.0)
        }
    })
}

#[test]
fn certified_values_are_met() {
    println!("{:10} {:>23} {:>23}", "", "exact columns", "differences");
    println!(
        "{:10} start  values errors points  values errors points",
        ""
    );
    let (mut missed, mut far) = (Vec::new(), Vec::new());
    for (name, model) in MODELS {
        let set = Set::read(name, model);
        for (place, start) in set.starts.iter().enumerate() {
            print!("{name:10} {:5}", place + 1);
            for (exact, wanted) in [(true, 6.0), (false, 4.0)] {
                let found = fit(&set, start, exact);
                let Fit {
                    parameters,
                    errors,
                    points,
                } = found;
                print!(" {parameters:7.1} {errors:6.1} {points:6}");
                // its residual is the rounding of its data
                let met = parameters >= wanted && (errors >= wanted || name == "Lanczos1");
                if !met {
                    let failed = if place == 0 { &mut far } else { &mut missed };
                    if failed.last() != Some(&name) {
                        failed.push(name);
                    }
                }
            }
            println!();
        }
    }
    println!("not from start 1: {far:?}");
    assert!(missed.is_empty(), "from start 2: {missed:?}");
    assert_eq!(far, FAR, "from start 1");
}
