//! Stress on the surface of a head, as a linear function of its loads.
//!
//! A face belongs to the surface if it is a face of one element only and does not lie on the plane of symmetry.
//! Stress is extrapolated from the integration points of each element to its corners and averaged there over the
//! elements whose faces meet within [`FACE_ANGLE`]: where the surface has an edge, each side has a value of its own.
//!
//! Loads are a basis in which the loads of a running machine are written: a uniform inward line load of the rope on
//! each interval of its arc, the pull at its fixed end, the accelerations of the beam, and the modes. A rope of unit
//! tension that leaves the arc at the end of an interval is the sum of the intervals up to there.
use super::{
    arc::Rim,
    error::ReductionError,
    mesh::Half,
    problem::Problem,
    request::{ReductionRequest, SurfaceLoads, Wrap},
    result::{Mode, SurfacePoint, SurfaceStress},
};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Largest angle between two faces over whose elements the stress at a common node is averaged \[rad\] (30 deg).
const FACE_ANGLE: f64 = std::f64::consts::FRAC_PI_6;
/// Number of forces that stand for the line load on one interval.
const PIECES: u32 = 64;

/// Face of one element on the surface.
struct SurfaceFace {
    element: usize,
    /// Places of the face's corners among those of its element; a triangle repeats its last one.
    corners: [usize; 4],
    /// Nodes at the corners.
    nodes: [usize; 4],
    normal: Vector3<f64>,
    /// Indices of the points at the corners.
    points: [usize; 4],
}

/// Load of the basis.
enum UnitLoad<'a> {
    /// Line load between two angles \[rad\], 1 N in all.
    Line(f64, f64),
    /// Force of 1 N at an angle \[rad\], inwards.
    Inwards(f64),
    /// Force of 1 N at an angle \[rad\], towards increasing angles.
    Along(f64),
    /// Inertial load per unit acceleration of the beam.
    Acceleration(&'a [[f64; 3]]),
    /// Unit coordinate of a mode.
    Mode(&'a Mode),
}

/// Computes the stress on the surface under the requested loads of the basis.
pub(super) fn surface(
    problem: &Problem<'_>,
    request: &ReductionRequest<'_>,
    rim: &Rim<'_>,
    (loads, modes): (&SurfaceLoads<'_>, &[Mode]),
) -> Result<SurfaceStress, ReductionError> {
    let basis = basis(problem, loads.breaks, modes);
    let field = |&index: &usize| {
        let count = basis.len();
        let load = basis.get(index);
        displacement(
            problem,
            rim,
            load.ok_or(ReductionError::UnitLoad { index, count })?,
        )
    };
    let fields: Vec<Vec<[f64; 3]>> = loads.returned.iter().map(field).collect::<Result<_, _>>()?;
    stress_on_surface(problem, request, &fields)
}

/// Computes the stress on the surface under displacement fields of the half.
pub(super) fn stress_on_surface(
    problem: &Problem<'_>,
    request: &ReductionRequest<'_>,
    fields: &[Vec<[f64; 3]>],
) -> Result<SurfaceStress, ReductionError> {
    let half = problem.half;
    let (points, faces) = points_and_faces(half);
    let mut by_element: BTreeMap<usize, Vec<&SurfaceFace>> = BTreeMap::new();
    for face in &faces {
        by_element.entry(face.element).or_default().push(face);
    }
    let mut stress = vec![vec![[0.0; 6]; points.len()]; fields.len()];
    let mut shares = vec![0.0; points.len()];
    let law = half.mesh.law();
    let elements: Vec<&[usize]> = half.mesh.elements().collect();
    for (element, faces) in by_element {
        let nodes = elements[element];
        let moved = |field: &Vec<[f64; 3]>| nodes.iter().map(|&node| field[node]).collect();
        let moved: Vec<Vec<[f64; 3]>> = fields.iter().map(moved).collect();
        let corner = law
            .corner_stress(&half.mesh.places(nodes), &request.steel, &moved)
            .map_err(|_| ReductionError::InvertedElement { element })?;
        // an element counts once at a point, however many of its faces meet there
        let mut at: Vec<(usize, usize)> = faces
            .iter()
            .flat_map(|face| face.points.into_iter().zip(face.corners))
            .collect();
        at.sort_unstable();
        at.dedup();
        for (point, corner_index) in at {
            shares[point] += 1.0;
            for (stress, corner) in stress.iter_mut().zip(&corner) {
                for (sum, own) in stress[point].iter_mut().zip(corner[corner_index]) {
                    *sum += own;
                }
            }
        }
    }
    for stress in &mut stress {
        for (stress, share) in stress.iter_mut().zip(&shares) {
            for sum in stress {
                *sum /= share;
            }
        }
    }
    Ok(SurfaceStress {
        points,
        faces: faces.iter().map(|face| face.points).collect(),
        stress,
    })
}

/// Returns the loads of the basis in their order.
fn basis<'a>(problem: &'a Problem<'_>, breaks: &[f64], modes: &'a [Mode]) -> Vec<UnitLoad<'a>> {
    let lines = breaks
        .windows(2)
        .map(|ends| UnitLoad::Line(ends[0], ends[1]));
    let end = breaks.first().copied();
    let end = end
        .into_iter()
        .flat_map(|psi| [UnitLoad::Inwards(psi), UnitLoad::Along(psi)]);
    let inertia = problem
        .inertia
        .iter()
        .map(|own| UnitLoad::Acceleration(own));
    let all = lines.chain(end).chain(inertia);
    all.chain(modes.iter().map(UnitLoad::Mode)).collect()
}

/// Returns the displacement field of the half under a load of the basis.
fn displacement(
    problem: &Problem<'_>,
    rim: &Rim<'_>,
    load: &UnitLoad<'_>,
) -> Result<Vec<[f64; 3]>, ReductionError> {
    let count = problem.half.mesh.nodes.len();
    Ok(match *load {
        UnitLoad::Line(anchor, leaves) => {
            let line = Wrap {
                tension: 1.0 / (leaves - anchor),
                anchor,
                leaves,
            };
            let mut force = vec![[0.0; 3]; count];
            for (psi, share) in line.line(PIECES) {
                let station = rim.station(psi)?;
                // a newton over the whole width is half a newton on the half
                station.add_force(&mut force, station.radial, -0.5 * share);
            }
            problem.solve(&force)
        }
        UnitLoad::Inwards(psi) => {
            let station = rim.station(psi)?;
            problem.solve(&station.force(count, station.radial, -0.5))
        }
        UnitLoad::Along(psi) => {
            let station = rim.station(psi)?;
            problem.solve(&station.force(count, station.tangential, 0.5))
        }
        UnitLoad::Acceleration(inertia) => {
            let field = problem.solve(inertia);
            field.iter().map(|u| u.map(|x| -x)).collect()
        }
        UnitLoad::Mode(mode) => {
            let whole = problem.half.source.iter().zip(&mode.field);
            let mut field = vec![[0.0; 3]; count];
            for ((node, image), moved) in whole {
                if !image {
                    field[*node] = *moved;
                }
            }
            field
        }
    })
}

/// Finds the points and faces of the surface of a half.
fn points_and_faces(half: &Half) -> (Vec<SurfacePoint>, Vec<SurfaceFace>) {
    let mesh = &half.mesh;
    let mut free: BTreeMap<[usize; 4], Option<SurfaceFace>> = BTreeMap::new();
    for (element, nodes) in mesh.elements().enumerate() {
        for &corners in mesh.law().faces() {
            let at = corners.map(|corner| nodes[corner]);
            let mut key = at;
            key.sort_unstable();
            let face = || SurfaceFace {
                element,
                corners,
                nodes: at,
                normal: normal(at.map(|node| mesh.nodes[node].into())),
                points: [0; 4],
            };
            free.entry(key)
                .and_modify(|face| *face = None)
                .or_insert_with(|| Some(face()));
        }
    }
    let on_surface = |face: &SurfaceFace| !face.nodes.iter().all(|&node| half.on_plane[node]);
    let mut faces: Vec<SurfaceFace> = free.into_values().flatten().filter(on_surface).collect();
    let mut around: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (k, face) in faces.iter().enumerate() {
        for (place, node) in face.nodes.iter().enumerate() {
            if !face.nodes[..place].contains(node) {
                around.entry(*node).or_default().push(k);
            }
        }
    }
    let mut held = vec![false; mesh.nodes.len()];
    for &node in &mesh.held {
        held[node] = true;
    }
    let mut points = Vec::new();
    for (node, around) in around {
        let mut left = around;
        while let Some(first) = left.pop() {
            // faces that meet smoothly, one after the other
            let mut smooth = vec![first];
            let mut next = 0;
            while let Some(&from) = smooth.get(next) {
                let normal = faces[from].normal;
                let meets = |k: &usize| faces[*k].normal.dot(&normal) >= libm::cos(FACE_ANGLE);
                smooth.extend(left.iter().copied().filter(meets));
                left.retain(|k| !smooth.contains(k));
                next += 1;
            }
            let sum: Vector3<f64> = smooth.iter().map(|&k| faces[k].normal).sum();
            for &k in &smooth {
                let face = &mut faces[k];
                for (at, point) in face.nodes.iter().zip(&mut face.points) {
                    if *at == node {
                        *point = points.len();
                    }
                }
            }
            points.push(SurfacePoint {
                place: mesh.nodes[node],
                normal: sum.normalize().into(),
                held: held[node],
            });
        }
    }
    (points, faces)
}

/// Returns the outward unit normal of a face from the positions of its corners.
fn normal([a, b, c, d]: [Vector3<f64>; 4]) -> Vector3<f64> {
    let across = (c - a).cross(&(d - b));
    // a triangle repeats its last corner
    let across = if c == d {
        (b - a).cross(&(c - a))
    } else {
        across
    };
    across.normalize()
}
