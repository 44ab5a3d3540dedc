//! Which ropes there are, where each hangs, and the back head as each of them sees it.
//!
//! One rope on each head lies in the machine's plane. Twin ropes lie side by side at `z = +b` and
//! `z = -b` (frame W) and are cut to lengths that may differ. **All coefficients, masses and inertias
//! that a description states of a rope belong to the pair**, half of each to either rope: twins of
//! equal length are one load path and move as the single rope does.
//!
//! What twins do together the head answers as it answers a single rope, by the modes that are
//! symmetric about the plane, whose tables are means over the width of the rim. What they do against
//! each other it answers by the antisymmetric ones ([`Sway`]), whose tables hold at `z = +b`: at
//! `z = -b` radial and tangential displacement have the other sign, the lateral one has the same.
//! So `u_j = sum_sym q phi + j sum_anti q psi` for the rope at side `j = +1, -1`.
//!
//! The fixed ends of a pair sit on one clamp across the rim, which turns with the line between its
//! ends: by `psi_r / b` about the tangent of the arc and by `-psi_t / b` about the radius, per unit of
//! a mode. That turn and the lateral displacement are what leads a rope out of its plane, and what
//! its torsion acts on. At the other end a pin along z holds it, on a crossbeam and a carrier bar
//! that stay in the plane as the beam does. Contact has no friction, so it presses a rope in the plane
//! and holds it nowhere along z.
use crate::math::spline::Splines;
use crate::model::description::{Description, Twins};
use crate::model::layout::Layout;

/// The back head's ropes, and the front head's.
pub(crate) const BACK: usize = 0;
pub(crate) const FRONT: usize = 1;

/// One rope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Strand {
    /// Head that it lies on: back (0) or front (1).
    pub(crate) rope: usize,
    /// +1 and -1 for the two of a pair, 0 for a single rope.
    pub(crate) side: f64,
    /// Place out of the plane \[m\].
    pub(crate) z: f64,
    /// What it is longer than drawn, put before the first cylinder \[m\].
    pub(crate) longer: f64,
}

/// The back head's elasticity as one rope sees it.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    /// Outward shapes along the arc, mode by mode.
    pub(crate) radial: Splines,
    /// How the rope's fixed end moves, mode by mode.
    pub(crate) anchor: Vec<AnchorShape>,
    /// Gauge stress per inward normal force along the arc, gauge by gauge.
    pub(crate) normal_influence: Splines,
    /// The same per tangential force.
    pub(crate) tangential_influence: Splines,
    /// What is there beside that where there are two ropes.
    pub(crate) beside: Option<Beside>,
}

/// Gauge stress under what pulls and turns the fixed end of one of two ropes out of its plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beside {
    /// Per force along z [Pa/N].
    pub(crate) lateral: [f64; 4],
    /// Per moment about the tangent and about the radius [Pa/(N m)].
    pub(crate) turning: [[f64; 4]; 2],
}

/// Motion of a fixed end per unit of a mode, in the beam frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AnchorShape {
    /// Displacement along x, y and z.
    pub(crate) moves: [f64; 3],
    /// Turn about the tangent and about the radius of the arc there.
    pub(crate) turns: [f64; 2],
}

/// The ropes of a machine in the order of its chains: back ones, then front ones.
pub(super) fn strands(d: &Description) -> Vec<Strand> {
    let of = |rope: usize| match &d.twins {
        None => vec![Strand {
            rope,
            side: 0.0,
            z: 0.0,
            longer: 0.0,
        }],
        Some(twins) => [1.0, -1.0]
            .map(|side| Strand {
                rope,
                side,
                z: side * twins.offset,
                longer: -0.5 * side * twins.longer[rope],
            })
            .to_vec(),
    };
    [of(BACK), of(FRONT)].concat()
}

/// The back head's faces, one per back rope; `modes` of the description's are kept, and `sway` are
/// added to them.
pub(super) fn faces(d: &Description, layout: &Layout) -> Vec<Face> {
    let back = strands(d).into_iter().filter(|strand| strand.rope == BACK);
    back.map(|strand| face(d, layout, strand.side)).collect()
}

fn face(d: &Description, layout: &Layout, side: f64) -> Face {
    let (head, anchor) = (&d.head, d.back_arc.anchor);
    let sway = d.twins.as_ref().map(|twins| (twins, &twins.sway));
    // the two families' curves of this rope
    let join = |plane: &[Vec<f64>], other: Option<&[Vec<f64>]>| -> Vec<Vec<f64>> {
        let signed = other.into_iter().flatten().take(layout.sway);
        let signed = signed.map(|curve| curve.iter().map(|x| side * x).collect());
        let plane = plane[..layout.plane_modes()].iter().cloned();
        plane.chain(signed).collect()
    };
    let grid = |curves: &[Vec<f64>]| Splines::natural(head.start, head.step, curves);
    let radial = grid(&join(&head.radial, sway.map(|(_, s)| &s.radial[..])));
    let tangential = grid(&join(
        &head.tangential,
        sway.map(|(_, s)| &s.tangential[..]),
    ));
    let lateral = sway.map(|(twins, s)| (twins.offset, grid(&s.lateral)));
    let shape = |k: usize| {
        let (s, c) = crate::math::elementary::sin_cos(anchor);
        let (r, t) = (radial.value(anchor, k), tangential.value(anchor, k));
        let mut shape = AnchorShape {
            moves: [r * c - t * s, r * s + t * c, 0.0],
            turns: [0.0; 2],
        };
        if let (Some((offset, lateral)), Some(k)) = (&lateral, k.checked_sub(layout.plane_modes()))
        {
            shape.moves[2] = lateral.value(anchor, k);
            let b = side * offset;
            shape.turns = [r / b, -t / b];
        }
        shape
    };
    // a newton on one rope is half a newton on both, and half a pair of opposite ones
    let influence = |both: &[Vec<f64>], against: Option<&[Vec<f64>]>| {
        let mut lines = both.to_vec();
        for (line, other) in lines.iter_mut().zip(against.into_iter().flatten()) {
            for (x, other) in line.iter_mut().zip(other) {
                *x += 0.5 * side * other;
            }
        }
        Splines::natural(head.influence_start, head.influence_step, &lines)
    };
    Face {
        anchor: (0..layout.modes).map(shape).collect(),
        normal_influence: influence(
            &head.normal_influence,
            sway.map(|(_, s)| &s.normal_influence[..]),
        ),
        tangential_influence: influence(
            &head.tangential_influence,
            sway.map(|(_, s)| &s.tangential_influence[..]),
        ),
        beside: d.twins.as_ref().map(|twins| beside(d, twins)),
        radial,
    }
}

/// A force along z on one rope is half a newton on both; a moment is a pair of opposite forces at the
/// two ends of the clamp.
fn beside(d: &Description, twins: &Twins) -> Beside {
    let at_anchor = |curves: &[Vec<f64>]| -> [f64; 4] {
        let lines = Splines::natural(d.head.influence_start, d.head.influence_step, curves);
        [0, 1, 2, 3].map(|gauge| lines.value(d.back_arc.anchor, gauge))
    };
    let arm = -0.5 / twins.offset;
    let sway = &twins.sway;
    Beside {
        lateral: at_anchor(&sway.lateral_influence).map(|x| 0.5 * x),
        turning: [
            at_anchor(&sway.normal_influence).map(|x| arm * x),
            at_anchor(&sway.tangential_influence).map(|x| arm * x),
        ],
    }
}
