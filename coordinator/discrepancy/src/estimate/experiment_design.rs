//! Value of more data: effects that this record cannot tell apart, how many more cycles of it would separate
//! them, and whether a record of another condition would.
//!
//! Each effect is taken at a few times its detection limit: below that nothing can be told apart. The
//! analysis is linear in the effects, at the recalibrated point, and independent of the verdict.
use crate::baseline::session::Session;
use crate::estimate::limit::Limit;
use crate::hypothesis::candidate::WorkingCandidate;
use crate::hypothesis::round::WorkingRound;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::isolability::pairs;
use crate::linear::stack::stacked;
use crate::linear::tangent::Tangent;
use crate::linear::whitened::WhitenedRecord;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::sizes;
use nalgebra::{DMatrix, DVector};
use search::least_squares::Linearized;
use serde::{Deserialize, Serialize};

/// Pair of effects that the record cannot separate, with the data that would.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IndistinguishablePair {
    /// Identifiers of the two effects.
    pub effects: [String; 2],
    /// Factor, at least 1, by which the number of cycles of the same condition would have to grow to separate
    /// the two effects.
    pub cycles: f64,
    /// Factor for the number of cycles when the records of the other conditions, if there are any, are fitted
    /// too: at most 1 if these separate the effects without a further cycle.
    #[serde(rename = "cycles_with_other_conditions")]
    pub cycles_with_others: Option<f64>,
}

/// Multiple of the detection limits at which effects are compared.
const MULTIPLE: f64 = 3.0;

/// Candidate effect that the record can detect, with the amount of each of its sizes at which it is compared,
/// as a multiple of the parameter's scale.
struct Visible<'a> {
    suspect: &'a WorkingCandidate,
    amounts: Vec<f64>,
}

/// Finds the pairs of a round's candidate effects that cannot be separated at `fit`, and the data that would
/// separate them.
pub(crate) async fn weigh<L: Laboratory>(
    session: &mut Session<'_, L>,
    fit: &Fit,
    round: &WorkingRound,
    limits: &[Limit],
) -> Result<Vec<IndistinguishablePair>, L::Error> {
    let (base, others) = (&session.base.record, session.inputs.others());
    let highest = session.inputs.thresholds.orders;
    let visible = round.candidates.iter();
    let visible: Vec<Visible<'_>> = visible
        .filter_map(|suspect| {
            let amounts = amounts(suspect, limits)?;
            Some(Visible { suspect, amounts })
        })
        .collect();
    let own = |one: &Visible<'_>| scaled(&one.suspect.signature, &one.amounts);
    let here: Vec<DMatrix<f64>> = visible.iter().map(own).collect();
    let at = fit.search.best();
    let mut alike = pairs(&here, &fit.tangent(), fit.misfit());
    alike.retain(|pair| pair.relative_distance < 1.0);
    alike.sort_by(|a, b| a.relative_distance.total_cmp(&b.relative_distance));
    if alike.is_empty() {
        return Ok(Vec::new());
    }
    let (mut jacobian, mut signatures) = (at.jacobian.clone(), here);
    let mut joined = false;
    for record in others.filter(|record| !record.cycles.is_empty()) {
        let other = WhitenedRecord::under_own_noise(record.clone(), highest, base.numerics.clone());
        let mut experiments = session.experiments(Stage::Test);
        let Some(seen) = linearized(&mut experiments.for_record(&other), fit, &visible).await?
        else {
            continue;
        };
        joined = true;
        jacobian = stacked(&jacobian, &seen.jacobian);
        for (above, below) in signatures.iter_mut().zip(&seen.signatures) {
            *above = stacked(above, below);
        }
    }
    let together = joined.then(|| {
        let both = Linearized {
            x: at.x.clone(),
            residual: DVector::zeros(jacobian.nrows()),
            jacobian,
        };
        pairs(
            &signatures,
            &Tangent::new(&both, fit.variables()),
            fit.misfit(),
        )
    });
    let name = |k: usize| visible[k].suspect.effect.id.clone();
    Ok(alike
        .into_iter()
        .map(|pair| IndistinguishablePair {
            effects: pair.members.map(name),
            cycles: 1.0 / pair.relative_distance,
            cycles_with_others: together.as_ref().and_then(|all| {
                let same = all.iter().find(|other| other.members == pair.members)?;
                Some(1.0 / same.relative_distance)
            }),
        })
        .collect())
}

/// Returns the amount of each size at which an effect is compared, as a multiple of the parameter's scale;
/// `None` for an effect that cannot be detected.
fn amounts(suspect: &WorkingCandidate, limits: &[Limit]) -> Option<Vec<f64>> {
    let each = sizes(&suspect.effect).into_iter().map(|k| {
        let parameter = &suspect.effect.parameters[k];
        let own =
            |limit: &&Limit| limit.id == suspect.effect.id && limit.parameter == parameter.name;
        let amount = MULTIPLE * limits.iter().find(own)?.size / parameter.scale;
        amount.is_finite().then_some(amount)
    });
    let all: Option<Vec<f64>> = each.collect();
    all.filter(|all| !all.is_empty() && all.len() == suspect.signature.ncols())
}

/// Multiplies the columns of a signature by the amounts of the effect's sizes.
fn scaled(signature: &DMatrix<f64>, amounts: &[f64]) -> DMatrix<f64> {
    let mut signature = signature.clone();
    for (mut column, amount) in signature.column_iter_mut().zip(amounts) {
        column *= *amount;
    }
    signature
}

/// Model under another condition, linearised in the unknowns and in the sizes of the effects.
struct LinearizedCurves {
    jacobian: DMatrix<f64>,
    signatures: Vec<DMatrix<f64>>,
}

/// Computes the derivatives by the unknowns and the signatures of all detectable effects on another record;
/// `None` if one of the simulations failed.
async fn linearized<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    visible: &[Visible<'_>],
) -> Result<Option<LinearizedCurves>, L::Error> {
    let on = experiments.on;
    let Some(seen) = experiments.linearized(fit, &on.record).await? else {
        return Ok(None);
    };
    let mut points = Vec::new();
    for Visible { suspect, .. } in visible {
        let taken = suspect.taken.iter();
        points.extend(taken.map(|own| fit.with(&suspect.effect, own)));
    }
    let curves = experiments.curves(&points).await?;
    let whiten = |curves: Option<_>| Some(on.metric.whiten(&curves?));
    // residuals are measured less simulated
    let columns = seen
        .changes
        .into_iter()
        .map(|change| Some(-whiten(change)?));
    let (Some(columns), Some(whitened)) = (
        columns.collect::<Option<Vec<DVector<f64>>>>(),
        curves.into_iter().map(whiten).collect::<Option<Vec<_>>>(),
    ) else {
        return Ok(None);
    };
    let base = &on.metric.whiten(&seen.curves);
    let mut rest = whitened.iter();
    let mut signatures = Vec::new();
    for Visible { suspect, amounts } in visible {
        let own = sizes(&suspect.effect)
            .into_iter()
            .zip(&suspect.taken)
            .zip(rest.by_ref());
        let columns = own.map(|((size, taken), moved)| (moved - base) / taken[size]);
        let columns: Vec<DVector<f64>> = columns.collect();
        signatures.push(scaled(&DMatrix::from_columns(&columns), amounts));
    }
    Ok(Some(LinearizedCurves {
        jacobian: DMatrix::from_columns(&columns),
        signatures,
    }))
}
