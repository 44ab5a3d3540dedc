//! Faces of elements under a rope: intersection of a face with a line of constant angle, and interpolation of
//! displacements there.
//!
//! Every node of a face has an angle about the rope arc's centre and a height along its axis; both are
//! interpolated with the shape functions of displacement. This module handles a single face and knows neither
//! the mesh nor the arc.

/// Function from a node's index to its angle \[rad\] about the rope arc's centre and its height \[m\] along
/// the arc's axis.
pub(in super::super) type AngleAndHeight<'a> = &'a dyn Fn(usize) -> [f64; 2];

/// Point on the face of an element through which a line of constant angle passes.
#[derive(Clone, Debug)]
pub(in super::super) struct Crossing {
    /// Indices of the face's nodes with the values of their shape functions at the point.
    pub(in super::super) nodes: Vec<(usize, f64)>,
    /// Height of the point along the rope arc's axis \[m\].
    pub(in super::super) height: f64,
}

/// Section of a line of constant angle that crosses one element face, from edge to edge.
#[derive(Clone, Debug)]
pub(in super::super) enum Cut {
    /// Cut along which displacement is linear, given by its two ends.
    Linear([Crossing; 2]),
    /// Cut along which displacement is quadratic, given by its start, middle and end.
    Quadratic([Crossing; 3]),
}

impl Cut {
    /// Returns the integration points of the cut with their weights in the mean over it (trapezoidal or
    /// Simpson's rule).
    pub(in super::super) fn points(&self) -> impl Iterator<Item = (&Crossing, f64)> {
        let (points, shares): (&[Crossing], &[f64]) = match self {
            Self::Linear(points) => (points, &[0.5, 0.5]),
            Self::Quadratic(points) => (points, &[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]),
        };
        points.iter().zip(shares.iter().copied())
    }

    /// Returns the heights of the cut's two ends \[m\].
    pub(in super::super) const fn ends(&self) -> [f64; 2] {
        match self {
            Self::Linear([p, q]) | Self::Quadratic([p, _, q]) => [p.height, q.height],
        }
    }

    /// Returns the cut's points with the weights that interpolate displacement to a height \[m\] between its
    /// ends.
    pub(in super::super) fn at(&self, height: f64) -> Vec<(&Crossing, f64)> {
        match self {
            Self::Linear([p, q]) => {
                let share = (height - p.height) / (q.height - p.height);
                vec![(p, 1.0 - share), (q, share)]
            }
            Self::Quadratic([p, middle, q]) => {
                let t = reach([p.height, middle.height, q.height], height);
                let share = along(t);
                vec![(p, share[0]), (middle, share[1]), (q, share[2])]
            }
        }
    }
}

/// Kind of element face. Arguments `face` are the indices of all nodes of one face, in Gmsh's order.
pub(in super::super) trait Face: Sync {
    /// Returns the number of nodes of a face of this kind.
    fn nodes(&self) -> usize;

    /// Returns the intersection of a face with the line at angle `psi` \[rad\], or `None` if the line misses
    /// the face.
    fn cut(&self, face: &[usize], seen: AngleAndHeight<'_>, psi: f64) -> Option<Cut>;
}

/// Returns whether the line at angle `psi` passes between two face corners, whose angles are `a` and `b`. A
/// corner exactly on the line counts as lying below it, so that no edge is crossed twice.
fn crosses(a: f64, b: f64, psi: f64) -> bool {
    (a <= psi) != (b <= psi)
}

/// 4-node face of a brick: the cut is found on its edges, and displacement between the two points is taken as
/// linear.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quadrilateral;

impl Face for Quadrilateral {
    fn nodes(&self) -> usize {
        4
    }

    fn cut(&self, face: &[usize], seen: AngleAndHeight<'_>, psi: f64) -> Option<Cut> {
        let mut found = (0..4).filter_map(|k| {
            let (a, b) = (face[k], face[(k + 1) % 4]);
            let ([angle_a, height_a], [angle_b, height_b]) = (seen(a), seen(b));
            crosses(angle_a, angle_b, psi).then(|| {
                let share = (psi - angle_a) / (angle_b - angle_a);
                Crossing {
                    nodes: vec![(a, 1.0 - share), (b, share)],
                    height: height_a * (1.0 - share) + height_b * share,
                }
            })
        });
        Some(Cut::Linear([found.next()?, found.next()?]))
    }
}

/// 6-node face of a tetrahedron: three corners, then the nodes of the edges 01, 12, 20. The cut is a straight
/// line in area coordinates; displacement along it is quadratic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle;

impl Triangle {
    /// Returns the triangle's six shape functions at area coordinates.
    fn shape(l: &[f64; 3]) -> [f64; 6] {
        std::array::from_fn(|node| match node.checked_sub(3) {
            None => l[node] * (2.0 * l[node] - 1.0),
            Some(edge) => 4.0 * l[edge] * l[(edge + 1) % 3],
        })
    }

    fn crossing(face: &[usize], seen: AngleAndHeight<'_>, l: &[f64; 3]) -> Crossing {
        let nodes: Vec<(usize, f64)> = face.iter().copied().zip(Self::shape(l)).collect();
        let heights = nodes.iter().map(|&(node, share)| seen(node)[1] * share);
        Crossing {
            height: heights.sum(),
            nodes,
        }
    }
}

impl Face for Triangle {
    fn nodes(&self) -> usize {
        6
    }

    fn cut(&self, face: &[usize], seen: AngleAndHeight<'_>, psi: f64) -> Option<Cut> {
        let mut found = (0..3).filter_map(|k| {
            let next = (k + 1) % 3;
            let angle = |place: usize| seen(face[place])[0];
            crosses(angle(k), angle(next), psi).then(|| {
                let share = reach([angle(k), angle(k + 3), angle(next)], psi);
                let mut l = [0.0; 3];
                l[k] = 1.0 - share;
                l[next] = share;
                l
            })
        });
        let (p, q) = (found.next()?, found.next()?);
        let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (p[k] + q[k]));
        let crossing = |l| Self::crossing(face, seen, l);
        Some(Cut::Quadratic([
            crossing(&p),
            crossing(&middle),
            crossing(&q),
        ]))
    }
}

/// Returns the quadratic interpolation weights of a line's start, middle and end at `t` in 0..1.
fn along(t: f64) -> [f64; 3] {
    [
        (1.0 - t) * (1.0 - 2.0 * t),
        4.0 * t * (1.0 - t),
        t * (2.0 * t - 1.0),
    ]
}

/// Solves for the argument in 0..1 at which a quadratic function, given by its values at 0, 1/2 and 1, equals
/// `level`, which lies between the first and the last value.
fn reach([start, middle, end]: [f64; 3], level: f64) -> f64 {
    let constant = start - level;
    let linear = 4.0 * middle - 3.0 * start - end;
    let square = 2.0 * (start - 2.0 * middle + end);
    // its slope where it passes the level; of the two formulas the one without cancellation
    let discriminant = linear * linear - 4.0 * square * constant;
    let slope = discriminant.max(0.0).sqrt().copysign(end - start);
    if linear * slope >= 0.0 {
        -2.0 * constant / (linear + slope)
    } else {
        (slope - linear) / (2.0 * square)
    }
}
