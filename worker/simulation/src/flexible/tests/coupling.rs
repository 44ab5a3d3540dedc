//! Tests of the share of a load pattern's energy that each mode holds, and of the selection of modes by it.
use super::super::{arc::Rim, coupling::Patterns, mesh::Half, problem::Problem};
use super::*;

const ROPE: Wrap = Wrap {
    tension: 1000.0,
    anchor: 0.04,
    leaves: 0.12,
};

/// Checks that the shares of all modes of a body add up to the whole static energy, for every load pattern.
#[test]
fn shares_of_all_modes_add_up_to_one() {
    let mesh = mirrored();
    let half = Half::new(&mesh).unwrap();
    let rim = Rim::new(&half.mesh, [-2.0, 0.0]);
    let asked = request(&mesh, &[], &[Family::Symmetric]);
    let problem = Problem::new(&asked, &half, Family::Symmetric).unwrap();
    let patterns = Patterns::new(&problem, &rim, &[ROPE]).unwrap();
    let order = problem.assembly.mass.len();
    let all = lowest(&problem.assembly, &problem.factor, order).unwrap();
    let mut sums = [0.0; 4];
    for (value, shape) in all.eigenvalues.iter().zip(&all.shapes) {
        let field = problem.unit_mass(shape);
        let shares = patterns.shares(value.sqrt(), &field);
        for (sum, share) in sums.iter_mut().zip(shares) {
            *sum += share;
        }
    }
    for sum in sums {
        assert!((sum - 1.0).abs() < 1e-6, "{sums:?}");
    }
}

/// Checks that every kept mode couples more than every omitted one, that antisymmetric modes do not couple,
/// and that both lists ascend in frequency.
#[test]
fn modes_that_couple_most_are_kept() {
    let mesh = mirrored();
    let both = [Family::Symmetric, Family::Antisymmetric];
    let asked = ReductionRequest {
        center: [-2.0, 0.0],
        patterns: &[ROPE],
        modes: 4,
        ..request(&mesh, &[], &both)
    };
    let picked = reduce(&asked).unwrap();
    assert_eq!((picked.modes.len(), picked.left_out.len()), (4, 28));
    let least = picked.modes.iter().map(|m| m.coupling).fold(1.0, f64::min);
    for mode in &picked.left_out {
        assert!(mode.coupling < least);
        assert_eq!(mode.coupling > 0.0, mode.family == Family::Symmetric);
    }
    let lower = picked
        .left_out
        .iter()
        .filter(|m| m.frequency < picked.modes[3].frequency);
    assert!(lower.count() > 0, "the lowest would have been picked too");
    assert!(picked.modes.is_sorted_by_key(|mode| mode.frequency));
    assert!(picked.left_out.is_sorted_by_key(|mode| mode.frequency));
    // in full: a rope and the beam's motion pull in the plane of motion
    let lowest = reduce(&ReductionRequest {
        patterns: &[],
        ..asked
    });
    let lowest = lowest.unwrap();
    assert!(lowest.left_out.is_empty());
    assert!(
        lowest
            .modes
            .iter()
            .any(|m| m.family == Family::Antisymmetric)
    );
}
