//! Tests of the stress on the surface: bending of a beam, the closed surface of a half, and the superposition of
//! unit loads.
use super::super::{arc::Rim, mesh::Half, problem::Problem, surface::stress_on_surface};
use super::*;
use crate::flexible::{ReductionError, SurfaceLoads, SurfacePoint};

/// Angles of the rope's arc on [`mirrored`], about [`CENTER`] \[rad\].
const BREAKS: [f64; 4] = [0.04, 0.06, 0.09, 0.12];
const CENTER: [f64; 2] = [-2.0, 0.0];

/// Returns the stress under some of the loads: those of the intervals, two forces if there are any, three accelerations
/// and two modes.
fn surface_under(
    mesh: &Mesh,
    breaks: &[f64],
    returned: &[usize],
) -> Result<SurfaceStress, ReductionError> {
    let asked = ReductionRequest {
        center: CENTER,
        surface: Some(SurfaceLoads { breaks, returned }),
        modes: 2,
        fields: false,
        ..request(mesh, &[], &[Family::Symmetric])
    };
    let reduced = reduce(&asked)?;
    assert!(reduced.modes.iter().all(|mode| mode.field.is_empty()));
    Ok(reduced.surface.unwrap())
}

fn surface_of(mesh: &Mesh, breaks: &[f64]) -> SurfaceStress {
    let statics = breaks.len().saturating_sub(1) + if breaks.is_empty() { 3 } else { 5 };
    let all: Vec<usize> = (0..statics + 2).collect();
    surface_under(mesh, breaks, &all).unwrap()
}

/// Checks that parts of the loads, in any order, have the stress that they have together, and that a load beyond the last
/// is refused.
#[test]
fn loads_can_be_asked_for_in_parts() {
    let mesh = mirrored();
    let all = surface_of(&mesh, &BREAKS);
    assert_eq!(all.stress.len(), 10);
    for part in [&[9, 0, 4][..], &[], &[7]] {
        let own = surface_under(&mesh, &BREAKS, part).unwrap();
        assert_eq!(own.points.len(), all.points.len());
        let expected: Vec<_> = part.iter().map(|&load| all.stress[load].clone()).collect();
        assert_eq!(own.stress, expected);
    }
    let beyond = surface_under(&mesh, &BREAKS, &[3, 10]).unwrap_err();
    let expected = ReductionError::UnitLoad {
        index: 10,
        count: 10,
    };
    assert_eq!(beyond, expected);
}

/// Checks that bricks and tetrahedra under the weight of a beam have the bending stress of beam theory on its top, away
/// from the clamp.
#[test]
fn a_beam_under_its_weight_bends_as_theory_says() {
    let [length, height, width] = [2.0, 0.1, 0.08];
    let origin = [0.0, -0.05, -0.04];
    let beam = bricks([20, 2, 2], [length, height, width], origin, |x| x);
    for mesh in [tetrahedra::of_bricks(&beam), beam] {
        let surface = surface_of(&mesh, &[]);
        // unit acceleration upwards presses the beam down
        let stress = &surface.stress[1];
        assert_eq!(surface.stress.len(), 5);
        let section = height * width;
        let mut compared = 0;
        for (point, stress) in surface.points.iter().zip(stress) {
            let [x, y, _] = point.place;
            if point.normal[1] < 0.99 || !(0.5..1.4).contains(&x) {
                continue;
            }
            assert!((y - 0.05).abs() < 1e-9);
            let moment = 0.5 * STEEL.density * section * (length - x).powi(2);
            let expected = moment * 0.5 * height / (width * height.powi(3) / 12.0);
            assert!(
                (stress[0] / expected - 1.0).abs() < 0.02,
                "{x} {stress:?} {expected}"
            );
            compared += 1;
        }
        assert!(compared >= 9, "{compared}");
    }
}

/// Checks that a box has a point for each side at its edges, that its cut is no surface, and that its faces enclose it.
#[test]
fn edges_have_a_point_for_each_side_and_the_cut_has_none() {
    let block = bricks([2, 2, 4], [1.0, 1.0, 2.0], [0.0, 0.0, -1.0], |x| x);
    let surface = surface_of(&block, &[]);
    let at = |place: [f64; 3]| {
        let is_there = move |own: &&SurfacePoint| {
            let mut apart = own.place.iter().zip(place);
            apart.all(|(a, b)| (a - b).abs() < 1e-9)
        };
        surface.points.iter().filter(is_there)
    };
    assert_eq!(at([1.0, 1.0, 1.0]).count(), 3);
    assert_eq!(at([1.0, 0.5, 1.0]).count(), 2);
    assert_eq!(at([0.5, 0.5, 1.0]).count(), 1);
    assert_eq!(at([0.5, 0.5, 0.0]).count(), 0);
    assert_eq!(at([0.5, 1.0, 0.0]).count(), 1);
    assert!(
        surface
            .points
            .iter()
            .all(|own| own.held == (own.place[0] < 1e-9))
    );
    // top and four sides of 2 x 2 faces
    assert_eq!(surface.faces.len(), 4 + 4 * 4);
    for face in &surface.faces {
        let normals = face.map(|point| surface.points[point].normal);
        assert_eq!(normals, [normals[0]; 4]);
    }
}

/// Checks that the stress under a wrapped rope is the sum of its intervals, and, where the rope ends within an interval,
/// that a share of it is close to the direct solution away from the rope.
#[test]
fn a_wrapped_rope_is_the_sum_of_its_intervals() {
    let mesh = mirrored();
    let surface = surface_of(&mesh, &BREAKS);
    let half = Half::new(&mesh).unwrap();
    let rim = Rim::new(&half.mesh, CENTER);
    let asked = request(&mesh, &[], &[Family::Symmetric]);
    let problem = Problem::new(&asked, &half, Family::Symmetric).unwrap();
    for (leaves, tolerance) in [(0.12, 2e-3), (0.075, 2e-2)] {
        let rope = Wrap {
            tension: 1.0,
            anchor: BREAKS[0],
            leaves,
        };
        let field = problem.solve(&problem.wrap_force(&rim, &rope).unwrap());
        let direct = stress_on_surface(&problem, &asked, &[field]).unwrap();
        let loads: Vec<f64> = BREAKS
            .windows(2)
            .map(|ends| (leaves.min(ends[1]) - ends[0]).max(0.0))
            .chain([0.0, 1.0])
            .collect();
        let far = |k: &usize| surface.points[*k].place[0] < -0.6;
        let points: Vec<usize> = (0..surface.points.len()).filter(far).collect();
        let largest = points.iter().flat_map(|&k| direct.stress[0][k]);
        let largest = largest.fold(0.0_f64, |most, s| most.max(s.abs()));
        assert!(largest > 0.0 && points.len() > 20);
        for k in points {
            for axis in 0..6 {
                let sum = loads.iter().zip(&surface.stress);
                let sum: f64 = sum.map(|(load, unit)| load * unit[k][axis]).sum();
                let apart = (sum - direct.stress[0][k][axis]).abs();
                assert!(
                    apart < tolerance * largest,
                    "{leaves} {k} {axis} {apart} {largest}"
                );
            }
        }
    }
}
