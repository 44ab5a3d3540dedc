//! A way into the valley in which the machine's resonances fit.
//!
//! The residual of a rope that is a little too soft or too stiff is a wave of the wrong phase, and no
//! local search leaves the plateau around the valley. So a search strategy goes first, on the same
//! whitened residual.
use crate::bench::Bench;
use crate::laboratory::{Laboratory, Stage};
use crate::model::Model;
use search::strategy::{Told, preset};

/// Starts for the fit: points of the search's archive, best first, that differ in the scanned gene. The
/// genes are searched; `rest` are the parameters of the model's effects, which stay.
///
/// # Errors
/// Of the laboratory.
pub async fn enter<L: Laboratory>(
    lab: &mut L,
    (bench, stage): (&Bench, Stage),
    (model, rest): (&Model, &[f64]),
    seed: u64,
) -> Result<Vec<Vec<f64>>, L::Error> {
    let whole = |mut genes: Vec<f64>| {
        genes.extend_from_slice(rest);
        genes
    };
    let Some(Ok(mut strategy)) =
        preset("quick").map(|preset| (preset.settings)(&model.space).build(&model.space, seed))
    else {
        return Ok(vec![whole(vec![0.0; model.space.dimension()])]);
    };
    let mut found: Vec<(f64, Vec<f64>)> = Vec::new();
    while strategy.finished().is_none() {
        let proposals = strategy.ask();
        if proposals.is_empty() {
            break;
        }
        let points: Vec<Vec<f64>> = proposals
            .iter()
            .map(|proposal| whole(model.space.point(&proposal.genes)))
            .collect();
        let points: Vec<(&Model, &[f64])> = points.iter().map(|x| (model, x.as_slice())).collect();
        let curves = bench.curves(lab, stage, &points).await?;
        for ((proposal, (_, x)), curves) in proposals.iter().zip(&points).zip(curves) {
            let told = curves.map_or(
                Told {
                    fitness: f64::MAX,
                    complete: false,
                },
                |curves| Told {
                    fitness: bench.residual(&curves).norm_squared(),
                    complete: true,
                },
            );
            if told.complete {
                found.push((told.fitness, x.to_vec()));
            }
            strategy.tell(proposal.id, told);
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(apart(found.into_iter().map(|(_, x)| x)))
}

/// The best points, no two of which lie within a few hundredths of a decade in every gene.
fn apart(ranked: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
    const STARTS: usize = 3;
    /// Decades; the first gene is the one with the narrow valley.
    const NEAR: [f64; 2] = [0.03, 0.15];
    let mut kept: Vec<Vec<f64>> = Vec::new();
    for x in ranked {
        let near = |other: &Vec<f64>| {
            let pairs = other.iter().zip(&x).enumerate();
            pairs
                .into_iter()
                .all(|(k, (a, b))| (a - b).abs() < NEAR[k.min(1)])
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
