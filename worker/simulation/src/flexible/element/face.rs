//! Faces of elements under a rope: where a line of constant angle crosses one, and what it feels there.
//!
//! Every node of a face has an angle about the rope arc's centre and a height along its axis; both
//! are interpolated as displacement is. Knows one face, no mesh and no arc.

/// An angle \[rad\] and a height \[m\] of a node.
pub(in super::super) type Seen<'a> = &'a dyn Fn(usize) -> [f64; 2];

/// A point of a face.
#[derive(Clone, Debug)]
pub(in super::super) struct Crossing {
    /// Nodes and their shape functions.
    pub(in super::super) nodes: Vec<(usize, f64)>,
    /// Its height \[m\].
    pub(in super::super) height: f64,
}

/// The line of constant angle across one face, from edge to edge.
#[derive(Clone, Debug)]
pub(in super::super) enum Cut {
    /// Displacement is taken as linear between two ends.
    Linear([Crossing; 2]),
    /// It is quadratic, with a point in the middle.
    Quadratic([Crossing; 3]),
}

impl Cut {
    /// Points along the cut and their shares of its mean: the trapezium's, Simpson's.
    pub(in super::super) fn points(&self) -> impl Iterator<Item = (&Crossing, f64)> {
        let (points, shares): (&[Crossing], &[f64]) = match self {
            Self::Linear(points) => (points, &[0.5, 0.5]),
            Self::Quadratic(points) => (points, &[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]),
        };
        points.iter().zip(shares.iter().copied())
    }

    /// Heights of its ends \[m\].
    pub(in super::super) const fn ends(&self) -> [f64; 2] {
        match self {
            Self::Linear([p, q]) | Self::Quadratic([p, _, q]) => [p.height, q.height],
        }
    }

    /// Points along the cut and their shares of its point at a height \[m\] between its ends.
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

/// A kind of face. Nodes are always all of one face, in Gmsh's order.
pub(in super::super) trait Face: Sync {
    /// Number of nodes.
    fn nodes(&self) -> usize;

    /// Where a face is cut by the line at an angle \[rad\], if it is.
    fn cut(&self, face: &[usize], seen: Seen<'_>, psi: f64) -> Option<Cut>;
}

/// Whether the line at an angle passes between two corners. One on the line belongs to the side
/// above it: no edge is crossed twice.
fn crosses(a: f64, b: f64, psi: f64) -> bool {
    (a <= psi) != (b <= psi)
}

/// The 4-node face of a brick: edges are cut, and what lies between is taken as linear.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quadrilateral;

impl Face for Quadrilateral {
    fn nodes(&self) -> usize {
        4
    }

    fn cut(&self, face: &[usize], seen: Seen<'_>, psi: f64) -> Option<Cut> {
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

/// The 6-node face of a tetrahedron: three corners, then the nodes of the edges 01, 12, 20. The cut
/// is straight in its area coordinates; along it displacement is quadratic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle;

impl Triangle {
    /// Shape functions at area coordinates.
    fn shape(l: &[f64; 3]) -> [f64; 6] {
        std::array::from_fn(|node| match node.checked_sub(3) {
            None => l[node] * (2.0 * l[node] - 1.0),
            Some(edge) => 4.0 * l[edge] * l[(edge + 1) % 3],
        })
    }

    fn crossing(face: &[usize], seen: Seen<'_>, l: &[f64; 3]) -> Crossing {
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

    fn cut(&self, face: &[usize], seen: Seen<'_>, psi: f64) -> Option<Cut> {
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

/// Quadratic shape functions of the start, the middle and the end of a line.
fn along(t: f64) -> [f64; 3] {
    [
        (1.0 - t) * (1.0 - 2.0 * t),
        4.0 * t * (1.0 - t),
        t * (2.0 * t - 1.0),
    ]
}

/// Where a quadratic function with given values at 0, 1/2 and 1 reaches a level between the first and
/// the last.
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
