//! Volumes of single elements, with detection of inverted elements.
use protocol::pumping_unit::ElementKind;

/// Returns the volume of an element from its node positions, in Gmsh's order \[m3\]; `None` if the element is
/// inverted.
pub(super) fn of(kind: ElementKind, nodes: &[[f64; 3]]) -> Option<f64> {
    match kind {
        ElementKind::Hexahedron => Some(hexahedron(nodes)).filter(|volume| *volume > 0.0),
        ElementKind::Tetrahedron => tetrahedron(nodes),
    }
}

/// Computes the volume of a hexahedron exactly, by 2 x 2 x 2 Gauss points.
fn hexahedron(corners: &[[f64; 3]]) -> f64 {
    let at = 1.0 / 3.0_f64.sqrt();
    let mut volume = 0.0;
    for point in &SIGNS {
        let [r, s, t] = point.map(|sign| sign * at);
        let mut jacobian = [[0.0; 3]; 3];
        for (sign, corner) in SIGNS.iter().zip(corners) {
            let [a, b, c] = *sign;
            let slopes = [
                a * (1.0 + b * s) * (1.0 + c * t) / 8.0,
                b * (1.0 + a * r) * (1.0 + c * t) / 8.0,
                c * (1.0 + a * r) * (1.0 + b * s) / 8.0,
            ];
            for (row, slope) in jacobian.iter_mut().zip(slopes) {
                for (entry, x) in row.iter_mut().zip(corner) {
                    *entry += slope * x;
                }
            }
        }
        volume += determinant(&jacobian);
    }
    volume
}

/// Corners of the reference cube in Gmsh's order.
const SIGNS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Computes the volume of a tetrahedron, exactly for straight and for curved edges: the Jacobian's
/// determinant is of degree 3, as is the quadrature rule with weights 1/40 for the corners and 9/40 for the
/// face centres. Returns `None` if the determinant is not positive at one of these points, which is where a
/// badly displaced mid-edge node shows first.
fn tetrahedron(nodes: &[[f64; 3]]) -> Option<f64> {
    let mut volume = 0.0;
    for k in 0..4 {
        let corner = std::array::from_fn(|l| if l == k { 1.0 } else { 0.0 });
        let face = std::array::from_fn(|l| if l == k { 0.0 } else { 1.0 / 3.0 });
        for (point, share) in [(corner, 1.0 / 40.0), (face, 9.0 / 40.0)] {
            let along = slopes(nodes, &point);
            let edge = |k: usize| [0, 1, 2].map(|axis| along[k][axis] - along[0][axis]);
            let determinant = determinant(&[edge(1), edge(2), edge(3)]);
            if determinant <= 0.0 {
                return None;
            }
            volume += share * determinant / 6.0;
        }
    }
    Some(volume)
}

/// End nodes of the edges on which nodes 4 to 9 of a tetrahedron lie.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [2, 3], [1, 3]];

/// Returns the derivatives of the position with respect to each volume coordinate, at a point of a
/// tetrahedron.
fn slopes(nodes: &[[f64; 3]], point: &[f64; 4]) -> [[f64; 3]; 4] {
    let mut slopes = [[0.0; 3]; 4];
    let mut add = |k: usize, factor: f64, node: &[f64; 3]| {
        for (slope, x) in slopes[k].iter_mut().zip(node) {
            *slope += factor * x;
        }
    };
    let (corners, middles) = nodes.split_at(nodes.len().min(4));
    for (k, corner) in corners.iter().enumerate() {
        add(k, 4.0 * point[k] - 1.0, corner);
    }
    for ([a, b], middle) in EDGES.into_iter().zip(middles) {
        add(a, 4.0 * point[b], middle);
        add(b, 4.0 * point[a], middle);
    }
    slopes
}

fn determinant([[a, b, c], [d, e, f], [g, h, i]]: &[[f64; 3]; 3]) -> f64 {
    a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the nodes of a curved test tetrahedron: the unit tetrahedron under a quadratic map with
    /// determinant `1 - 2 a b x z`, so that its volume is `1/6 - 2 a b / 120`.
    fn bent(a: f64, b: f64) -> Vec<[f64; 3]> {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let middles = EDGES.map(|[i, j]| [0, 1, 2].map(|k| 0.5 * (corners[i][k] + corners[j][k])));
        let bend = |[x, y, z]: [f64; 3]| [x + a * y * z, y + b * x * x, z];
        corners.into_iter().chain(middles).map(bend).collect()
    }

    #[test]
    fn a_tetrahedron_with_curved_edges_has_its_volume() {
        let volume = of(ElementKind::Tetrahedron, &bent(0.4, 0.3)).unwrap();
        assert!(
            (volume - (1.0 / 6.0 - 0.24 / 120.0)).abs() < 1e-15,
            "{volume}"
        );
        let mut turned = bent(0.4, 0.3);
        for node in &mut turned {
            node[2] = -node[2];
        }
        assert_eq!(of(ElementKind::Tetrahedron, &turned), None);
        // the middle of the edge 0-1 three quarters of the way: the edge turns back
        let mut folded = bent(0.0, 0.0);
        folded[4][0] = 0.76;
        assert_eq!(of(ElementKind::Tetrahedron, &folded), None);
        folded[4][0] = 0.74;
        assert!(of(ElementKind::Tetrahedron, &folded).is_some());
    }
}
