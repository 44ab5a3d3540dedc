//! The machine as a laboratory.
use super::{fineness::is_shorter, stand_in::Machine};
use crate::case::grid;
use discrepancy::laboratory::{Laboratory, Stage};
use protocol::job::{Numerics, Observation, SimulateSpec};
use std::convert::Infallible;

/// What discretisation does to the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Roughness {
    /// Nothing.
    Exact,
    /// The usual one adds a ripple to every gauge (MPa).
    Ripple(f64),
    /// It does so once an effect is on: MPa per size of the effect.
    RippleOf(&'static str, f64),
    /// No finer one completes.
    NothingFiner,
    /// None of shorter cylinders does.
    NoShorterCylinders,
}

/// Waves of a ripple in a turn, and its size at each gauge.
const RIPPLES: f64 = 17.0;
const AT_GAUGES: [f64; 4] = [1.0, -0.7, 0.8, 0.5];

/// Adds a ripple to the gauges (MPa).
pub(crate) fn ripple(gauges: &mut [Vec<f64>], size: f64) {
    for (gauge, share) in gauges.iter_mut().zip(AT_GAUGES) {
        for (y, angle) in gauge.iter_mut().zip(grid()) {
            *y += size * share * (RIPPLES * angle + 0.7).cos();
        }
    }
}

/// A laboratory that simulates at once; some of its runs may be lost, and its effects may go by
/// other names.
pub(crate) struct AtOnce<'a> {
    machine: &'a Machine,
    /// One run in so many is lost, spread as a counter's hash spreads them; none if 0.
    lost_every: u64,
    /// Names that are used outside, with the machine's own.
    labels: &'a [(String, String)],
    numerics: Roughness,
    runs: u64,
    /// Runs that were lost.
    pub(crate) lost: u64,
}

impl<'a> AtOnce<'a> {
    pub(crate) const fn new(
        machine: &'a Machine,
        lost_every: u64,
        labels: &'a [(String, String)],
        numerics: Roughness,
    ) -> Self {
        Self {
            machine,
            lost_every,
            labels,
            numerics,
            runs: 0,
            lost: 0,
        }
    }

    fn one(&mut self, mut spec: SimulateSpec) -> Option<Observation> {
        self.runs += 1;
        let hash = self.runs.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        if self.lost_every > 0 && hash.is_multiple_of(self.lost_every) {
            self.lost += 1;
            return None;
        }
        for effect in &mut spec.individual.effects {
            if let Some((_, own)) = self.labels.iter().find(|(label, _)| *label == effect.id) {
                effect.id.clone_from(own);
            }
        }
        let shorter = is_shorter(&spec.numerics);
        let ripples = match self.numerics {
            Roughness::NothingFiner if spec.numerics != Numerics::OF_THE_CASE => {
                return None;
            }
            Roughness::NoShorterCylinders if shorter => return None,
            Roughness::Ripple(size) if !shorter => size,
            Roughness::RippleOf(id, size) if !shorter => {
                let own = spec.individual.effects.iter().find(|e| e.id == id);
                size * own.map_or(0.0, |e| e.parameters[0].1)
            }
            Roughness::Exact
            | Roughness::Ripple(_)
            | Roughness::RippleOf(..)
            | Roughness::NothingFiner
            | Roughness::NoShorterCylinders => 0.0,
        };
        let mut seen = self.machine.observe(&spec);
        ripple(&mut seen.curves, ripples);
        Some(seen)
    }
}

impl Laboratory for AtOnce<'_> {
    type Error = Infallible;

    async fn observe(
        &mut self,
        _: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, Infallible> {
        Ok(batch.into_iter().map(|spec| self.one(spec)).collect())
    }
}
