//! Reduction of the back head to its modes and the stress on its surface, done by workers as jobs.
use journal::event::JobReason;
use protocol::{
    id::JobId,
    job::{Answer, Job},
    pumping_unit::{HeadSurface, REDUCE_HEAD, ReduceHeadSpec, ReducedHead, SurfaceRequest},
    wire,
};
use study::{self, Evaluator, Stop, StudyError, run_batch};

/// Room for the fields of an answer in one message; what else it holds is small beside a mebibyte.
pub(super) const ROOM: usize = wire::BODY_LIMIT - MEBIBYTE;
pub(super) const MEBIBYTE: usize = 1 << 20;

/// Submits the reduction of a head as a job and returns its result.
///
/// # Errors
/// [`StudyError`] if the job could not be done, or the user stops.
pub(in crate::cli::command) async fn reduce_head(
    evaluator: &mut impl Evaluator,
    spec: &ReduceHeadSpec,
    stop: &mut Stop,
) -> Result<ReducedHead, StudyError> {
    let mut reduced = reductions(evaluator, (0, vec![spec.clone()]), stop).await?;
    let reduced = reduced.pop().ok_or_else(|| damaged("there is no answer"))?;
    let whole = match &reduced.surface {
        Some(surface) => is_whole(surface),
        None => spec.surface.is_none(),
    };
    if whole {
        Ok(reduced)
    } else {
        Err(damaged("the surface is missing or not whole"))
    }
}

/// Requests the stress on the surface of a head under unit loads, by the indices of [`SurfaceRequest::returned`], in as
/// many jobs as messages are needed, beside those of the reduction that returned the surface without a load.
///
/// # Errors
/// As [`reduce_head`], or if the stress under one load is more than one message holds.
pub(in crate::cli::command) async fn surface_stress(
    evaluator: &mut impl Evaluator,
    spec: &ReduceHeadSpec,
    (surface, loads): (&HeadSurface, &[u32]),
    stop: &mut Stop,
) -> Result<Vec<Vec<[f32; 6]>>, StudyError> {
    let at_once = loads_at_once(surface).ok_or_else(|| StudyError::Misconfigured {
        field: "flexible_head.mesh_file".to_owned(),
        problem: format!(
            "the mesh has {} points on its surface, whose stress is more than the {} MiB that travel in one message: use a \
             coarser mesh",
            surface.held.len(),
            ROOM / MEBIBYTE
        ),
    })?;
    let part = |loads: &[u32]| {
        let request = spec.surface.clone();
        ReduceHeadSpec {
            surface: request.map(|own| SurfaceRequest {
                returned: loads.to_vec(),
                ..own
            }),
            ..spec.clone()
        }
    };
    let parts: Vec<ReduceHeadSpec> = loads.chunks(at_once).map(part).collect();
    let reduced = reductions(evaluator, (1, parts), stop).await?;
    let points = surface.held.len();
    let mut stress = Vec::with_capacity(loads.len());
    for (own, part) in reduced.into_iter().zip(loads.chunks(at_once)) {
        let of_part = own.surface.unwrap_or_default().stress_mpa;
        if !is_stress_of(&of_part, part.len(), points) {
            return Err(damaged(
                "the stress is not that of the requested loads and points",
            ));
        }
        stress.extend(of_part);
    }
    Ok(stress)
}

/// Returns whether all arrays of a surface speak of the same points.
fn is_whole(surface: &HeadSurface) -> bool {
    let points = surface.held.len();
    let mut corners = surface.faces.iter().flatten();
    surface.places_m.len() == points
        && surface.normals.len() == points
        && corners.all(|&corner| (corner as usize) < points)
}

/// Returns whether a stress is that of a number of loads at a number of points.
fn is_stress_of(stress: &[Vec<[f32; 6]>], loads: usize, points: usize) -> bool {
    stress.len() == loads && stress.iter().all(|own| own.len() == points)
}

/// Returns the number of loads whose stress fits into one message beside the surface; `None` if none does.
fn loads_at_once(surface: &HeadSurface) -> Option<usize> {
    let points = surface.held.len();
    // numbers of at most 5 bytes
    let geometry = points * (24 + 12 + 1) + surface.faces.len() * 4 * 5;
    let stress = size_of::<[f32; 6]>() * points;
    let count = ROOM.saturating_sub(geometry) / stress.max(1);
    (count > 0).then_some(count)
}

/// Submits reductions as jobs with numbers from `first` on and returns their results in order.
async fn reductions(
    evaluator: &mut impl Evaluator,
    (first, specs): (u64, Vec<ReduceHeadSpec>),
    stop: &mut Stop,
) -> Result<Vec<ReducedHead>, StudyError> {
    let job = |spec: &ReduceHeadSpec| -> Result<Job, StudyError> {
        Ok(Job::Own {
            name: REDUCE_HEAD.to_owned(),
            body: wire::encode(spec).map_err(|error| damaged(&error.to_string()))?,
        })
    };
    let numbers = (first..).map(JobId);
    let jobs = numbers.zip(&specs);
    let jobs = jobs.map(|(number, spec)| Ok((number, job(spec)?)));
    let jobs: Vec<(JobId, Job)> = jobs.collect::<Result<_, StudyError>>()?;
    let reason = JobReason::outside_search("reduction");
    let mut reduced = vec![Vec::new(); jobs.len()];
    run_batch(evaluator, jobs, &reason, stop, |_, place, completed| {
        let what = || "the reduction of the back head".to_owned();
        reduced[place] = study::answer(completed, Answer::into_own, what)?;
        Ok(())
    })
    .await?;
    let decode = |body: &Vec<u8>| wire::decode(body).map_err(|error| damaged(&error.to_string()));
    reduced.iter().map(decode).collect()
}

fn damaged(problem: &str) -> StudyError {
    StudyError::Misconfigured {
        field: REDUCE_HEAD.to_owned(),
        problem: problem.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that a surface or a stress with one number too few or too many is not taken.
    #[test]
    fn incomplete_answers_are_found() {
        let whole = HeadSurface {
            places_m: vec![[0.1; 3]; 5],
            normals: vec![[0.1; 3]; 5],
            held: vec![false; 5],
            faces: vec![[0, 1, 2, 3], [1, 2, 3, 4]],
            stress_mpa: Vec::new(),
        };
        assert!(is_whole(&whole));
        let breaks: [fn(&mut HeadSurface); 4] = [
            |own| own.places_m.truncate(4),
            |own| own.normals.push([0.1; 3]),
            |own| own.held.truncate(4),
            |own| own.faces[1][3] = 5,
        ];
        for change in breaks {
            let mut broken = whole.clone();
            change(&mut broken);
            assert!(!is_whole(&broken), "{broken:?}");
        }
        let mut stress = vec![vec![[1.0; 6]; 5]; 3];
        assert!(is_stress_of(&stress, 3, 5) && !is_stress_of(&stress, 2, 5));
        stress[1].truncate(4);
        assert!(!is_stress_of(&stress, 3, 5));
    }

    /// Checks that the answer for as many loads as are asked for at once fits into one message, and that for one more
    /// would not.
    #[test]
    fn answers_are_as_large_as_a_message() {
        let points = 40_000;
        let mut surface = HeadSurface {
            places_m: vec![[0.1; 3]; points],
            normals: vec![[0.1; 3]; points],
            held: vec![false; points],
            faces: vec![[u32::MAX; 4]; points],
            stress_mpa: Vec::new(),
        };
        let count = loads_at_once(&surface).unwrap();
        assert!(count >= 10, "{count}");
        surface.stress_mpa = vec![vec![[1.0; 6]; points]; count];
        assert!(wire::encode(&surface).unwrap().len() <= ROOM);
        surface.stress_mpa.push(vec![[1.0; 6]; points]);
        assert!(wire::encode(&surface).unwrap().len() > ROOM);
        surface.held = vec![false; 1_000_000];
        assert_eq!(loads_at_once(&surface), None);
    }
}
