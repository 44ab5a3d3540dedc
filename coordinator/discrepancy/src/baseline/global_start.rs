//! Global search for the narrow minimum in which resonances fit.
//!
//! The residual of a system that is slightly too soft or too stiff is a wave of the wrong phase, and a local
//! search cannot leave the plateau around the minimum. A global search strategy therefore runs first, on the
//! same whitened residual.
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::unknowns::{FittedModel, Point};
use search::space::Axis;
use search::strategy::{EvaluationResult, Residual, SearchPlan, build, preset};

/// Settings of a global search: the name of its preset, and its random seed.
pub(crate) type Search = (&'static str, u64);

/// Returns starts for the fit: the best points of a global search, best first, that differ clearly in at
/// least one unknown. The unknowns are searched; `rest` holds the nuisance parameters and the parameters of
/// the model's effects, which are fixed.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub(crate) async fn global_starts<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    model: &FittedModel,
    rest: &[f64],
    (name, seed): Search,
) -> Result<Vec<Point>, L::Error> {
    let whole = |genes: Vec<f64>| Point {
        model: model.clone(),
        x: [&genes[..], rest].concat(),
    };
    let plan = SearchPlan {
        space: &model.space,
        workers: 1,
    };
    let search = preset(name).map(|preset| (preset.settings)(&plan));
    let Some(Ok(mut strategy)) = search.map(|search| build(&search, plan.space, seed)) else {
        return Ok(vec![whole(vec![0.0; model.space.dimension()])]);
    };
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    while strategy.finished().is_none() {
        let proposals = strategy.ask();
        if proposals.is_empty() {
            break;
        }
        let points = proposals
            .iter()
            .map(|proposal| whole(model.space.point(&proposal.genes)));
        let wanted = proposals
            .iter()
            .map(|proposal| proposal.purpose.wants_derivatives());
        let points: Vec<(Point, bool)> = points.zip(wanted).collect();
        let residuals = experiments.residuals(&points).await?;
        for ((proposal, (point, _)), residual) in proposals.iter().zip(points).zip(residuals) {
            let length = |residual: &Residual| residual.values.iter().map(|r| r * r).sum();
            let fitness: Option<f64> = residual.as_ref().map(length);
            found.extend(fitness.map(|fitness| (fitness, point.x)));
            if let Some(residual) = residual.filter(|_| proposal.purpose.wants_residual()) {
                strategy.tell_residual(proposal.id, residual);
            }
            let told = EvaluationResult {
                fitness: fitness.unwrap_or(f64::MAX),
                complete: fitness.is_some(),
            };
            strategy.tell(proposal.id, told);
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = select_distinct(model.space.axes(), found.into_iter().map(|(_, x)| x)).into_iter();
    let point = |x| Point {
        model: model.clone(),
        x,
    };
    Ok(best.map(point).collect())
}

/// Selects the best points, no two of which are close to each other in every unknown.
fn select_distinct(axes: &[Axis], ranked: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
    const STARTS: usize = 3;
    /// Distance below which two points count as close, for an unknown with a narrow minimum (scaled
    /// coordinates).
    const NEAR_IN_VALLEY: f64 = 0.03;
    const NEAR: f64 = 0.15;
    let in_valley = |k: usize| {
        axes.get(k)
            .is_some_and(|axis| axis.unknown.valley.is_some())
    };
    let limit = |k| if in_valley(k) { NEAR_IN_VALLEY } else { NEAR };
    let mut kept: Vec<Vec<f64>> = Vec::new();
    for x in ranked {
        let near = |other: &Vec<f64>| {
            let mut pairs = other.iter().zip(&x).enumerate();
            pairs.all(|(k, (a, b))| (a - b).abs() < limit(k))
        };
        if !kept.iter().any(near) {
            kept.push(x);
        }
        if kept.len() == STARTS {
            break;
        }
    }
    kept
}
