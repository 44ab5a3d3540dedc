//! Parameters that would have to vary: each refitted alone on quarters of the abscissa and under other
//! conditions.
//!
//! A physical parameter is the same everywhere and under every condition. A parameter that would have to
//! change from part to part compensates for something that the model lacks. Everything is linear about the
//! fitted point, and standard errors come from the scatter of the same estimate from cycle to cycle, so that
//! no noise model is needed. The module does not know the meaning of a parameter.
use crate::linear::score::family_wise;
use crate::localisation::parameter_drift::linear_record::LinearizedRecord;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF as _, StudentsT};

/// Number of equal sectors of the abscissa.
const SECTORS: usize = 4;

/// Part of the data on which a parameter was refitted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum RecordPart {
    /// Sector of the abscissa.
    Sector {
        /// Start of the sector, in the unit of the first channel's abscissa.
        from: f64,
        /// End of the sector, in the unit of the first channel's abscissa.
        to: f64,
    },
    /// Whole record of another working condition, given by the condition's index.
    Condition(usize),
}

/// Shift of a parameter that one part of the data would require.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterShift {
    /// Part of the data on which the parameter was refitted.
    pub part: RecordPart,
    /// Shift of the parameter from its fitted value (coordinate of the search space).
    pub by: f64,
    /// Probability that noise shifts any parameter in any part by as much.
    pub p_value: f64,
}

/// Shifts that all parts of the data would require of one parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterDrift {
    /// Index of the parameter among the unknowns.
    pub unknown: usize,
    /// Shifts of the parameter by part of the data; the sectors of the abscissa come first.
    pub shifts: Vec<ParameterShift>,
    /// Share of the residual that the parameter removes if it may differ between the sectors of the abscissa
    /// \[1\].
    pub explained: f64,
}

/// Computes, for each unknown that influences the record, the shifts that the sectors of the abscissa and
/// other conditions would require of it; the unknown that explains most first. `priors` are the unknowns'
/// prior standard deviations.
pub(crate) fn parameter_variations(
    own: &LinearizedRecord,
    priors: &[f64],
    others: &[LinearizedRecord],
) -> Vec<ParameterDrift> {
    let Some(refit) = Refit::new(own, priors) else {
        return Vec::new();
    };
    let left = refit.project(own, &own.left);
    let settled = own.deviations.iter().map(|d| refit.project(own, d));
    let scattered: Vec<DVector<f64>> = settled.collect();
    let sectors: Vec<Sector> = (0..SECTORS)
        .map(|at| Sector::new(own, &left, &scattered, at))
        .collect();
    let seen = (0..own.columns.ncols()).filter(|k| own.columns.column(*k).norm_squared() > 0.0);
    let mut all: Vec<ParameterDrift> = seen
        .map(|k| {
            let (mut shifts, taken): (Vec<ParameterShift>, Vec<f64>) =
                sectors.iter().map(|sector| sector.shift(k)).unzip();
            shifts.extend(others.iter().map(|other| refit.elsewhere(own, other, k)));
            ParameterDrift {
                unknown: k,
                shifts,
                explained: taken.iter().sum::<f64>() / left.norm_squared().max(f64::MIN_POSITIVE),
            }
        })
        .collect();
    let tests = all.iter().map(|wander| wander.shifts.len()).sum();
    for shift in all.iter_mut().flat_map(|wander| &mut wander.shifts) {
        shift.p_value = family_wise(shift.p_value, tests);
    }
    all.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    all
}

/// Sector of the abscissa with the residual that the refit of the whole record leaves there.
struct Sector {
    part: RecordPart,
    columns: DMatrix<f64>,
    left: DVector<f64>,
    scattered: Vec<DVector<f64>>,
}

impl Sector {
    fn new(
        own: &LinearizedRecord,
        left: &DVector<f64>,
        scattered: &[DVector<f64>],
        at: usize,
    ) -> Self {
        let rows = own.rows(at, SECTORS);
        let [first, last] = own.span;
        let width = (last - first) / SECTORS as f64;
        Self {
            part: RecordPart::Sector {
                from: first + at as f64 * width,
                to: first + (at + 1) as f64 * width,
            },
            columns: own.columns.select_rows(&rows),
            left: left.select_rows(&rows),
            scattered: scattered.iter().map(|d| d.select_rows(&rows)).collect(),
        }
    }

    /// Returns the shift of an unknown that best explains the residual in this sector, and the squared length
    /// of the residual that the shift removes.
    fn shift(&self, unknown: usize) -> (ParameterShift, f64) {
        let column = self.columns.column(unknown).into_owned();
        let by = along(&column, &self.left);
        let errors = self.scattered.iter().map(|d| along(&column, d));
        let shift = ParameterShift {
            part: self.part,
            by,
            p_value: tail(by, squares(errors), self.scattered.len()),
        };
        (shift, by * by * column.norm_squared())
    }
}

/// Linear refit of all unknowns on the whole record.
struct Refit {
    curvature: Cholesky<f64, Dyn>,
}

impl Refit {
    fn new(own: &LinearizedRecord, priors: &[f64]) -> Option<Self> {
        let mut curvature = own.columns.tr_mul(&own.columns);
        for (k, deviation) in priors.iter().enumerate().take(curvature.nrows()) {
            curvature[(k, k)] += (deviation * deviation).recip();
        }
        let curvature = curvature.cholesky()?;
        Some(Self { curvature })
    }

    /// Returns the step of all unknowns that best explains a residual vector `v` on the whole record.
    fn step(&self, own: &LinearizedRecord, v: &DVector<f64>) -> DVector<f64> {
        self.curvature.solve(&own.columns.tr_mul(v))
    }

    /// Returns what remains of a residual vector `v` after the linear refit of all unknowns.
    fn project(&self, own: &LinearizedRecord, v: &DVector<f64>) -> DVector<f64> {
        v - &own.columns * self.step(own, v)
    }

    /// Returns the shift that another condition would require of the `k`-th unknown, less the shift that the
    /// linear refit of the fitted record already implies.
    fn elsewhere(
        &self,
        own: &LinearizedRecord,
        other: &LinearizedRecord,
        k: usize,
    ) -> ParameterShift {
        let column = other.columns.column(k).into_owned();
        let carried = |v: &DVector<f64>| along(&column, &(&other.columns * self.step(own, v)));
        let by = along(&column, &other.left) - carried(&own.left);
        let there = squares(other.deviations.iter().map(|d| along(&column, d)));
        let here = squares(own.deviations.iter().map(carried));
        ParameterShift {
            part: RecordPart::Condition(other.condition),
            by,
            p_value: tail(
                by,
                there + here,
                own.deviations.len().min(other.deviations.len()),
            ),
        }
    }
}

/// Returns the coefficient of the least-squares projection of the vector `v` on `column`; 0 if that is zero.
fn along(column: &DVector<f64>, v: &DVector<f64>) -> f64 {
    let length = column.norm_squared();
    if length > 0.0 {
        column.dot(v) / length
    } else {
        0.0
    }
}

/// Returns the squared standard error of the mean of values that scatter about zero.
fn squares(errors: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = errors.len() as f64;
    errors.map(|e| e * e).sum::<f64>() / (n * (n - 1.0))
}

/// Returns the two-sided p-value of a mean over `cycles` cycles, from Student's distribution.
fn tail(value: f64, squared_error: f64, cycles: usize) -> f64 {
    if squared_error <= 0.0 {
        return 1.0;
    }
    let t = value.abs() / squared_error.sqrt();
    StudentsT::new(0.0, 1.0, cycles as f64 - 1.0).map_or(1.0, |law| 2.0 * law.sf(t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::{Curves, Record, Stated, recorded};
    use search::random::{Phase, Streams};

    const GRID: usize = 120;
    const UNKNOWNS: usize = 4;

    /// Returns a synthetic change of the curves of two channels per unit of unknown `k`; its shape differs
    /// between the unknowns.
    fn change(k: usize) -> Curves {
        let curve = |c: usize| {
            (0..GRID)
                .map(|i| {
                    let turn = std::f64::consts::TAU * i as f64 / GRID as f64;
                    ((k + 1) as f64 * turn + c as f64).sin()
                        + 0.3 * ((5 * k + 2) as f64 * turn).cos()
                })
                .collect()
        };
        vec![curve(0), curve(1)]
    }

    /// Creates a record of eight noisy cycles; `moved` is the shift of each unknown at each sample.
    fn record(seed: u64, condition: usize, moved: impl Fn(usize, usize) -> f64) -> Record {
        let mut stream = Streams::new(seed, 5).at(0, Phase::Initial, condition);
        let changes: Vec<Curves> = (0..UNKNOWNS).map(change).collect();
        let cycle = |_| {
            let channel = |c: usize| {
                // neighbouring samples are alike, and the level is unknown
                let mut noise = stream.normal();
                (0..GRID)
                    .map(|i| {
                        noise = 0.8 * noise + 0.6 * stream.normal();
                        let of = |k: usize| moved(k, i) * changes[k][c][i];
                        7.0 + noise + (0..UNKNOWNS).map(of).sum::<f64>()
                    })
                    .collect()
            };
            (0..2).map(channel).collect()
        };
        Record {
            condition,
            channels: vec![recorded(0), recorded(2)],
            cycles: (0..8).map(cycle).collect(),
            held_out: false,
            stated: Stated::default(),
        }
    }

    /// Returns the parameter shifts that a record and another condition would require, linearised at a point
    /// that was fitted to the first record.
    fn found(own: &Record, other: &Record) -> Vec<ParameterDrift> {
        let changes: Vec<Curves> = (0..UNKNOWNS).map(change).collect();
        let zero = vec![vec![0.0; GRID]; 2];
        let own = LinearizedRecord::new(own, &zero, &changes);
        let other = LinearizedRecord::new(other, &zero, &changes);
        parameter_variations(&own, &[1.5; UNKNOWNS], &[other])
    }

    fn smallest_p_value(wander: &ParameterDrift) -> f64 {
        wander.shifts.iter().map(|s| s.p_value).fold(1.0, f64::min)
    }

    /// Checks the false alarm rate: for parameters that are constant everywhere, also where the fit of the
    /// first record is off, about one set in twenty has a significant shift.
    #[test]
    fn true_parameters_do_not_wander() {
        let sets = 300;
        let loud = (0..sets)
            .filter(|seed| {
                let everywhere = |k: usize, _: usize| [0.4, -0.3, 0.2, 0.5][k];
                let all = found(&record(*seed, 0, everywhere), &record(*seed, 1, everywhere));
                assert_eq!(all.len(), UNKNOWNS);
                assert!(all.iter().all(|wander| wander.shifts.len() == SECTORS + 1));
                all.iter().any(|wander| smallest_p_value(wander) < 0.05)
            })
            .count();
        assert!((3..=22).contains(&loud), "{loud} of {sets}");
    }

    #[test]
    fn one_that_differs_in_a_part_of_the_turn_is_found_there() {
        let own = record(1, 0, |k, i| if k == 2 && i < GRID / 4 { 3.0 } else { 0.0 });
        let all = found(&own, &record(1, 1, |_, _| 0.0));
        assert_eq!(all[0].unknown, 2);
        let clear: Vec<&ParameterShift> =
            all[0].shifts.iter().filter(|s| s.p_value < 1e-3).collect();
        assert_eq!(
            clear[0].part,
            RecordPart::Sector {
                from: 0.0,
                to: 90.0
            }
        );
        assert!(clear[0].by > 0.5 && all[0].explained > 0.3, "{:?}", all[0]);
    }

    #[test]
    fn one_that_differs_under_another_condition_is_found_there() {
        let other = record(2, 1, |k, _| if k == 1 { 2.0 } else { 0.0 });
        let all = found(&record(2, 0, |_, _| 0.0), &other);
        let of = |unknown: usize| all.iter().find(|w| w.unknown == unknown).unwrap();
        let shift = of(1).shifts.last().unwrap();
        assert_eq!(shift.part, RecordPart::Condition(1));
        assert!(
            shift.p_value < 1e-3 && (shift.by - 2.0).abs() < 0.5,
            "{shift:?}"
        );
        assert!(of(3).shifts.last().unwrap().p_value > 0.05);
    }

    #[test]
    fn fewer_than_three_cycles_have_no_scatter() {
        let record = record(3, 0, |_, _| 0.0);
        assert!(LinearizedRecord::suits(&record) && !LinearizedRecord::suits(&record.part(0..2)));
    }
}
