//! Columns that must be computed: source of their derivatives, and explicit derivatives of the gauge
//! readings.
use super::column::{Changes, Coefficient};
use super::differences::Difference;
use super::plan::Way;
use super::side::Side;
use super::source::{Joints, ROPES, Source};
use crate::element::impact::By;
use crate::integrator::dense::interpolate;
use crate::model::description::RopeLaw;
use crate::model::hook::Sampled;
use crate::model::{Machine, Scratch};
use crate::observe::Gradient;
use crate::run::RunSettings;
use crate::system::State;
use std::f64::consts::LN_10;

/// Sample of the recorded revolution, as needed for the columns.
pub(super) struct Sample<'s> {
    pub(super) state: &'s State,
    /// States at both ends of the step that contains the sample.
    pub(super) ends: [&'s State; 2],
    /// Gauge readings at the sample \[Pa\].
    pub(super) own: [f64; 4],
    /// Suspension height \[m\] and net crank torque [N m] at the sample.
    pub(super) shaft: [f64; 2],
    /// Quantities available to additional reading hooks, if the machine has none of its own.
    pub(super) known: Option<Sampled>,
    /// Run settings and index of the sample.
    pub(super) turned: (&'s RunSettings, usize),
}

/// Returns the derivative of the front head's radius with respect to a parameter, by differences.
fn raised(own: &Machine, beside: &[Machine; 2], difference: &Difference) -> f64 {
    let radius = |machine: &Machine| machine.description.front_arc.radius;
    let each = beside.iter().zip(difference.weights);
    let change = each.map(|(beside, weight)| weight * radius(beside));
    difference.own * radius(own) + change.sum::<f64>()
}

/// Chooses how the derivative of the forces with respect to the decimal logarithm of a coefficient is
/// computed.
fn by_coefficient<'a>(
    (machine, law): (&'a Machine, &RopeLaw),
    settings: &RunSettings,
    coefficient: Coefficient,
) -> Source<'a> {
    let factor = LN_10 * *coefficient.of(&mut law.clone());
    match coefficient {
        // laws along a rope ask for its stiffness, and remember
        _ if machine.hooks.has_axial() => Source::Difference(ROPES, false, None),
        Coefficient::Kc => Source::Contact {
            by: By::Stiffness,
            factor: LN_10 * machine.ropes(law).contact.stiffness,
        },
        Coefficient::Cc => Source::Contact {
            by: By::Damping,
            factor: LN_10 * machine.ropes(law).contact.damping,
        },
        Coefficient::Kb1
        | Coefficient::Kb23
        | Coefficient::Kb4
        | Coefficient::Kb56
        | Coefficient::Cb1
        | Coefficient::Cb23
        | Coefficient::Cb4
        | Coefficient::Cb56 => {
            let ropes = machine.ropes(&coefficient.unit(law));
            let unit = Side::new(machine, ropes, settings.drive(machine));
            let coefficients = unit.inner().plane_coefficients();
            let which = coefficients.iter().position(|x| *x != 0.0);
            Source::Joints(Box::new(Joints {
                unit,
                factor,
                inner: which.map(|k| (k, coefficients[k])),
            }))
        }
    }
}

/// Column whose derivatives must be computed.
pub(super) struct Active<'a> {
    /// Index of the column in the plan.
    pub(super) column: usize,
    pub(super) source: Source<'a>,
    /// Machines with perturbed parameters, from which differences are taken; two or none.
    pub(super) sides: Vec<Side<'a>>,
    pub(super) difference: Difference,
    /// Whether the gauge readings depend on the parameter explicitly, at a fixed state.
    explicit: bool,
    pub(super) curves: Changes,
}

impl<'a> Active<'a> {
    /// Prepares a column; returns `None` if its derivatives are known to be zero or unavailable.
    pub(super) fn new(
        (machine, law): (&'a Machine, &RopeLaw),
        settings: &RunSettings,
        (column, way): (usize, &'a Way),
    ) -> Option<Self> {
        let side = |machine: &'a Machine, law: &RopeLaw| {
            Side::new(machine, machine.ropes(law), settings.drive(machine))
        };
        let curves = Changes::default();
        match way {
            Way::Coefficient(coefficient) => {
                let difference = Difference::decades(machine.hooks.has_axial());
                let moved = |step| side(machine, &coefficient.moved(law, step));
                let source = by_coefficient((machine, law), settings, *coefficient);
                Some(Self {
                    column,
                    source,
                    sides: difference.steps.map(moved).to_vec(),
                    difference,
                    explicit: true,
                    curves,
                })
            }
            Way::Beside {
                machines,
                difference,
                differing,
            } => {
                let raised = differing
                    .raised
                    .then(|| raised(machine, machines, difference));
                let source = differing.terms.map_or(Source::Nothing, |(terms, inertia)| {
                    Source::Difference(terms, inertia, raised)
                });
                let mut all = machines.iter().chain([machine]);
                let read = all.any(|machine| machine.hooks.has_readings());
                let asked = machines.iter().zip(difference.weights);
                let asked = asked.filter(|(_, weight)| *weight != 0.0);
                let sides = asked.map(|(machine, _)| side(machine, law));
                Some(Self {
                    column,
                    source,
                    sides: sides.collect(),
                    difference: *difference,
                    explicit: differing.stress || read,
                    curves,
                })
            }
            Way::Pieces(hooks) => Some(Self {
                column,
                source: Source::Pieces(hooks),
                sides: Vec::new(),
                difference: Difference::decades(false),
                explicit: false,
                curves,
            }),
            Way::Nothing | Way::Missing(_) => None,
        }
    }

    /// Returns the explicit derivative of the gauge readings at a sample, at a fixed state.
    pub(super) fn explicit(
        &mut self,
        sample: &Sample<'_>,
        gradient: Option<&Gradient>,
        (scratch, force, beside): (&mut Scratch, &mut [f64], &mut State),
    ) -> [f64; 4] {
        let mut sum = [0.0; 4];
        let mut add = |share: f64, readings: &[f64; 4]| {
            for (sum, reading) in sum.iter_mut().zip(readings) {
                *sum += share * reading;
            }
        };
        let Difference { weights, own, .. } = self.difference;
        match (&mut self.source, gradient, &sample.known) {
            (Source::Joints(joints), Some(gradient), _) => {
                let pull = joints.unit.anchor_pull(scratch, sample.state);
                for (by, pull) in gradient.by_pull.iter().zip(pull) {
                    add(joints.factor * pull, by);
                }
            }
            (Source::Contact { by, factor }, Some(gradient), _) => {
                let by_damping = usize::from(*by == By::Damping);
                add(*factor, &gradient.by_contact[by_damping]);
            }
            (Source::Nothing, _, Some(known)) => {
                add(own, &sample.own);
                for (side, share) in self.sides.iter().zip(weights) {
                    let mut read = sample.own;
                    side.machine.hooks.read(known, &mut read);
                    add(share, &read);
                }
            }
            _ if self.explicit => {
                add(own, &sample.own);
                for (side, share) in self.sides.iter_mut().zip(weights) {
                    let (settings, index) = sample.turned;
                    let t = settings.sampled(side.machine, &side.drive, index);
                    let [from, to] = sample.ends;
                    interpolate(from, to, t, beside);
                    add(share, &side.readings(scratch, beside, force));
                }
            }
            _ => {}
        }
        sum
    }

    /// Returns the explicit derivative of suspension height and crank torque at a sample, at a fixed state.
    pub(super) fn explicit_shaft(
        &mut self,
        sample: &Sample<'_>,
        (scratch, beside): (&mut Scratch, &mut State),
    ) -> [f64; 2] {
        let Difference { weights, own, .. } = self.difference;
        let mut sum = [0.0; 2];
        match &mut self.source {
            Source::Joints(joints) => {
                sum[1] = joints.factor * joints.unit.turned_by_ropes(scratch, sample.state);
            }
            Source::Difference(..) => {
                let mut add = |share: f64, read: [f64; 2]| {
                    for (sum, read) in sum.iter_mut().zip(read) {
                        *sum += share * read;
                    }
                };
                add(own, sample.shaft);
                for (side, share) in self.sides.iter_mut().zip(weights) {
                    let (settings, index) = sample.turned;
                    let t = settings.sampled(side.machine, &side.drive, index);
                    if t.to_bits() == sample.state.t.to_bits() {
                        add(share, side.shaft(scratch, sample.state));
                    } else {
                        let [from, to] = sample.ends;
                        interpolate(from, to, t, beside);
                        add(share, side.shaft(scratch, beside));
                    }
                }
            }
            Source::Contact { .. } | Source::Pieces(_) | Source::Nothing => {}
        }
        sum
    }

    /// Returns the rank of the column in the order of computation. Contact columns and those with a changed
    /// front radius come first, because they need the machine's own contact points, which evaluations of
    /// other machines overwrite; columns that do not move the state come last and are not in the blocks.
    pub(super) const fn order(&self) -> u8 {
        match self.source {
            Source::Contact { .. } | Source::Difference(.., Some(_)) => 0,
            Source::Joints(_) | Source::Pieces(_) | Source::Difference(..) => 1,
            Source::Nothing => 2,
        }
    }

    pub(super) const fn moves(&self) -> bool {
        !matches!(self.source, Source::Nothing)
    }
}
