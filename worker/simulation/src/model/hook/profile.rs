//! The back head's surface where it is not the circle of the description.
use crate::math::elementary::exp;

/// A sum of smooth hollows over the arc angle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    hollows: Vec<Hollow>,
}

/// Missing material `depth exp(-((s - centre) / reach)^2)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hollow {
    /// Greatest depth, positive into the head \[m\].
    pub depth: f64,
    /// Where it is deepest, arc angle in the beam frame \[rad\].
    pub centre: f64,
    /// Distance at which it is 1/e as deep \[rad\].
    pub reach: f64,
}

impl Profile {
    /// Adds a hollow.
    pub fn dig(&mut self, hollow: Hollow) {
        self.hollows.push(hollow);
    }

    /// Whether there is none.
    pub const fn is_flat(&self) -> bool {
        self.hollows.is_empty()
    }

    /// What no height exceeds \[m\].
    pub fn highest(&self) -> f64 {
        let seams = self.hollows.iter().map(|hollow| (-hollow.depth).max(0.0));
        seams.sum()
    }

    /// Height above the circle \[m\] with its first and second derivative over the arc angle.
    pub fn height(&self, angle: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for hollow in &self.hollows {
            let u = (angle - hollow.centre) / hollow.reach;
            let value = -hollow.depth * exp(-(u * u));
            sum[0] += value;
            sum[1] -= value * 2.0 * u / hollow.reach;
            sum[2] += value * (4.0 * u * u - 2.0) / (hollow.reach * hollow.reach);
        }
        sum
    }
}
