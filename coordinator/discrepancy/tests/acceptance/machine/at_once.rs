//! Laboratory that answers at once from the stand-in machine.
use super::{fineness::is_shorter, stand_in::Machine};
use crate::case::grid;
use discrepancy::laboratory::{Laboratory, Stage};
use protocol::case::EffectSetting;
use protocol::job::{Column, Derivative, Numerics, Observation, Per, SimulateSpec, Verdict};
use std::convert::Infallible;

/// Discretisation error of the stand-in machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Roughness {
    Exact,
    /// Ripple on every gauge with the usual discretisation (MPa).
    Ripple(f64),
    /// Ripple on every gauge while the named effect is on (MPa per unit of the effect's size).
    RippleOf(&'static str, f64),
    /// Every simulation with a finer discretisation fails.
    NothingFiner,
    /// Every simulation with shorter cylinders fails.
    NoShorterCylinders,
}

/// Number of ripple waves per turn; `AT_GAUGES` has the relative amplitude at each gauge.
const RIPPLES: f64 = 17.0;
const AT_GAUGES: [f64; 4] = [1.0, -0.7, 0.8, 0.5];

/// Adds a cosine ripple of amplitude `size` (MPa) to the simulated gauge readings.
pub(crate) fn ripple(gauges: &mut [Vec<f64>], size: f64) {
    for (gauge, share) in gauges.iter_mut().zip(AT_GAUGES) {
        for (y, angle) in gauge.iter_mut().zip(grid()) {
            *y += size * share * (RIPPLES * angle + 0.7).cos();
        }
    }
}

/// Laboratory that simulates at once; a share of its runs may be lost, and its effects may have other labels
/// outside than in the machine.
pub(crate) struct ImmediateLaboratory<'a> {
    machine: &'a Machine,
    /// Reciprocal of the share of simulation runs that are lost; 0 loses none.
    lost_every: u64,
    /// Pairs of the effect label used outside the machine and the machine's own identifier of the effect.
    labels: &'a [(String, String)],
    numerics: Roughness,
    /// Whether observations include the requested derivatives of the curves.
    columns: bool,
    runs: u64,
    /// Number of simulation runs lost so far.
    pub(crate) lost: u64,
}

impl<'a> ImmediateLaboratory<'a> {
    pub(crate) const fn new(
        machine: &'a Machine,
        lost_every: u64,
        labels: &'a [(String, String)],
        numerics: Roughness,
        columns: bool,
    ) -> Self {
        Self {
            machine,
            lost_every,
            labels,
            numerics,
            columns,
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
        let mut seen = self.simulated(&spec)?;
        let columns = std::mem::take(&mut spec.columns);
        seen.columns = columns.iter().map(|own| self.column(&spec, own)).collect();
        Some(seen)
    }

    /// Simulates a job stated in the machine's own identifiers; returns `None` where the simulation does not
    /// complete.
    fn simulated(&self, spec: &SimulateSpec) -> Option<Observation> {
        let shorter = is_shorter(&spec.numerics);
        let ripples = match self.numerics {
            Roughness::NothingFiner if spec.numerics != Numerics::FROM_CASE => {
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
        let mut seen = self.machine.observe(spec);
        ripple(&mut seen.curves, ripples);
        Some(seen)
    }

    /// Returns the derivative for a column: central differences of two step sizes, extrapolated to step zero
    /// (Richardson); `Derivative::Missing` where the two differ too much, e.g. at a kink.
    fn column(&self, spec: &SimulateSpec, column: &Column) -> Derivative {
        let missing = |reason: &str| Derivative::Missing {
            reason: reason.to_owned(),
        };
        let Some(varied) = self.varied(spec, column) else {
            return missing("it is nothing of this machine");
        };
        if column.name.starts_with("probe.") {
            // a force without a cause is linear in its amplitude, but for laws beside it that are not
            let step = varied.step;
            let (Some(with), Some(without)) = (
                self.simulated(&varied.by(step)),
                self.simulated(&varied.by(0.0)),
            ) else {
                return missing("a neighbour does not complete");
            };
            let channels = with.curves.iter().zip(&without.curves);
            let slope = |(a, b): (&Vec<f64>, &Vec<f64>)| {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| ((a - b) / step) as f32)
                    .collect()
            };
            return Derivative::Curves {
                per: Per::Unit(String::new()),
                curves: channels.map(slope).collect(),
            };
        }
        let slope = |step: f64| -> Option<Vec<Vec<f64>>> {
            let [above, below] = [step, -step].map(|by| self.simulated(&varied.by(by)));
            let (above, below) = (above?, below?);
            if [&above, &below]
                .iter()
                .any(|own| own.verdict != Verdict::Complete)
            {
                return None;
            }
            let curves = above.curves.iter().zip(&below.curves);
            let slope = |(a, b): (&Vec<f64>, &Vec<f64>)| {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| (a - b) / (2.0 * step))
                    .collect()
            };
            Some(curves.map(slope).collect())
        };
        let (Some(coarse), Some(fine)) = (slope(varied.step), slope(0.5 * varied.step)) else {
            return missing("a neighbour does not complete");
        };
        let (mut largest, mut apart) = (0.0_f64, 0.0_f64);
        let pairs = coarse.iter().flatten().zip(fine.iter().flatten());
        for (a, b) in pairs {
            largest = largest.max(b.abs());
            apart = apart.max((a - b).abs());
        }
        if apart > AGREE * largest {
            return missing("it has a kink here");
        }
        let extrapolated = |(a, b): (&f64, &f64)| ((4.0 * b - a) / 3.0) as f32;
        let channels = coarse.iter().zip(&fine);
        Derivative::Curves {
            per: Per::Unit(String::new()),
            curves: channels
                .map(|(a, b)| a.iter().zip(b).map(extrapolated).collect())
                .collect(),
        }
    }

    /// Returns the simulation with the value that a requested derivative varies, and the finite-difference
    /// step; `None` if the machine has no value of that name.
    fn varied(&self, spec: &SimulateSpec, column: &Column) -> Option<Varied> {
        let mut spec = spec.clone();
        if let Some(k) = column
            .name
            .strip_prefix('x')
            .and_then(|k| k.parse::<usize>().ok())
        {
            let step = STEP * spec.individual.genes.get(k)?;
            return Some(Varied {
                spec,
                place: Place::Unknown(k),
                step,
            });
        }
        let (label, parameter) = column.name.rsplit_once('.')?;
        let own = self.labels.iter().find(|(other, _)| other == label);
        let id = own.map_or(label, |(_, own)| own);
        let effect = self.machine.library().iter().find(|e| e.id == id)?;
        let k = effect.parameters.iter().position(|p| p.name == parameter)?;
        let all = &mut spec.individual.effects;
        let at = all.iter().position(|e| e.id == id).unwrap_or_else(|| {
            let value = |p: &protocol::announce::ParameterDescriptor| {
                let stated = column.values.iter().find(|(name, _)| *name == p.name);
                (p.name.clone(), stated.map_or(p.absent, |(_, value)| *value))
            };
            all.push(EffectSetting {
                id: id.to_owned(),
                parameters: effect.parameters.iter().map(value).collect(),
            });
            all.len() - 1
        });
        Some(Varied {
            spec,
            place: Place::Effect(at, k),
            step: STEP * effect.parameters[k].scale,
        })
    }
}

/// Step of the finite differences, as a share of the varied value or of the effect's usual size; `AGREE` is
/// the largest relative difference allowed between the results of two step sizes.
const STEP: f64 = 2e-3;
const AGREE: f64 = 1e-4;

/// Simulation of which one value is varied for a finite difference.
struct Varied {
    spec: SimulateSpec,
    place: Place,
    step: f64,
}

/// Location, in a simulation's inputs, of the number that is varied for a finite difference.
#[derive(Clone, Copy)]
enum Place {
    Unknown(usize),
    /// Parameter of an effect: index of the effect, and index of its parameter.
    Effect(usize, usize),
}

impl Varied {
    fn by(&self, step: f64) -> SimulateSpec {
        let mut spec = self.spec.clone();
        match self.place {
            Place::Unknown(k) => spec.individual.genes[k] += step,
            Place::Effect(at, k) => spec.individual.effects[at].parameters[k].1 += step,
        }
        spec
    }
}

impl Laboratory for ImmediateLaboratory<'_> {
    type Error = Infallible;

    fn differentiates(&self) -> bool {
        self.columns
    }

    async fn observe(
        &mut self,
        _: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, Infallible> {
        Ok(batch.into_iter().map(|spec| self.one(spec)).collect())
    }
}
