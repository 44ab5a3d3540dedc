//! Parallel ropes (strands) on each head: their number and position, and the back-head mode shapes for each
//! of them.
//!
//! One rope on each head lies in the machine's plane. Twin ropes lie side by side at `z = +b` and `z = -b`
//! (frame W), and their lengths may differ. **All coefficients, masses and inertias that a description states
//! of a rope belong to the pair**, half of each to either rope: twins of equal length form one load path and
//! move as the single rope does.
//!
//! The head responds to equal loads of twins as to those of a single rope, by the modes that are symmetric
//! about the plane, whose tables are means over the width of the rim. It responds to opposite loads of twins
//! by the antisymmetric modes ([`AntisymmetricHead`]), whose tables hold at `z = +b`: at `z = -b` radial and tangential
//! displacement have the opposite sign, the lateral displacement has the same sign. Hence `u_j = sum_sym q
//! phi + j sum_anti q psi` for the rope at side `j = +1, -1`.
//!
//! The fixed ends of a pair are held by one clamp across the rim, which rotates with the line between its
//! ends: by `psi_r / b` about the tangent of the arc and by `-psi_t / b` about the radius, per unit of a
//! mode. This rotation and the lateral displacement are what moves a rope out of its plane and loads it in
//! torsion. At the other end the rope is held by a pin along z, on a crossbeam and a carrier bar that stay in
//! the plane as the beam does. Contact has no friction, so it acts in the plane and does not restrain a rope
//! along z.
use crate::math::spline::Splines;
use crate::model::description::{Description, Twins};
use crate::model::layout::Layout;

/// Index of the back head in arrays over both heads; `FRONT` is that of the front head.
pub(crate) const BACK: usize = 0;
pub(crate) const FRONT: usize = 1;

/// Position of one rope in the machine: its head, side and length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ParallelRope {
    /// Head around which the rope wraps: back (0) or front (1).
    pub(crate) rope: usize,
    /// Side of the rope: +1 or -1 in a pair, 0 for a single rope.
    pub(crate) side: f64,
    /// Out-of-plane position (z) of the rope \[m\].
    pub(crate) z: f64,
    /// Excess of the rope's length over its nominal length, inserted before the first cylinder \[m\].
    pub(crate) excess_length: f64,
}

/// Elastic response of the back head for one rope: mode shapes along the arc and at the anchor, and influence
/// lines of gauge stress.
#[derive(Clone, Debug)]
pub(crate) struct HeadResponse {
    /// Radial mode shapes of the head along its arc, positive outwards.
    pub(crate) radial: Splines,
    /// Motion of the rope's fixed end per unit of each mode.
    pub(crate) anchor: Vec<AnchorShape>,
    /// Gauge stress per unit of inward normal force along the arc, for each gauge.
    pub(crate) normal_influence: Splines,
    /// Gauge stress per unit of tangential force along the arc, for each gauge.
    pub(crate) tangential_influence: Splines,
    /// Gauge stress caused by out-of-plane loads at the fixed end; `None` for a single rope.
    pub(crate) beside: Option<OutOfPlaneStress>,
}

/// Gauge stress per unit of out-of-plane force and moment at the fixed end of one of two ropes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutOfPlaneStress {
    /// Gauge stress per unit of force along z at the rope's fixed end [Pa/N].
    pub(crate) lateral: [f64; 4],
    /// Gauge stress per unit of moment on the rope's fixed end, about the tangent of the arc and about its
    /// radius [Pa/(N m)].
    pub(crate) turning: [[f64; 4]; 2],
}

/// Motion of a rope's fixed end per unit of a modal coordinate, in the beam frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AnchorShape {
    /// Displacement of the rope's fixed end along x, y and z.
    pub(crate) moves: [f64; 3],
    /// Rotation of the rope's fixed end about the tangent and about the radius of the arc.
    pub(crate) turns: [f64; 2],
}

/// Returns the ropes of a machine in the order of its chains: those of the back head, then those of the front
/// head.
pub(super) fn strands(d: &Description) -> Vec<ParallelRope> {
    let of = |rope: usize| match &d.twins {
        None => vec![ParallelRope {
            rope,
            side: 0.0,
            z: 0.0,
            excess_length: 0.0,
        }],
        Some(twins) => [1.0, -1.0]
            .map(|side| ParallelRope {
                rope,
                side,
                z: side * twins.offset,
                excess_length: -0.5 * side * twins.longer[rope],
            })
            .to_vec(),
    };
    [of(BACK), of(FRONT)].concat()
}

/// Returns the elastic response of the back head for each back rope: the in-plane modes of the description
/// that are kept, followed by the out-of-plane modes.
pub(super) fn faces(d: &Description, layout: &Layout) -> Vec<HeadResponse> {
    let back = strands(d).into_iter().filter(|strand| strand.rope == BACK);
    back.map(|strand| face(d, layout, strand.side)).collect()
}

fn face(d: &Description, layout: &Layout, side: f64) -> HeadResponse {
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
    HeadResponse {
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

/// Computes the gauge stress per unit of out-of-plane load at the fixed end of one of two ropes. By
/// antisymmetry, a unit force along z on one rope equals half a newton on each; a moment equals a pair of
/// opposite forces at the two ends of the clamp.
fn beside(d: &Description, twins: &Twins) -> OutOfPlaneStress {
    let at_anchor = |curves: &[Vec<f64>]| -> [f64; 4] {
        let lines = Splines::natural(d.head.influence_start, d.head.influence_step, curves);
        [0, 1, 2, 3].map(|gauge| lines.value(d.back_arc.anchor, gauge))
    };
    let arm = -0.5 / twins.offset;
    let sway = &twins.sway;
    OutOfPlaneStress {
        lateral: at_anchor(&sway.lateral_influence).map(|x| 0.5 * x),
        turning: [
            at_anchor(&sway.normal_influence).map(|x| arm * x),
            at_anchor(&sway.tangential_influence).map(|x| arm * x),
        ],
    }
}
