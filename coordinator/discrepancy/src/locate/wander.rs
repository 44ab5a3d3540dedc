//! Parameters that would have to wander: each refitted alone on quarters of the turn and under other
//! conditions.
//!
//! A parameter of the machine is the same at every crank angle and at every speed. One that would have
//! to change from part to part makes up for something that the model lacks. Everything is linear about
//! the fitted point, and errors are the scatter of the same estimate from cycle to cycle, so that they
//! need no model of the noise. It does not know what a parameter means.
use crate::record::{Curves, Record, mean_of};
use crate::score::family_wise;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use statrs::distribution::{ContinuousCDF as _, StudentsT};
use std::ops::Range;

/// Parts of the turn.
const SECTORS: usize = 4;
/// Fewer cycles than these have no scatter to speak of.
const CYCLES: usize = 3;

/// Where a parameter was refitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// A part of the turn, from bottom dead centre.
    Sector {
        /// Where it begins \[deg\].
        from_deg: f64,
        /// Where it ends \[deg\].
        to_deg: f64,
    },
    /// The whole turn under another condition, by its index.
    Condition(usize),
}

/// How far a parameter would have to move in one part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Which part.
    pub part: Part,
    /// From the fitted point (coordinate).
    pub by: f64,
    /// Probability that noise moves any parameter in any part so far.
    pub p_value: f64,
}

/// One parameter and its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Wander {
    /// Its position among the unknowns.
    pub unknown: usize,
    /// Its parts, those of the turn first.
    pub shifts: Vec<Shift>,
    /// Share of what is left that it takes up if it may be another in every part of the turn \[1\].
    pub explained: f64,
}

/// What is left of a record at the fitted point, cycle by cycle, and how the unknowns change it: grid
/// after grid of all channels, about their means (gauges have no zero), in units of the cycles' scatter.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Of the mean of the cycles.
    left: DVector<f64>,
    /// Each cycle less their mean.
    deviations: Vec<DVector<f64>>,
    /// A column per unknown, per unit of it.
    columns: DMatrix<f64>,
    /// Samples of a turn.
    samples: usize,
}

impl Sheet {
    /// Whether a record has cycles enough.
    pub fn suits(record: &Record) -> bool {
        record.cycles.len() >= CYCLES
    }

    /// Of a record that suits, the curves at the fitted point, and the curves' change per unit of each
    /// unknown.
    pub fn new(record: &Record, fitted: &Curves, changes: &[Curves]) -> Self {
        let variance = record.cycle_variance();
        let flat = |curves: &Curves| {
            let channels = curves.iter().zip(&variance);
            let scaled = channels.flat_map(|(curve, variance)| {
                let mean = curve.iter().sum::<f64>() / curve.len().max(1) as f64;
                // a channel without scatter was not measured
                let weight = if *variance > 0.0 {
                    variance.sqrt().recip()
                } else {
                    0.0
                };
                curve.iter().map(move |y| weight * (y - mean))
            });
            DVector::from_iterator(curves.iter().map(Vec::len).sum(), scaled)
        };
        let mean = flat(&mean_of(&record.cycles.iter().collect::<Vec<_>>()));
        let columns: Vec<DVector<f64>> = changes.iter().map(flat).collect();
        Self {
            left: &mean - flat(fitted),
            deviations: record.cycles.iter().map(|c| flat(c) - &mean).collect(),
            columns: DMatrix::from_columns(&columns),
            samples: record.samples(),
        }
    }

    /// Rows of the samples of a sector, channel after channel.
    fn rows(&self, sector: usize) -> Vec<usize> {
        let end = |k: usize| k * self.samples / SECTORS;
        let own: Range<usize> = end(sector)..end(sector + 1);
        let channels = (0..self.left.len()).step_by(self.samples.max(1));
        channels
            .flat_map(|c| own.clone().map(move |i| c + i))
            .collect()
    }
}

/// How the unknowns would have to wander between the parts of a turn and to other conditions, for those
/// that the record sees; the one that explains most first. `deviations` are those of the priors.
pub fn wanders(own: &Sheet, deviations: &[f64], others: &[(usize, Sheet)]) -> Vec<Wander> {
    let Some(refit) = Refit::new(own, deviations) else {
        return Vec::new();
    };
    let sectors: Vec<Vec<usize>> = (0..SECTORS).map(|k| own.rows(k)).collect();
    let left = refit.settle(own, &own.left);
    let scattered: Vec<DVector<f64>> = own
        .deviations
        .iter()
        .map(|d| refit.settle(own, d))
        .collect();
    let seen = (0..own.columns.ncols()).filter(|k| own.columns.column(*k).norm_squared() > 0.0);
    let mut all: Vec<Wander> = seen
        .map(|k| {
            let in_sector = |(s, rows): (usize, &Vec<usize>)| {
                let column = own.columns.column(k).select_rows(rows);
                let at = |v: &DVector<f64>| along(&column, &v.select_rows(rows));
                let errors = scattered.iter().map(at);
                let degrees = 360.0 / SECTORS as f64;
                Shift {
                    part: Part::Sector {
                        from_deg: s as f64 * degrees,
                        to_deg: (s + 1) as f64 * degrees,
                    },
                    by: at(&left),
                    p_value: tail(at(&left), squares(errors), own.deviations.len()),
                }
            };
            let mut shifts: Vec<Shift> = sectors.iter().enumerate().map(in_sector).collect();
            let taken: f64 = shifts
                .iter()
                .zip(&sectors)
                .map(|(shift, rows)| {
                    let column = own.columns.column(k).select_rows(rows);
                    shift.by * shift.by * column.norm_squared()
                })
                .sum();
            shifts.extend(others.iter().map(|other| refit.elsewhere(own, other, k)));
            Wander {
                unknown: k,
                shifts,
                explained: taken / left.norm_squared().max(f64::MIN_POSITIVE),
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

/// The linear refit of all unknowns on the whole turn.
struct Refit {
    curvature: Cholesky<f64, Dyn>,
}

impl Refit {
    fn new(own: &Sheet, deviations: &[f64]) -> Option<Self> {
        let mut curvature = own.columns.tr_mul(&own.columns);
        for (k, deviation) in deviations.iter().enumerate().take(curvature.nrows()) {
            curvature[(k, k)] += (deviation * deviation).recip();
        }
        let curvature = curvature.cholesky()?;
        Some(Self { curvature })
    }

    /// The step that the whole turn asks for.
    fn step(&self, own: &Sheet, v: &DVector<f64>) -> DVector<f64> {
        self.curvature.solve(&own.columns.tr_mul(v))
    }

    /// What that step leaves.
    fn settle(&self, own: &Sheet, v: &DVector<f64>) -> DVector<f64> {
        v - &own.columns * self.step(own, v)
    }

    /// An unknown under another condition, beside the error that the fit itself has.
    fn elsewhere(&self, own: &Sheet, (condition, other): &(usize, Sheet), k: usize) -> Shift {
        let column = other.columns.column(k).into_owned();
        let carried = |v: &DVector<f64>| along(&column, &(&other.columns * self.step(own, v)));
        let by = along(&column, &other.left) - carried(&own.left);
        let there = squares(other.deviations.iter().map(|d| along(&column, d)));
        let here = squares(own.deviations.iter().map(carried));
        Shift {
            part: Part::Condition(*condition),
            by,
            p_value: tail(
                by,
                there + here,
                own.deviations.len().min(other.deviations.len()),
            ),
        }
    }
}

/// How much of a column a vector holds; nothing of none.
fn along(column: &DVector<f64>, v: &DVector<f64>) -> f64 {
    let length = column.norm_squared();
    if length > 0.0 {
        column.dot(v) / length
    } else {
        0.0
    }
}

/// Squared standard error of the mean of values that scatter about zero.
fn squares(errors: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = errors.len() as f64;
    errors.map(|e| e * e).sum::<f64>() / (n * (n - 1.0))
}

/// Probability that noise alone brings a mean so far from zero.
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
    use crate::record::{Source, Stated};
    use search::random::{Phase, Streams};

    const GRID: usize = 120;
    const UNKNOWNS: usize = 4;

    /// Change of two channels per unit of an unknown: different shapes along the turn.
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

    /// Eight cycles of noise about what the unknowns do; `moved` says how far each is moved at a sample.
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
            channels: vec![Source::Gauge(1), Source::Gauge(3)],
            cycles: (0..8).map(cycle).collect(),
            stated: Stated::default(),
        }
    }

    /// The sheets of a record and of another condition at a point that was fitted to the first.
    fn found(own: &Record, other: &Record) -> Vec<Wander> {
        let changes: Vec<Curves> = (0..UNKNOWNS).map(change).collect();
        let zero = vec![vec![0.0; GRID]; 2];
        let own = Sheet::new(own, &zero, &changes);
        let other = Sheet::new(other, &zero, &changes);
        wanders(&own, &[1.5; UNKNOWNS], &[(1, other)])
    }

    fn least(wander: &Wander) -> f64 {
        wander.shifts.iter().map(|s| s.p_value).fold(1.0, f64::min)
    }

    /// Of parameters that are what they are everywhere, also where the fit of the first record is off,
    /// one set in twenty shows some that would wander.
    #[test]
    fn true_parameters_do_not_wander() {
        let sets = 300;
        let loud = (0..sets)
            .filter(|seed| {
                let everywhere = |k: usize, _: usize| [0.4, -0.3, 0.2, 0.5][k];
                let all = found(&record(*seed, 0, everywhere), &record(*seed, 1, everywhere));
                assert_eq!(all.len(), UNKNOWNS);
                assert!(all.iter().all(|wander| wander.shifts.len() == SECTORS + 1));
                all.iter().any(|wander| least(wander) < 0.05)
            })
            .count();
        assert!((3..=30).contains(&loud), "{loud} of {sets}");
    }

    #[test]
    fn one_that_differs_in_a_part_of_the_turn_is_found_there() {
        let own = record(1, 0, |k, i| if k == 2 && i < GRID / 4 { 3.0 } else { 0.0 });
        let all = found(&own, &record(1, 1, |_, _| 0.0));
        assert_eq!(all[0].unknown, 2);
        let clear: Vec<&Shift> = all[0].shifts.iter().filter(|s| s.p_value < 1e-3).collect();
        assert_eq!(
            clear[0].part,
            Part::Sector {
                from_deg: 0.0,
                to_deg: 90.0
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
        assert_eq!(shift.part, Part::Condition(1));
        assert!(
            shift.p_value < 1e-3 && (shift.by - 2.0).abs() < 0.5,
            "{shift:?}"
        );
        assert!(of(3).shifts.last().unwrap().p_value > 0.05);
    }

    #[test]
    fn fewer_than_three_cycles_have_no_scatter() {
        let record = record(3, 0, |_, _| 0.0);
        assert!(Sheet::suits(&record) && !Sheet::suits(&record.part(0..2)));
    }
}
