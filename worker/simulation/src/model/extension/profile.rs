//! Deviation of the back head's surface from the nominal circle of the head's arc.
use crate::math::elementary::exp;

/// Deviation of the back head's surface from the nominal circle of its arc, as a sum of smooth hollows over
/// the arc angle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    hollows: Vec<Hollow>,
}

/// Hollow of depth `depth exp(-((s - centre) / reach)^2)` at arc angle `s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hollow {
    /// Greatest depth of the hollow, positive into the head \[m\].
    pub depth: f64,
    /// Arc angle of greatest depth, in the beam frame \[rad\].
    pub centre: f64,
    /// Angular distance from the centre at which the depth has fallen to 1/e \[rad\].
    pub reach: f64,
}

impl Profile {
    /// Adds a hollow to the profile.
    pub fn add_profile_change(&mut self, hollow: Hollow) {
        self.hollows.push(hollow);
    }

    /// Returns whether the profile has no hollows.
    pub const fn is_flat(&self) -> bool {
        self.hollows.is_empty()
    }

    /// Returns an upper bound of the height of the back head's surface above the nominal circle of its arc
    /// \[m\].
    pub fn highest(&self) -> f64 {
        let seams = self.hollows.iter().map(|hollow| (-hollow.depth).max(0.0));
        seams.sum()
    }

    /// Returns the height of the back head's surface above the nominal circle of its arc \[m\], with its
    /// first and second derivatives with respect to the arc angle.
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
