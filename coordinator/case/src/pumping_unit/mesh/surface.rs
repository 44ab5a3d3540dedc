//! Surface of a meshed body: its free faces, and the distance of a point from them.
use super::body::{Mesh, SYMMETRY, VOLUME};
use nalgebra::Vector3;
use protocol::pumping_unit::ElementKind;
use std::collections::{HashMap, HashSet};

/// Corners of the faces of a brick, in Gmsh's order of nodes.
const BRICK: [[usize; 4]; 6] = [
    [0, 3, 2, 1],
    [0, 1, 5, 4],
    [0, 4, 7, 3],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [4, 5, 6, 7],
];

/// Corners of the faces of a tetrahedron, in Gmsh's order of nodes; the last one is repeated.
const TETRAHEDRON: [[usize; 4]; 4] = [[0, 2, 1, 1], [0, 1, 3, 3], [0, 3, 2, 2], [3, 1, 2, 2]];

/// Returns the distance of each point from the surface of the body \[m\], inside or outside; faces between two
/// elements and those on the plane of a half's symmetry are not part of the surface. Curved faces are taken as the
/// plane triangles between their corners.
pub(in super::super) fn surface_distances_m(mesh: &Mesh, points: &[[f64; 3]]) -> Vec<f64> {
    let place = |node: usize| Vector3::from(mesh.nodes_m.get(node).copied().unwrap_or_default());
    let faces = free_faces(mesh);
    let triangles = faces
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .map(|corners| corners.map(place));
    let triangles: Vec<[Vector3<f64>; 3]> = triangles.collect();
    let distance = |&[x, y, z]: &[f64; 3]| {
        let point = Vector3::new(x, y, if mesh.half { z.abs() } else { z });
        let squares = triangles.iter();
        let squares = squares.map(|triangle| (closest(triangle, &point) - point).norm_squared());
        squares.fold(f64::INFINITY, f64::min).sqrt()
    };
    points.iter().map(distance).collect()
}

/// Returns the corners of the faces that belong to one element only and not to the plane of symmetry.
fn free_faces(mesh: &Mesh) -> Vec<[usize; 4]> {
    let corners: &[[usize; 4]] = match mesh.kind {
        ElementKind::Hexahedron => &BRICK,
        ElementKind::Tetrahedron => &TETRAHEDRON,
    };
    let mut free: HashMap<[usize; 4], Option<[usize; 4]>> = HashMap::new();
    let elements = mesh.volumes.get(VOLUME).map_or(&[][..], Vec::as_slice);
    for element in elements.chunks_exact(mesh.kind.nodes()) {
        for face in corners {
            let face = face.map(|corner| element[corner]);
            let mut key = face;
            key.sort_unstable();
            let seen = free.entry(key);
            seen.and_modify(|face| *face = None).or_insert(Some(face));
        }
    }
    let cut = mesh.surfaces.get(SYMMETRY).into_iter().flatten();
    let cut: HashSet<&usize> = cut.collect();
    let whole = free.into_values().flatten();
    whole
        .filter(|face| !face.iter().all(|node| cut.contains(node)))
        .collect()
}

/// Returns the point of a triangle that is closest to a point (Ericson, Real-Time Collision Detection, 5.1.5):
/// the projection where it falls inside, otherwise the closest point of the three edges.
fn closest(triangle: &[Vector3<f64>; 3], point: &Vector3<f64>) -> Vector3<f64> {
    let [a, b, c] = triangle;
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    if square > 0.0 {
        let inside = |from: &Vector3<f64>, to: &Vector3<f64>| {
            (to - from).cross(&(point - from)).dot(&normal) >= 0.0
        };
        if inside(a, b) && inside(b, c) && inside(c, a) {
            return point - normal * ((point - a).dot(&normal) / square);
        }
    }
    let on_edge = |from: &Vector3<f64>, to: &Vector3<f64>| {
        let along = to - from;
        let share = (point - from).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
        from + along * share.clamp(0.0, 1.0)
    };
    let edges = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    let nearest = edges.into_iter().min_by(|p, q| {
        let distance = |q: &Vector3<f64>| (q - point).norm_squared();
        distance(p).total_cmp(&distance(q))
    });
    nearest.unwrap_or(*a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Returns a beam of two unit cubes along x.
    fn cubes() -> Mesh {
        let nodes_m = (0..12)
            .map(|k| [f64::from(k / 4), f64::from(k % 4 / 2), f64::from(k % 2)])
            .collect();
        let brick = |first: usize| [0, 4, 6, 2, 1, 5, 7, 3].map(|node| node + first);
        let elements = [brick(0), brick(4)].concat();
        Mesh {
            nodes_m,
            volumes: BTreeMap::from([("steel".to_owned(), elements)]),
            ..Mesh::default()
        }
    }

    #[test]
    fn a_point_is_as_far_from_the_surface_as_geometry_says() {
        let mut mesh = cubes();
        assert!((mesh.volume_m3() - 2.0).abs() < 1e-12);
        let close = |mesh: &Mesh, point, expected: f64| {
            let distance = surface_distances_m(mesh, &[point])[0];
            assert!((distance - expected).abs() < 1e-12, "{point:?} {distance}");
        };
        // in the middle, where the faces between the elements do not count
        close(&mesh, [1.0, 0.5, 0.5], 0.5);
        close(&mesh, [1.3, 0.7, 0.9], 0.1);
        close(&mesh, [2.0, 0.2, 0.4], 0.0);
        // outside: beyond a face, an edge and a corner
        close(&mesh, [0.5, 0.5, 1.25], 0.25);
        close(&mesh, [0.5, 1.3, 1.4], 0.5);
        close(&mesh, [2.2, -0.1, 1.2], 0.3);
        // of the half, the cut is no surface, and the other side is its image
        mesh.half = true;
        let cut = [0, 2, 6, 4, 4, 6, 10, 8].to_vec();
        mesh.surfaces = BTreeMap::from([(SYMMETRY.to_owned(), cut)]);
        close(&mesh, [0.6, 0.5, 0.0], 0.5);
        close(&mesh, [0.6, 0.5, -0.9], 0.1);
    }
}
