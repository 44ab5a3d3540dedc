//! Selection of the modes to keep: those with the most response to the expected loads of the head.
//!
//! Under a load pattern `f` the head in equilibrium stores the energy `f . K^-1 f / 2`, shared among the
//! modes: mode k, of unit mass and angular frequency `w_k`, has `(phi_k . f)^2 / w_k^2` of `f . K^-1 f`, and
//! the shares of all modes add up to one, since `K^-1 = sum phi_k phi_k^T / w_k^2`. Patterns are ropes
//! wrapped as they lie in a revolution, and the three accelerations of the beam. All of them are symmetric
//! about z = 0, so antisymmetric modes do not take part. Gauge readings are not considered here: static
//! readings are exact with any set of modes (influence lines).
use super::{
    arc::Rim,
    eigen::dot,
    error::ReductionError,
    problem::Problem,
    request::Wrap,
    result::{LeftOut, Mode},
};

/// Number of candidate modes computed per requested mode of a symmetry family; the best coupled are kept.
pub(super) const CANDIDATES: usize = 4;

/// Load pattern on the symmetric half of a head, with the work `f . K^-1 f` of the load on its static
/// displacement.
#[derive(Debug)]
struct Pattern {
    force: Vec<[f64; 3]>,
    compliance: f64,
}

/// Load patterns of a head, used to rank its modes.
#[derive(Debug)]
pub(super) struct Patterns(Vec<Pattern>);

impl Patterns {
    /// Creates the patterns of ropes wrapped around the arc of a symmetric problem, and of the base's
    /// accelerations.
    ///
    /// # Errors
    /// [`ReductionError`] if a rope lies outside the mesh.
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

    /// Computes, for each load pattern, the share of its static energy that is held by a given symmetric mode
    /// with unit mass on the whole head.
    pub(super) fn shares(&self, frequency: f64, field: &[[f64; 3]]) -> impl Iterator<Item = f64> {
        self.0.iter().map(move |pattern| {
            // work and energy of both halves: (2 w)^2 over 2 c
            let work = dot(field.as_flattened(), pattern.force.as_flattened());
            2.0 * work.powi(2) / (frequency.powi(2) * pattern.compliance)
        })
    }
}

/// Splits modes into the `count` with the largest coupling to the load patterns and the remaining ones, both
/// sorted by frequency.
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
