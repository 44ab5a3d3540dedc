//! Signatures and score tests of the effects of the library at a fitted point.
//!
//! If the laboratory computes derivatives, signatures are derivatives at the fitted point, for all shapes in
//! one batch. One finite difference per size checks whether the effect is linear up to the size that the
//! record suggests. All other signatures are finite differences at the effect's typical size, repeated with
//! another size where the change of the curves is too large to be linear or too small to be detected. Effects
//! whose law has a shape parameter (an angle, a width, a ratio) are tested at several of its values, and the
//! p-value accounts for the number of tries. An effect with a threshold (a clearance, an overflow) does
//! nothing at one size and much at another; a non-linear effect is therefore tested on a ladder of sizes over
//! its whole range. Each rung counts as a try and is a possible start of a refit.
use crate::hypothesis::candidate::WorkingCandidate;
use crate::laboratory::Laboratory;
use crate::linear::score::{NullModel, Score, score};
use crate::linear::tangent::Tangent;
use crate::model::derivative::candidate_term;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::{absent, bounds, positive, shapes, sized, sizes, typical};
use crate::model::unknowns::Point;
use nalgebra::{DMatrix, DVector};
use protocol::announce::EffectDescriptor;
use std::collections::{BTreeMap, BTreeSet};

/// Signature to be computed: an effect with given shape parameters, and the value of one of its sizes.
#[derive(Clone, Debug)]
struct Probe {
    /// Index of the effect in the list of candidate effects.
    effect: usize,
    /// Scaled parameters of the effect, with all its sizes at their absent value.
    shape: Vec<f64>,
    /// Whether `shape` holds the typical values of the shape parameters.
    typical: bool,
    /// Index of the varied size among the effect's parameters.
    size: usize,
    /// Scaled value of the size at which the signature is computed.
    amount: f64,
    /// Whitened finite difference of the curves per unit of the size; `None` until computed.
    column: Option<DVector<f64>>,
    /// Whitened derivative of the curves with respect to the size, if the simulator provides it.
    exact: Option<DVector<f64>>,
    /// Whether the derivative serves as the signature, so that no finite difference is needed.
    settled: bool,
    /// Whether the probe belongs to a ladder of sizes, so that its size is not adjusted.
    rung: bool,
}

impl Probe {
    /// Returns the scaled parameters of the effect at which the probe is simulated, with its size set.
    fn parameters(&self) -> Vec<f64> {
        let mut own = self.shape.clone();
        own[self.size] = self.amount;
        own
    }
}

/// Magnitude, in standard deviations of the noise, that a probe's projected change of the curves shall have;
/// the size is chosen accordingly.
const WANTED: f64 = 4.0;
/// Acceptable range of the projected change of the curves, in standard deviations; probes outside are
/// simulated again with another size.
const USABLE: [f64; 2] = [1.0, 20.0];
/// Minimum cosine between derivative and finite difference for an effect to count as linear in its size.
const LINEAR: f64 = 0.98;
/// Number of values at which each shape parameter of an effect is tested.
const SHAPES: usize = 6;
/// Sizes of the ladder on which non-linear effects are tested, as shares of the range from the absent value
/// to the bound.
const RUNGS: [f64; 7] = [1.0, 0.75, 0.5, 0.25, 0.12, 0.06, 0.03];
/// Maximum relative difference between the changes per unit at full and at half size for an effect to count
/// as linear.
const PROPORTIONAL: f64 = 0.3;

/// Computes the signatures of effects and tests them on the residual of a fit.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn examine<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    effects: &[EffectDescriptor],
) -> Result<Vec<WorkingCandidate>, L::Error> {
    let null = fit.null_model();
    let tangent = &null.tangent;
    let mut probes = plan(effects);
    differentiate(experiments, fit, effects, &mut probes).await?;
    suggest(effects, &mut probes, tangent);
    // what a size does in the effect's typical shape tells how much of it to take in the others
    take(experiments, fit, effects, &mut probes, |probe| {
        probe.typical
    })
    .await?;
    settle(&mut probes, tangent);
    adjust(effects, &mut probes, tangent);
    spread(&mut probes);
    take(experiments, fit, effects, &mut probes, |_| true).await?;
    adjust(effects, &mut probes, tangent);
    take(experiments, fit, effects, &mut probes, |_| true).await?;
    climb(experiments, fit, effects, &mut probes).await?;
    let judged = effects.iter().enumerate();
    Ok(judged
        .map(|(k, effect)| judge(k, effect, &probes, &null))
        .collect())
}

/// Creates one probe per size and shape; shape parameters are varied one at a time.
fn plan(effects: &[EffectDescriptor]) -> Vec<Probe> {
    let mut probes = Vec::new();
    for (k, effect) in effects.iter().enumerate() {
        for (choice, shape) in shape_choices(effect).into_iter().enumerate() {
            for size in sizes(effect) {
                probes.push(Probe {
                    effect: k,
                    shape: shape.clone(),
                    typical: choice == 0,
                    size,
                    amount: typical(&effect.parameters[size]),
                    column: None,
                    exact: None,
                    settled: false,
                    rung: false,
                });
            }
        }
    }
    probes
}

/// Returns the scaled parameter vectors at which an effect is tested, with all sizes absent: the typical
/// shape, then each shape parameter varied over its range.
fn shape_choices(effect: &EffectDescriptor) -> Vec<Vec<f64>> {
    let usual = absent(effect);
    let mut choices = vec![usual.clone()];
    for k in shapes(effect) {
        let [lower, upper] = bounds(&effect.parameters[k]);
        for i in 0..SHAPES {
            let mut one = usual.clone();
            one[k] = lower + (upper - lower) * (i as f64 + 0.5) / SHAPES as f64;
            choices.push(one);
        }
    }
    choices
}

/// Requests the derivatives of all probes, as far as the simulator provides them. Generic forces are linear
/// in their size, so that their derivative is the final signature.
async fn differentiate<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    effects: &[EffectDescriptor],
    probes: &mut [Probe],
) -> Result<(), L::Error> {
    let point = fit.point();
    let term = |probe: &Probe| {
        let effect = &effects[probe.effect];
        candidate_term(&point, effect, &probe.shape, probe.size)
    };
    let terms = probes.iter().map(term).collect();
    let changes = experiments.changes(fit, terms).await?;
    let metric = &experiments.on.metric;
    for (probe, change) in probes.iter_mut().zip(changes) {
        let exact = change.map(|change| metric.whiten(&change));
        // what does nothing at first may do something later
        probe.exact = exact.filter(|exact| exact.norm_squared() > 0.0);
        if effects[probe.effect].generic && probe.exact.is_some() {
            probe.settled = true;
            probe.column.clone_from(&probe.exact);
        }
    }
    Ok(())
}

/// Sets the size of each probe so that, to first order, the projected change of the curves has the target
/// magnitude.
fn suggest(effects: &[EffectDescriptor], probes: &mut [Probe], tangent: &Tangent) {
    for probe in probes {
        let Some(exact) = &probe.exact else { continue };
        let change = tangent.project(exact).norm();
        let [lower, upper] = bounds(&effects[probe.effect].parameters[probe.size]);
        let amount = (probe.amount.signum() * WANTED / change).clamp(lower, upper);
        if amount.is_finite() && amount != 0.0 {
            probe.amount = amount;
        }
    }
}

/// Adopts the derivatives as signatures for all shapes of a size whose finite difference at the typical shape
/// is parallel to its derivative.
fn settle(probes: &mut [Probe], tangent: &Tangent) {
    let linear = |probe: &Probe| {
        let (Some(exact), Some(column)) = (&probe.exact, &probe.column) else {
            return false;
        };
        let (x, y) = (tangent.project(exact), tangent.project(column));
        x.dot(&y) >= LINEAR * x.norm() * y.norm()
    };
    let typical = probes.iter().filter(|probe| probe.typical && linear(probe));
    let linear: BTreeSet<(usize, usize)> =
        typical.map(|probe| (probe.effect, probe.size)).collect();
    for probe in probes {
        if linear.contains(&(probe.effect, probe.size)) && probe.exact.is_some() {
            probe.settled = true;
            probe.column.clone_from(&probe.exact);
        }
    }
}

/// Copies the size chosen for the typical shape of an effect to the probes of all its other shapes.
fn spread(probes: &mut [Probe]) {
    let typical = probes.iter().filter(|probe| probe.typical);
    let amounts: BTreeMap<(usize, usize), f64> = typical
        .map(|probe| ((probe.effect, probe.size), probe.amount))
        .collect();
    for probe in probes
        .iter_mut()
        .filter(|probe| !probe.typical && !probe.settled)
    {
        if let Some(amount) = amounts.get(&(probe.effect, probe.size)) {
            probe.amount = *amount;
        }
    }
}

/// Simulates the selected probes that have no finite difference yet, and stores it.
async fn take<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    effects: &[EffectDescriptor],
    probes: &mut [Probe],
    asked: impl Fn(&Probe) -> bool,
) -> Result<(), L::Error> {
    let open = |probe: &&mut Probe| probe.column.is_none() && asked(probe);
    let open: Vec<&mut Probe> = probes.iter_mut().filter(open).collect();
    let point = |probe: &&mut Probe| fit.with(&effects[probe.effect], &probe.parameters());
    let points: Vec<Point> = open.iter().map(point).collect();
    let curves = experiments.curves(&points).await?;
    let metric = &experiments.on.metric;
    let base = metric.whiten(&fit.curves);
    for (probe, curves) in open.into_iter().zip(curves) {
        if let Some(curves) = curves {
            probe.column = Some((metric.whiten(&curves) - &base) / probe.amount);
        }
    }
    Ok(())
}

/// Tests non-linear effects on ladders of sizes; all sizes of an effect are set to the same share of their
/// ranges.
async fn climb<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    effects: &[EffectDescriptor],
    probes: &mut Vec<Probe>,
) -> Result<(), L::Error> {
    let open = |probe: &&Probe| {
        let named = !effects[probe.effect].generic;
        probe.typical && !probe.settled && named
    };
    let doubtful: Vec<Probe> = probes.iter().filter(open).cloned().collect();
    // half the size would do half as much if it were linear
    let halves = doubtful.iter().map(|probe| Probe {
        amount: 0.5 * probe.amount,
        column: None,
        ..probe.clone()
    });
    let mut halves: Vec<Probe> = halves.collect();
    take(experiments, fit, effects, &mut halves, |_| true).await?;
    let proportional = |(probe, half): (&Probe, &Probe)| match (&probe.column, &half.column) {
        (Some(whole), Some(half)) => (whole - half).norm() < PROPORTIONAL * whole.norm(),
        _ => false,
    };
    let pairs = doubtful.iter().zip(&halves);
    let bent = pairs.filter(|pair| !proportional(*pair));
    let bent: BTreeSet<usize> = bent.map(|(probe, _)| probe.effect).collect();
    let mut rungs = Vec::new();
    for k in bent {
        let own: Vec<&Probe> = probes
            .iter()
            .filter(|p| p.effect == k && p.typical)
            .collect();
        for (side, rung) in sides(&effects[k]).flat_map(|side| RUNGS.map(|rung| (side, rung))) {
            rungs.extend(own.iter().map(|probe| {
                let range = bounds(&effects[k].parameters[probe.size]);
                // a size that has one side only stays on it
                let end = if range[side] == 0.0 {
                    range[1 - side]
                } else {
                    range[side]
                };
                Probe {
                    amount: end * rung,
                    column: None,
                    typical: false,
                    rung: true,
                    ..(*probe).clone()
                }
            }));
        }
    }
    take(experiments, fit, effects, &mut rungs, |_| true).await?;
    probes.extend(rungs);
    Ok(())
}

/// Returns the sides on which an effect's ladders stand: indices of the lower (0) or upper (1) bound of a
/// size, both where some size may lie on either side of its absent value.
fn sides(effect: &EffectDescriptor) -> std::ops::RangeInclusive<usize> {
    let ranges: Vec<[f64; 2]> = sizes(effect)
        .into_iter()
        .map(|k| bounds(&effect.parameters[k]))
        .collect();
    if ranges
        .iter()
        .any(|[lower, upper]| *lower < 0.0 && *upper > 0.0)
    {
        0..=1
    } else {
        1..=1
    }
}

/// Chooses another size for probes whose change of the curves was too large or too small, or whose simulation
/// failed.
fn adjust(effects: &[EffectDescriptor], probes: &mut [Probe], tangent: &Tangent) {
    for probe in probes.iter_mut().filter(|probe| !probe.settled) {
        let parameter = &effects[probe.effect].parameters[probe.size];
        let [lower, upper] = bounds(parameter);
        let amount = match &probe.column {
            None => 0.25 * probe.amount,
            Some(column) => {
                let change = tangent.project(column).norm() * probe.amount.abs();
                if change.is_nan() || change <= 0.0 || (USABLE[0]..=USABLE[1]).contains(&change) {
                    continue;
                }
                probe.amount * (WANTED / change).clamp(1e-2, 10.0)
            }
        };
        let amount = amount.clamp(lower, upper);
        if amount != 0.0 && (amount / probe.amount - 1.0).abs() > 0.05 {
            probe.amount = amount;
            probe.column = None;
        }
    }
}

/// Computes the score test of one effect: the best result over its tested shapes and ladder sizes.
fn judge(
    k: usize,
    effect: &EffectDescriptor,
    probes: &[Probe],
    null: &NullModel,
) -> WorkingCandidate {
    let (residual, tangent) = (null.residual(), &null.tangent);
    let positive = positive(effect);
    let own: Vec<&Probe> = probes.iter().filter(|p| p.effect == k).collect();
    let mut best: Option<(Score, &[&Probe], DMatrix<f64>)> = None;
    let mut tries = 0;
    let mut rungs: Vec<(f64, Vec<f64>)> = Vec::new();
    for group in own.chunks(positive.len().max(1)) {
        let columns: Option<Vec<DVector<f64>>> = group.iter().map(|p| p.column.clone()).collect();
        let Some(columns) = columns.filter(|c| !c.is_empty()) else {
            continue;
        };
        let signature = DMatrix::from_columns(&columns);
        let amounts = DVector::from_iterator(group.len(), group.iter().map(|p| p.amount));
        let change = &signature * amounts;
        let rung = group.iter().any(|probe| probe.rung);
        // what does nothing there is no try
        if rung && tangent.project(&change).norm() < USABLE[0] {
            continue;
        }
        tries += 1;
        if rung {
            let mut start = group[0].shape.clone();
            for probe in group {
                start[probe.size] = probe.amount;
            }
            // what recalibration explains of it tells nothing about the size
            rungs.push((tangent.project(&(residual - change)).norm_squared(), start));
        }
        let found = score(null, &signature, &positive);
        let better = best.as_ref().is_none_or(|(other, ..)| {
            found.p_value < other.p_value
                || (found.p_value <= other.p_value && found.statistic > other.statistic)
        });
        if better {
            best = Some((found, group, signature));
        }
    }
    let (score, group, signature) = match best {
        Some((score, group, signature)) => (Some(score), group, signature),
        None => (None, &own[..0], DMatrix::zeros(residual.len(), 0)),
    };
    let shape = group.first().map(|probe| probe.shape.clone());
    let mut start = shape.unwrap_or_else(|| absent(effect));
    if let Some(score) = &score {
        start = sized(effect, start, &mut score.size.iter());
    }
    let linear = rungs.is_empty();
    rungs.sort_by(|a, b| a.0.total_cmp(&b.0));
    WorkingCandidate {
        effect: effect.clone(),
        score,
        start,
        rungs: rungs.into_iter().map(|(_, start)| start).collect(),
        linear,
        signature,
        taken: group.iter().map(|probe| probe.parameters()).collect(),
        tries: tries.max(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::announce::{ParameterDescriptor, Place, Role, Sign};
    use search::least_squares::{Linearized, Variable};

    fn effect(lower: f64) -> EffectDescriptor {
        EffectDescriptor {
            id: "clearance".to_owned(),
            title: String::new(),
            joint: String::new(),
            place: Place::Dynamics,
            generic: false,
            parameters: vec![ParameterDescriptor {
                name: "size".to_owned(),
                unit: "m".to_owned(),
                scale: 1.0,
                typical: 1.0,
                absent: 0.0,
                lower,
                upper: 4.0,
                sign: if lower < 0.0 {
                    Sign::Either
                } else {
                    Sign::Positive
                },
                role: Role::Size,
            }],
        }
    }

    fn vector(values: [f64; 3]) -> DVector<f64> {
        DVector::from_row_slice(&values)
    }

    /// Checks that the size that changes the curves as the record asks is tried first, whatever of its change
    /// recalibration explains: 30 along recalibration and 6 along the effect, where a residual of 6 is left.
    #[test]
    fn a_ladder_ranks_its_sizes_by_what_recalibration_leaves() {
        let free = Variable {
            start: 0.0,
            lower: -9.0,
            upper: 9.0,
            step: 0.1,
            longest: f64::INFINITY,
            prior: None,
        };
        let at = Linearized {
            x: vec![0.0],
            residual: vector([0.0, 6.0, 0.0]),
            jacobian: DMatrix::from_columns(&[vector([1.0, 0.0, 0.0])]),
        };
        let null = NullModel::new(&at, &[free]);
        let rung = |amount: f64, change: [f64; 3]| Probe {
            effect: 0,
            shape: vec![0.0],
            typical: false,
            size: 0,
            amount,
            column: Some(vector(change) / amount),
            exact: None,
            settled: false,
            rung: true,
        };
        let probes = [rung(1.0, [0.0, 2.0, 5.0]), rung(2.0, [30.0, 6.0, 0.0])];
        let judged = judge(0, &effect(0.0), &probes, &null);
        assert_eq!(judged.rungs, [[2.0], [1.0]]);
    }

    #[test]
    fn a_ladder_stands_on_each_side_on_which_the_size_may_lie() {
        assert_eq!(sides(&effect(-4.0)), 0..=1);
        assert_eq!(sides(&effect(0.0)), 1..=1);
    }
}
