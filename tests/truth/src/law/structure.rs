//! Hidden effects in the steel structure: a worn back head, a misplaced front arc, and mass carried by the
//! beam.
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use simulation::effect::{Effect, Extensions, Hollow, Site};
use simulation::model::description::Description;
use std::sync::Arc;

/// Creates a worn area of the back head with an asymmetric triangular profile, composed of a row of narrow
/// hollows.
pub(super) fn worn_edge(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Worn {
        depth: size,
        centre: record_shape(shape, "centre_deg", draw.between(150.0, 195.0)),
        base: record_shape(shape, "base_deg", draw.between(16.0, 30.0)),
        skew: record_shape(shape, "lean_1", draw.between(-0.4, 0.4)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Worn {
    depth: f64,
    centre: f64,
    base: f64,
    /// Offset of the worn area's deepest point from its centre, in half widths of its base.
    skew: f64,
}

/// Half the number of intervals between the hollows that form a worn area, which has `2 HALF_ROW - 1`
/// hollows.
const HALF_ROW: i32 = 6;

impl Worn {
    /// Returns depth \[m\] and angle on the head \[deg\] of each hollow of the worn area, and the width
    /// shared by all hollows \[deg\].
    fn row(&self) -> (Vec<(f64, f64)>, f64) {
        let half = 0.5 * self.base;
        let spacing = half / f64::from(HALF_ROW);
        let reach = 1.1 * spacing;
        // a long row of equal hollows is as deep as one times this
        let overlap = reach * std::f64::consts::PI.sqrt() / spacing;
        let row = (-HALF_ROW + 1..HALF_ROW).map(|k| {
            let u = f64::from(k) / f64::from(HALF_ROW);
            let height = if u < self.skew {
                (1.0 + u) / (1.0 + self.skew)
            } else {
                (1.0 - u) / (1.0 - self.skew)
            };
            (self.depth * height / overlap, self.centre + half * u)
        });
        (row.collect(), reach)
    }
}

impl Effect for Worn {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        let (row, reach) = self.row();
        for (depth, centre) in row {
            extensions.add_hollow(Hollow {
                depth,
                centre: centre.to_radians(),
                reach: reach.to_radians(),
            });
        }
    }
}

impl HiddenEffect for Worn {}

/// Creates a misplaced front head arc: its centre is displaced by `size` and its radius is wrong by half as
/// much, with a drawn sign.
pub(super) fn front_arc(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(FrontArc {
        centre: size,
        radius: record_shape(shape, "radius_m", 0.5 * size * draw.sign()),
    })
}

#[derive(Clone, Copy, Debug)]
struct FrontArc {
    centre: f64,
    radius: f64,
}

impl Effect for FrontArc {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.front_arc.center[1] -= self.centre;
        d.front_arc.radius += self.radius;
    }
}

impl HiddenEffect for FrontArc {}

/// Creates ice and fluid carried near both ends of the beam, slightly uneven: additional inertia and an
/// unbalanced weight.
pub(super) fn carried(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Carried {
        share: size,
        arm: record_shape(shape, "arm_m", draw.between(2.8, 3.5)),
        uneven: record_shape(shape, "uneven_1", draw.between(-0.1, 0.1)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Carried {
    share: f64,
    arm: f64,
    uneven: f64,
}

impl Effect for Carried {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let inertia = self.share * d.beam_inertia;
        d.beam_inertia += inertia;
        d.beam_gravity_moment += self.uneven * inertia / self.arm * d.gravity;
    }
}

impl HiddenEffect for Carried {}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::exp;

    #[test]
    fn a_row_of_hollows_is_a_leaning_triangle() {
        let worn = Worn {
            depth: 0.004,
            centre: 170.0,
            base: 24.0,
            skew: 0.25,
        };
        let (row, reach) = worn.row();
        let depth = |place: f64| -> f64 {
            let part = |(depth, centre): &(f64, f64)| {
                let u = (place - centre) / reach;
                depth * exp(-u * u)
            };
            row.iter().map(part).sum()
        };
        let triangle = |place: f64| {
            let u = (place - 170.0) / 12.0;
            let height: f64 = if u < 0.25 {
                (1.0 + u) / 1.25
            } else {
                (1.0 - u) / 0.75
            };
            0.004 * height.max(0.0)
        };
        for place in [150.0, 161.0, 165.0, 168.0, 177.0, 179.0, 190.0] {
            let error = (depth(place) - triangle(place)).abs();
            assert!(
                error < 2e-4,
                "{place}: {} {}",
                depth(place),
                triangle(place)
            );
        }
        assert!(depth(173.0) > 0.0034 && depth(173.0) < 0.004);
    }
}
