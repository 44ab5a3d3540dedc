//! The back head reduced anew: against the case's tables, and what its modes alone would show.
//!
//! Quasi-static stress needs no dynamics: a rope of tension T wrapped from its fixed end to where it
//! leaves presses with T per radian and pulls its end with T. Exact statics are influence lines
//! integrated over the wrap; mode displacement is `sum_k s_k f_k / w_k^2` of the same forces.
use super::geometry::QuasiStatic;
use protocol::pumping_unit::{Influence, ModalHead, ReducedHead};
use support::interpolation::held;

/// Shapes smaller than this share of the table's largest move nothing.
const INERT: f64 = 1e-6;

/// A new head beside the case's tables.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadComparison {
    /// One entry per new mode.
    pub modes: Vec<ModeMatch>,
    /// Modes of the table that do not move the rope surface \[Hz\]: no rope drives them.
    pub inert_hz: Vec<f64>,
    /// Largest difference of the influence lines, over the table's largest value, per gauge.
    pub influence_difference: [f64; 4],
    /// Half of the range of stress over the quasi-static turn \[MPa\].
    pub half_ranges: HalfRanges,
}

/// A mode and the table's most similar one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeMatch {
    /// Its frequency \[Hz\].
    pub frequency_hz: f64,
    /// The table's frequency \[Hz\] and the modal assurance criterion of the two shapes along the
    /// rope arc; none for a mode that does not move it or that the table lacks.
    pub table: Option<(f64, f64)>,
}

/// Half-ranges of the four gauges over a quasi-static turn \[MPa\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HalfRanges {
    /// Exact, by the new influence lines.
    pub exact: [f64; 4],
    /// Exact, by the case's.
    pub table: [f64; 4],
    /// By mode displacement with the modes that the case simulates.
    pub displacement: [f64; 4],
    /// Mean level by mode displacement less the exact one.
    pub displacement_offset: [f64; 4],
}

/// Compares a new head with the tables of a case; `modes` is the number that is simulated.
pub fn compare_head(
    new: &ReducedHead,
    table: &ModalHead,
    turn: &WrappedTurn<'_>,
    modes: usize,
) -> HeadComparison {
    let entries = table.radial.iter().chain(&table.tangential).flatten();
    let largest = entries.fold(0.0_f64, |most, x| most.max(x.abs()));
    let moves = |shape: &[f64]| shape.iter().any(|x| x.abs() > INERT * largest);
    let known: Vec<(f64, Vec<f64>)> = table
        .frequencies_hz
        .iter()
        .zip(table.radial.iter().zip(&table.tangential))
        .map(|(hz, (radial, tangential))| (*hz, [&radial[..], &tangential[..]].concat()))
        .collect();
    let (moving, inert): (Vec<_>, Vec<_>) = known.iter().partition(|(_, shape)| moves(shape));
    let comparable = new.influence.psi_deg == table.arc_deg;
    let shapes: Vec<Vec<f64>> = new
        .modes
        .iter()
        .map(|mode| [&mode.radial[..], &mode.tangential[..]].concat())
        .collect();
    let best = |shape: &[f64], others: &mut dyn Iterator<Item = &Vec<f64>>| {
        let alike = others.map(|other| mac(shape, other)).enumerate();
        alike.max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let matches = new.modes.iter().zip(&shapes).enumerate();
    let matches = matches.map(|(k, (mode, shape))| {
        let found = (comparable && moves(shape))
            .then(|| best(shape, &mut moving.iter().map(|(_, other)| other)))
            .flatten();
        // each the other's best: a mode that the table lacks is like none of it
        let mutual = found.and_then(|(at, mac)| {
            let (hz, other) = moving.get(at)?;
            let (back, _) = best(other, &mut shapes.iter())?;
            (back == k).then_some((*hz, mac))
        });
        ModeMatch {
            frequency_hz: mode.frequency_hz,
            table: mutual,
        }
    });
    let simulated = new.modes.iter().take(modes).map(|mode| Shape {
        frequency_hz: mode.frequency_hz,
        radial: &mode.radial,
        tangential: &mode.tangential,
        gauge_stress_mpa: mode.gauge_stress_mpa,
    });
    let simulated: Vec<Shape<'_>> = simulated.collect();
    let exact = turn.exact(&new.influence);
    let displacement = turn.displacement(&new.influence.psi_deg, &simulated);
    let mean = |curve: &[f64]| curve.iter().sum::<f64>() / curve.len().max(1) as f64;
    HeadComparison {
        modes: matches.collect(),
        inert_hz: inert.iter().map(|(hz, _)| *hz).collect(),
        influence_difference: difference(&new.influence, &table.influence),
        half_ranges: HalfRanges {
            table: turn
                .exact(&table.influence)
                .each_ref()
                .map(|c| half_range(c)),
            displacement: displacement.each_ref().map(|c| half_range(c)),
            displacement_offset: [0, 1, 2, 3].map(|g| mean(&displacement[g]) - mean(&exact[g])),
            exact: exact.each_ref().map(|c| half_range(c)),
        },
    }
}

/// Modal assurance criterion: squared cosine of the angle between two shapes; 0 for no shape.
fn mac(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let sizes = dot(a, a) * dot(b, b);
    if sizes > 0.0 {
        dot(a, b).powi(2) / sizes
    } else {
        0.0
    }
}

fn half_range(curve: &[f64]) -> f64 {
    let high = curve.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = curve.iter().copied().fold(f64::INFINITY, f64::min);
    0.5 * (high - low)
}

/// Largest difference at the new stations over the old table's largest value, per gauge.
fn difference(new: &Influence, old: &Influence) -> [f64; 4] {
    [0, 1, 2, 3].map(|gauge| {
        let (mut most, mut size) = (0.0_f64, 0.0_f64);
        for (new_rows, old_rows) in [
            (&new.normal_mpa_per_n, &old.normal_mpa_per_n),
            (&new.tangential_mpa_per_n, &old.tangential_mpa_per_n),
        ] {
            let ours = column(new_rows, gauge);
            let theirs = column(old_rows, gauge);
            size = theirs.iter().fold(size, |size, x| size.max(x.abs()));
            for (psi, value) in new.psi_deg.iter().zip(&ours) {
                most = most.max((value - Line::new(&old.psi_deg, &theirs).at(*psi)).abs());
            }
        }
        most / size
    })
}

fn column(rows: &[[f64; 4]], gauge: usize) -> Vec<f64> {
    rows.iter().map(|row| row[gauge]).collect()
}

/// A mode along the rope arc.
struct Shape<'a> {
    frequency_hz: f64,
    radial: &'a [f64],
    tangential: &'a [f64],
    gauge_stress_mpa: [f64; 4],
}

/// The wrapped rope over one turn.
#[derive(Clone, Copy, Debug)]
pub struct WrappedTurn<'a> {
    turn: &'a QuasiStatic,
    anchor_deg: f64,
}

/// The wrapped rope over one turn, fixed at `anchor_deg` on the arc.
pub const fn wrapped_turn(turn: &QuasiStatic, anchor_deg: f64) -> WrappedTurn<'_> {
    WrappedTurn { turn, anchor_deg }
}

impl WrappedTurn<'_> {
    /// Place and tension of the rope at every crank angle.
    fn each(&self) -> impl Iterator<Item = (f64, f64)> {
        let places = self.turn.contact_deg.iter().copied();
        places.zip(self.turn.tension_n.iter().copied())
    }

    /// Exact stress at the gauges over the turn \[MPa\].
    pub fn exact(&self, influence: &Influence) -> [Vec<f64>; 4] {
        [0, 1, 2, 3].map(|gauge| {
            let normal = column(&influence.normal_mpa_per_n, gauge);
            let tangential = column(&influence.tangential_mpa_per_n, gauge);
            let normal = Line::new(&influence.psi_deg, &normal);
            let end = Line::new(&influence.psi_deg, &tangential).at(self.anchor_deg);
            let stress = |(leaves, tension)| {
                tension * (normal.integral(self.anchor_deg, leaves).to_radians() + end)
            };
            self.each().map(stress).collect()
        })
    }

    /// Stress at the gauges over the turn that the modes alone show \[MPa\].
    fn displacement(&self, arc_deg: &[f64], modes: &[Shape<'_>]) -> [Vec<f64>; 4] {
        let mut stress = [0, 1, 2, 3].map(|_| vec![0.0; self.turn.turn_deg.len()]);
        for mode in modes {
            let radial = Line::new(arc_deg, mode.radial);
            let end = Line::new(arc_deg, mode.tangential).at(self.anchor_deg);
            let square = (mode.frequency_hz * std::f64::consts::TAU).powi(2);
            for (k, (leaves, tension)) in self.each().enumerate() {
                let wrap = radial.integral(self.anchor_deg, leaves).to_radians();
                let coordinate = tension * (end - wrap) / square;
                for (curve, per_unit) in stress.iter_mut().zip(mode.gauge_stress_mpa) {
                    if let Some(value) = curve.get_mut(k) {
                        *value += coordinate * per_unit;
                    }
                }
            }
        }
        stress
    }
}

/// A table, linear between its points and constant beyond.
#[derive(Clone, Copy, Debug)]
struct Line<'a> {
    x: &'a [f64],
    y: &'a [f64],
}

impl<'a> Line<'a> {
    const fn new(x: &'a [f64], y: &'a [f64]) -> Self {
        Self { x, y }
    }

    fn at(&self, x: f64) -> f64 {
        held(self.x, self.y, x)
    }

    /// Exact integral of the line between two places, in the unit of x times that of y.
    fn integral(&self, from: f64, to: f64) -> f64 {
        let inside = self.x.iter().copied().filter(|x| *x > from && *x < to);
        let knots: Vec<f64> = std::iter::once(from).chain(inside).chain([to]).collect();
        let pieces = knots.windows(2).map(|piece| match piece {
            [a, b] => 0.5 * (b - a) * (self.at(*a) + self.at(*b)),
            _ => 0.0,
        });
        pieces.sum()
    }
}
