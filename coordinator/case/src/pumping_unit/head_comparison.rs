//! Comparison of a newly reduced back head with the case's tables, and with the stress by mode displacement
//! alone.
//!
//! Quasi-static stress needs no dynamics: a rope of tension T, wrapped from its fixed end to the point where
//! it leaves the head, presses with T per radian and pulls its end with T. Exact statics are the influence
//! lines integrated over the wrap; mode displacement is `sum_k s_k f_k / w_k^2` for the same forces.
use super::geometry::QuasiStaticTurn;
use protocol::pumping_unit::{Influence, ModalHead, ReducedHead};
use support::interpolation::interpolate_clamped;

/// Threshold for the displacement of a mode shape along the rope surface, as a share of the table's largest
/// value; a mode below it does not move the surface.
pub const INERT: f64 = 1e-6;

/// Comparison of a newly reduced back head with the tables of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadComparison {
    /// Modes of the newly reduced head, each paired with the most similar mode of the case's table.
    pub modes: Vec<ModeMatch>,
    /// Frequencies of the table's modes that do not move the rope surface and so are not excited by a rope
    /// \[Hz\].
    pub inert_hz: Vec<f64>,
    /// Largest difference between new and old influence lines for each gauge, relative to the largest value
    /// of the case's table.
    pub influence_difference: [f64; 4],
    /// Half-ranges of the gauge stress over one crank turn, by three quasi-static methods \[MPa\].
    pub half_ranges: HalfRanges,
}

/// Pair of a mode of the newly reduced head and the most similar mode in the case's table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeMatch {
    /// Frequency of the new mode \[Hz\].
    pub frequency_hz: f64,
    /// Frequency of the table's mode \[Hz\] and modal assurance criterion of both shapes along the rope arc;
    /// `None` if the mode does not move the arc or has no counterpart in the table.
    pub table: Option<(f64, f64)>,
}

/// Half of the stress range of each of the four gauges over a quasi-static turn, by three methods \[MPa\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HalfRanges {
    /// Half-ranges from exact statics with the newly computed influence lines.
    pub exact: [f64; 4],
    /// Half-ranges from exact statics with the case's influence lines.
    pub table: [f64; 4],
    /// Half-ranges from mode displacement with the modes that the case simulates.
    pub displacement: [f64; 4],
    /// Mean stress by mode displacement minus the exact mean stress, for each gauge \[MPa\].
    pub displacement_offset: [f64; 4],
}

/// Compares a newly reduced head with the tables of a case; `modes` is the number of simulated modes.
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

/// Returns the modal assurance criterion, the squared cosine of the angle between two shapes; 0 if a shape is
/// zero.
pub fn mac(a: &[f64], b: &[f64]) -> f64 {
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

/// Returns for each gauge the largest difference between two tables of influence lines, relative to the
/// largest value of the older table.
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

/// Mode shape along the rope arc, with its frequency and gauge stress.
struct Shape<'a> {
    frequency_hz: f64,
    radial: &'a [f64],
    tangential: &'a [f64],
    gauge_stress_mpa: [f64; 4],
}

/// Back rope wrapped on the head over one quasi-static turn.
#[derive(Clone, Copy, Debug)]
pub struct WrappedTurn<'a> {
    turn: &'a QuasiStaticTurn,
    anchor_deg: f64,
}

/// Returns the wrapped rope over one turn, with its end fixed at `anchor_deg` on the arc.
pub const fn wrapped_turn(turn: &QuasiStaticTurn, anchor_deg: f64) -> WrappedTurn<'_> {
    WrappedTurn { turn, anchor_deg }
}

impl WrappedTurn<'_> {
    /// Returns the contact angle and the tension of the back rope at every crank angle.
    fn each(&self) -> impl Iterator<Item = (f64, f64)> {
        let places = self.turn.contact_deg.iter().copied();
        places.zip(self.turn.tension_n.iter().copied())
    }

    /// Computes the exact quasi-static stress at the gauges over the turn \[MPa\].
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

    /// Computes the stress at the gauges over the turn by mode displacement \[MPa\].
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

/// Piecewise linear function given by its points, constant beyond the first and last.
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
        interpolate_clamped(self.x, self.y, x)
    }

    /// Returns the exact integral of the function between two abscissas.
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
