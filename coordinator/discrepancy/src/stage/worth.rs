//! What more data would be worth: effects that this record cannot tell apart, how many more cycles of
//! it would, and whether a record of another condition would.
//!
//! Each effect is taken at a few times the size from which it is seen at all: below that nothing tells
//! anything apart. Linear in the effects, at the recalibrated point; it knows no verdict.
use crate::bench::{Bench, Fit};
use crate::estimate::Limit;
use crate::evidence::misfit;
use crate::isolability::pairs;
use crate::laboratory::{Laboratory, Stage};
use crate::metric::Metric;
use crate::model::{Model, sizes};
use crate::noise::Noise;
use crate::record::Record;
use crate::rounds::Round;
use crate::stage::establish::Base;
use crate::stage::suspect::Suspect;
use crate::tangent::Tangent;
use nalgebra::{DMatrix, DVector};
use search::least_squares::Linearized;

/// Two effects that the record would not part, and what would.
#[derive(Clone, Debug, PartialEq)]
pub struct LookAlikes {
    /// Their identifiers.
    pub effects: [String; 2],
    /// How many times as many cycles of the same condition would part them, at least 1.
    pub cycles: f64,
    /// The same where the records of the other conditions are fitted too, if there are any: at most
    /// 1 if they part the two without a further cycle.
    pub cycles_with_others: Option<f64>,
}

/// At how many times their detection limits effects are compared.
const MULTIPLE: f64 = 3.0;

/// Weighs all pairs of suspects of a round at `fit`.
///
/// # Errors
/// Of the laboratory.
pub(crate) async fn weigh<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    fit: &Fit,
    (round, limits): (&Round, &[Limit]),
    others: impl Iterator<Item = &Record>,
) -> Result<Vec<LookAlikes>, L::Error> {
    let phi = misfit(fit.chi_squared(), base.bench.metric.len());
    let visible: Vec<(&Suspect, Vec<f64>)> = round
        .suspects
        .iter()
        .filter_map(|suspect| Some((suspect, amounts(suspect, limits)?)))
        .collect();
    let here: Vec<DMatrix<f64>> = visible
        .iter()
        .map(|(suspect, amounts)| scaled(&suspect.signature, amounts))
        .collect();
    let at = fit.search.best();
    let tangent = Tangent::new(at, fit.variables());
    let mut alike = pairs(&here, &tangent, phi);
    alike.retain(|pair| pair.apart < 1.0);
    alike.sort_by(|a, b| a.apart.total_cmp(&b.apart));
    if alike.is_empty() {
        return Ok(Vec::new());
    }
    let (mut jacobian, mut signatures) = (at.jacobian.clone(), here);
    let mut joined = false;
    for record in others.filter(|record| !record.cycles.is_empty()) {
        let bench = beside(&base.bench, record);
        let Some(seen) = look(lab, &bench, fit, &visible).await? else {
            continue;
        };
        joined = true;
        jacobian = stacked(&jacobian, &seen.jacobian);
        signatures = signatures
            .iter()
            .zip(&seen.signatures)
            .map(|(above, below)| stacked(above, below))
            .collect();
    }
    let together = joined.then(|| {
        let both = Linearized {
            x: at.x.clone(),
            residual: DVector::zeros(jacobian.nrows()),
            jacobian,
        };
        pairs(&signatures, &Tangent::new(&both, fit.variables()), phi)
    });
    let name = |k: usize| visible[k].0.effect.id.clone();
    Ok(alike
        .into_iter()
        .map(|pair| LookAlikes {
            effects: pair.members.map(name),
            cycles: 1.0 / pair.apart,
            cycles_with_others: together.as_ref().and_then(|all| {
                let same = all.iter().find(|other| other.members == pair.members)?;
                Some(1.0 / same.apart)
            }),
        })
        .collect())
}

/// How much of each size is compared, in scales; nothing for an effect that cannot be seen.
fn amounts(suspect: &Suspect, limits: &[Limit]) -> Option<Vec<f64>> {
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

/// Columns times amounts.
fn scaled(signature: &DMatrix<f64>, amounts: &[f64]) -> DMatrix<f64> {
    let mut signature = signature.clone();
    for (mut column, amount) in signature.column_iter_mut().zip(amounts) {
        column *= *amount;
    }
    signature
}

/// One matrix on top of another of as many columns.
fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = above.nrows() + below.nrows();
    DMatrix::from_fn(rows, above.ncols(), |i, j| {
        if i < above.nrows() {
            above[(i, j)]
        } else {
            below[(i - above.nrows(), j)]
        }
    })
}

/// Another record under a metric of its own noise.
fn beside(bench: &Bench, record: &Record) -> Bench {
    let orders = bench.metric.orders().clone();
    let noise = Noise::estimate(record, &orders, &[]);
    let metric = Metric::new(orders, record.channels.len(), &noise.covariances);
    Bench::new(record.clone(), metric, bench.refinement)
}

/// The linearised model under another condition.
struct Seen {
    jacobian: DMatrix<f64>,
    signatures: Vec<DMatrix<f64>>,
}

/// Differences of the genes and of all visible effects under a bench's condition; nothing if one of
/// its simulations failed.
async fn look<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    visible: &[(&Suspect, Vec<f64>)],
) -> Result<Option<Seen>, L::Error> {
    let x = fit.x();
    let mut points: Vec<(Model, Vec<f64>)> = vec![(fit.model.clone(), x.to_vec())];
    let mut steps: Vec<f64> = Vec::new();
    for (k, variable) in fit.variables().iter().enumerate() {
        let inwards = x[k] + variable.step <= variable.upper;
        let step = if inwards {
            variable.step
        } else {
            -variable.step
        };
        let mut moved = x.to_vec();
        moved[k] += step;
        steps.push(step);
        points.push((fit.model.clone(), moved));
    }
    for (suspect, _) in visible {
        for own in &suspect.taken {
            let moved = x.iter().chain(own).copied().collect();
            points.push((fit.model.with(&suspect.effect), moved));
        }
    }
    let points: Vec<(&Model, &[f64])> = points.iter().map(|(m, x)| (m, x.as_slice())).collect();
    let curves = bench.curves(lab, Stage::What, &points).await?;
    let whitened = curves
        .iter()
        .map(|c| Some(bench.metric.whiten(c.as_ref()?)));
    let Some(whitened) = whitened.collect::<Option<Vec<DVector<f64>>>>() else {
        return Ok(None);
    };
    let mut rest = whitened.iter().skip(1);
    let base = &whitened[0];
    // residuals are measured less simulated
    let columns: Vec<DVector<f64>> = steps
        .iter()
        .zip(rest.by_ref())
        .map(|(step, moved)| (base - moved) / *step)
        .collect();
    let signatures = visible
        .iter()
        .map(|(suspect, amounts)| {
            let own = sizes(&suspect.effect).into_iter().zip(&suspect.taken);
            let columns: Vec<DVector<f64>> = own
                .zip(rest.by_ref())
                .map(|((size, taken), moved)| (moved - base) / taken[size])
                .collect();
            scaled(&DMatrix::from_columns(&columns), amounts)
        })
        .collect();
    Ok(Some(Seen {
        jacobian: DMatrix::from_columns(&columns),
        signatures,
    }))
}
