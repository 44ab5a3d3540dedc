//! Which modes are worth keeping: those that answer the loads which the head will bear.
//!
//! Under a load pattern `f` the head at rest holds the energy `f . K^-1 f / 2`, and the modes share it:
//! mode k, of unit mass and angular frequency `w_k`, has `(phi_k . f)^2 / w_k^2` of `f . K^-1 f`, and
//! the shares of all modes add up to one, since `K^-1 = sum phi_k phi_k^T / w_k^2`. Patterns are ropes
//! wrapped as they lie in a turn and the three accelerations of the beam. All of them mirror in z = 0,
//! so antisymmetric modes take no part. What a gauge reads is not asked here: static readings are
//! exact with whatever modes (influence lines).
use super::{
    answer::{LeftOut, Mode},
    arc::Rim,
    eigen::dot,
    error::ReductionError,
    problem::Problem,
    request::Wrap,
};

/// How many modes of a family are looked at for each one that is asked for.
pub(super) const CANDIDATES: usize = 4;

/// A load on the half, and the product with the displacement under it.
#[derive(Debug)]
struct Pattern {
    force: Vec<[f64; 3]>,
    compliance: f64,
}

/// Load patterns of a head.
#[derive(Debug)]
pub(super) struct Patterns(Vec<Pattern>);

impl Patterns {
    /// Ropes wrapped around the arc of a symmetric problem, and the base's accelerations.
    ///
    /// # Errors
    /// [`ReductionError`] where a rope lies beside the mesh.
    pub(super) fn new(
        symmetric: &Problem<'_>,
        rim: &Rim<'_>,
        ropes: &[Wrap],
    ) -> Result<Self, ReductionError> {
        let wraps = ropes.iter().map(|wrap| symmetric.wrap_force(rim, wrap));
        let base = symmetric.inertia.iter().cloned().map(Ok);
        let pattern = |force: Result<Vec<[f64; 3]>, ReductionError>| {
            let force = force?;
            let compliance = dot(force.as_flattened(), symmetric.solve(&force).as_flattened());
            Ok(Pattern { force, compliance })
        };
        wraps
            .chain(base)
            .map(pattern)
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// Share of each pattern's energy that a symmetric mode of unit mass of the whole holds.
    pub(super) fn shares(&self, frequency: f64, field: &[[f64; 3]]) -> impl Iterator<Item = f64> {
        self.0.iter().map(move |pattern| {
            // work and energy of both halves: (2 w)^2 over 2 c
            let work = dot(field.as_flattened(), pattern.force.as_flattened());
            2.0 * work.powi(2) / (frequency.powi(2) * pattern.compliance)
        })
    }
}

/// The `count` modes that couple most, lowest first, and the others, lowest first.
pub(super) fn pick(mut modes: Vec<Mode>, count: usize) -> (Vec<Mode>, Vec<LeftOut>) {
    modes.sort_by(|a, b| {
        let lower = a.frequency.total_cmp(&b.frequency);
        b.coupling.total_cmp(&a.coupling).then(lower)
    });
    let rest = modes.split_off(count.min(modes.len()));
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    let left_out = rest.into_iter().map(|mode| LeftOut {
        family: mode.family,
        frequency: mode.frequency,
        coupling: mode.coupling,
    });
    let mut left_out: Vec<LeftOut> = left_out.collect();
    left_out.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    (modes, left_out)
}
