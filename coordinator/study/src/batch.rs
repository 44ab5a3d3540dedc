//! Scoring of a list of individuals; results in the order of the list.
use super::{
    evaluate::{EvaluationRequest, Scored, job, scored},
    evaluator::Evaluator,
    progress::ProgressView,
    stop::{Stop, or_stop},
    watch::Watch,
};
use protocol::{
    case::Case,
    id::JobId,
    job::{Evaluation, Verdict},
};
use std::collections::BTreeMap;

/// Scores individuals, each with one value for each unknown of the case \[declared units\]; equal individuals
/// are computed once.
///
/// # Errors
/// If the case or the workers make every evaluation impossible, if no evaluator is left, or if the user stops
/// it.
pub async fn score_all<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    individuals: &[Vec<f64>],
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<Vec<Scored>> {
    let mut open: BTreeMap<JobId, Vec<usize>> = BTreeMap::new();
    let mut numbers = evaluator.numbers()?;
    for (index, genes) in individuals.iter().enumerate() {
        let request = EvaluationRequest {
            tag: (),
            genes: genes.clone(),
            with_residual: false,
        };
        let job = job(case, &request);
        let id = numbers.number(&job);
        if let Some(same) = open.get_mut(&id) {
            same.push(index);
        } else {
            evaluator.submit(id, job)?;
            open.insert(id, vec![index]);
        }
    }
    let mut view = ProgressView {
        generations: 1,
        expected: open.len() as u64,
        ..ProgressView::default()
    };
    let mut found: BTreeMap<usize, Scored> = BTreeMap::new();
    while !open.is_empty() {
        watch.progress(&view, &|| evaluator.workers_status());
        let completed = or_stop(evaluator.next(), stop).await??;
        let Some(indices) = open.remove(&completed.id) else {
            continue;
        };
        let scored = scored(completed.id, completed.outcome)?;
        view.add(complete(&scored), completed.replayed);
        found.extend(indices.into_iter().map(|index| (index, scored.clone())));
    }
    watch.progress(&view, &|| evaluator.workers_status());
    Ok(found.into_values().collect())
}

/// Returns the objective of a scored individual; `None` if its simulation did not complete.
fn complete(scored: &Scored) -> Option<f64> {
    let complete = |it: &&Evaluation| it.verdict == Verdict::Complete;
    let evaluation = scored.as_ref().ok().filter(complete)?;
    Some(evaluation.fitness)
}
