//! Columns (derivatives with respect to one unknown each) that must be computed: the terms that drive them,
//! and the explicit derivatives of the gauge readings.
use super::column::{Coefficient, DerivativeCurves};
use super::differences::Difference;
use super::perturbed::PerturbedModel;
use super::plan::ColumnMethod;
use super::source::{Joints, ROPES, Source};
use crate::element::impact::DerivativeVariable;
use crate::element::law::ForceLaw;
use crate::integrator::dense::interpolate;
use crate::model::description::RopeLaw;
use crate::model::extension::SampleState;
use crate::model::layout::Motion;
use crate::model::{ForceBuffers, Machine};
use crate::observe::Gradient;
use crate::run::RunSettings;
use crate::system::State;
use std::f64::consts::LN_10;

/// Sample of the recorded revolution, with all that the computation of derivatives there requires.
pub(super) struct Sample<'s> {
    pub(super) state: &'s State,
    /// States at both ends of the step that contains the sample.
    pub(super) ends: [&'s State; 2],
    /// Readings of the four gauges of the simulated machine at the sample, and the stress before the measuring
    /// chain \[Pa\].
    pub(super) own: [f64; 4],
    pub(super) stress: [f64; 4],
    /// Suspension height \[m\] and net crank torque [N m] at the sample.
    pub(super) shaft: [f64; 2],
    /// Quantities that reading extensions of perturbed machines may use; `None` if no column needs them.
    pub(super) known: Option<SampleState>,
    /// Settings of the run, and index of the sample, from which the sample's time follows.
    pub(super) turned: (&'s RunSettings, usize),
}

/// Returns the derivative of the front head's radius with respect to a parameter, by differences.
fn front_radius_derivative(own: &Machine, beside: &[Machine; 2], difference: &Difference) -> f64 {
    let radius = |machine: &Machine| machine.description.front_arc.radius;
    let each = beside.iter().zip(difference.weights);
    let change = each.map(|(beside, weight)| weight * radius(beside));
    difference.own * radius(own) + change.sum::<f64>()
}

/// Chooses how the derivative of the generalised forces with respect to the decimal logarithm of a
/// coefficient is computed.
fn by_coefficient<'a>(
    (machine, law): (&'a Machine, &RopeLaw),
    settings: &RunSettings,
    coefficient: Coefficient,
) -> Source<'a> {
    let factor = LN_10 * *coefficient.of(&mut law.clone());
    match coefficient {
        // laws along a rope ask for its stiffness; in space they are part of the joints' forces
        coefficient
            if machine.extensions.has_axial()
                && (coefficient == Coefficient::Kb1 || machine.layout.motion == Motion::Space) =>
        {
            Source::Difference(ROPES, false, None)
        }
        Coefficient::Kc => Source::Contact {
            by: DerivativeVariable::Stiffness,
            factor: LN_10 * machine.ropes(law).contact.stiffness,
        },
        Coefficient::Cc => Source::Contact {
            by: DerivativeVariable::Damping,
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
            let unit = PerturbedModel::new(machine, ropes, settings.drive(machine));
            let coefficients = unit.ropes().joint.coefficients();
            let which = coefficients.iter().position(|x| *x != 0.0);
            Source::Joints(Box::new(Joints {
                unit,
                factor,
                inner: which.map(|k| (k, coefficients[k])),
            }))
        }
    }
}

/// Column (derivative of the run with respect to one unknown) that must be computed.
pub(super) struct Active<'a> {
    /// Index of the derivative column in the plan.
    pub(super) column: usize,
    pub(super) source: Source<'a>,
    /// Machines with perturbed parameters (two for a central difference), from which differences are taken;
    /// empty if the column needs none.
    pub(super) perturbed: Vec<PerturbedModel<'a>>,
    pub(super) difference: Difference,
    /// Whether the memory of axial laws is differentiated with the state: in the plane, where the perturbed machines, if
    /// there are any, have as many laws as the simulated one. Otherwise each perturbed machine has a memory of its
    /// own, which follows the perturbed state.
    pub(super) memory_by_state: bool,
    /// Whether the gauge readings depend on the parameter explicitly, at a fixed state.
    explicit: bool,
    pub(super) curves: DerivativeCurves,
}

impl<'a> Active<'a> {
    /// Prepares a column; returns `None` if its derivatives are known to be zero or unavailable.
    pub(super) fn new(
        (machine, law): (&'a Machine, &RopeLaw),
        settings: &RunSettings,
        (column, way): (usize, &'a ColumnMethod),
    ) -> Option<Self> {
        let side = |machine: &'a Machine, law: &RopeLaw| {
            PerturbedModel::new(machine, machine.ropes(law), settings.drive(machine))
        };
        let curves = DerivativeCurves::default();
        let memory_by_state = |beside: &Machine| {
            let [own, beside] = [machine, beside].map(|own| own.extensions.axial_laws());
            machine.layout.motion == Motion::Plane
                && machine.extensions.has_axial()
                && own == beside
        };
        match way {
            ColumnMethod::Coefficient(coefficient) => {
                let difference = Difference::decades(machine.extensions.has_axial());
                let moved = |step| side(machine, &coefficient.moved(law, step));
                let source = by_coefficient((machine, law), settings, *coefficient);
                Some(Self {
                    column,
                    source,
                    perturbed: difference.steps.map(moved).to_vec(),
                    difference,
                    memory_by_state: memory_by_state(machine),
                    explicit: true,
                    curves,
                })
            }
            ColumnMethod::Difference {
                machines,
                difference,
                differing,
            } => {
                let raised = differing
                    .front_radius
                    .then(|| front_radius_derivative(machine, machines, difference));
                let source = differing.terms.map_or(Source::Nothing, |(terms, inertia)| {
                    Source::Difference(terms, inertia, raised)
                });
                let mut all = machines.iter().chain([machine]);
                let read = all.any(|machine| machine.extensions.readings_need_loads());
                let asked = machines.iter().zip(difference.weights);
                let asked = asked.filter(|(_, weight)| *weight != 0.0);
                let sides = asked.map(|(machine, _)| side(machine, law));
                Some(Self {
                    column,
                    source,
                    perturbed: sides.collect(),
                    difference: *difference,
                    memory_by_state: machines.iter().all(memory_by_state),
                    explicit: differing.reading || read,
                    curves,
                })
            }
            ColumnMethod::Pieces(extensions) => Some(Self {
                column,
                source: Source::Pieces(extensions),
                perturbed: Vec::new(),
                difference: Difference::decades(false),
                memory_by_state: memory_by_state(machine),
                explicit: false,
                curves,
            }),
            ColumnMethod::Nothing | ColumnMethod::Missing(_) => None,
        }
    }

    /// Returns the derivatives of the gauge stress before the measuring chain and of the readings at a sample with
    /// respect to the column's parameter, at a fixed state; the second without the part that the first causes.
    pub(super) fn explicit(
        &mut self,
        sample: &Sample<'_>,
        gradient: Option<&Gradient>,
        (scratch, force, beside): (&mut ForceBuffers, &mut [f64], &mut State),
    ) -> [[f64; 4]; 2] {
        let [mut stress, mut sum] = [[0.0; 4]; 2];
        let add = |sum: &mut [f64; 4], share: f64, readings: &[f64; 4]| {
            for (sum, reading) in sum.iter_mut().zip(readings) {
                *sum += share * reading;
            }
        };
        let Difference { weights, own, .. } = self.difference;
        match (&mut self.source, gradient, &sample.known) {
            (Source::Joints(joints), Some(gradient), _) => {
                let pull = joints.unit.anchor_pull(scratch, sample.state);
                for (by, pull) in gradient.by_pull.iter().zip(pull) {
                    add(&mut stress, joints.factor * pull, by);
                }
            }
            (Source::Contact { by, factor }, Some(gradient), _) => {
                let by_damping = usize::from(*by == DerivativeVariable::Damping);
                add(&mut stress, *factor, &gradient.by_contact[by_damping]);
            }
            (Source::Nothing, _, Some(known)) => {
                add(&mut sum, own, &sample.own);
                for (side, share) in self.perturbed.iter().zip(weights) {
                    let mut read = sample.stress;
                    side.machine.extensions.read(known, &mut read);
                    add(&mut sum, share, &read);
                }
            }
            _ if self.explicit => {
                add(&mut sum, own, &sample.own);
                for (side, share) in self.perturbed.iter_mut().zip(weights) {
                    let (settings, index) = sample.turned;
                    let t = settings.sampled(side.machine, &side.drive, index);
                    let [from, to] = sample.ends;
                    interpolate(from, to, t, beside);
                    add(&mut sum, share, &side.readings(scratch, beside, force));
                }
            }
            _ => {}
        }
        [stress, sum]
    }

    /// Returns the derivative of suspension height and crank torque at a sample with respect to the column's
    /// parameter, at a fixed state.
    pub(super) fn explicit_shaft(
        &mut self,
        sample: &Sample<'_>,
        (scratch, beside): (&mut ForceBuffers, &mut State),
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
                for (side, share) in self.perturbed.iter_mut().zip(weights) {
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
    /// other machines overwrite; columns that do not affect the motion come last and are not propagated in
    /// blocks.
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

    /// Returns whether axial laws may depend on the parameter, at a fixed state and memory.
    pub(super) const fn changes_laws(&self) -> bool {
        matches!(self.source, Source::Difference(terms, ..) if terms.pulls || terms.joints)
    }
}
