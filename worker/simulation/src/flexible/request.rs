//! What to reduce, and to what.
use super::{element::Steel, gauge::Gauge, mesh::Mesh};

/// How a field mirrors in the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// `u_z` changes sign; it is zero on the plane.
    Symmetric,
    /// `u_x` and `u_y` change sign; they are zero on the plane.
    Antisymmetric,
}

impl Family {
    /// Signs of an image's displacements.
    pub const fn image(self) -> [f64; 3] {
        match self {
            Self::Symmetric => [1.0, 1.0, -1.0],
            Self::Antisymmetric => [-1.0, -1.0, 1.0],
        }
    }
}

/// What to reduce, and to what.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The head with its held nodes.
    pub mesh: &'a Mesh,
    /// Its material.
    pub steel: Steel,
    /// Where stress is read; g.
    pub gauges: &'a [Gauge],
    /// Centre of the rope arc \[m\].
    pub center: [f64; 2],
    /// Stations of shapes and influence lines \[rad\]; s.
    pub stations: &'a [f64],
    /// Stations of the compliance \[rad\]; p.
    pub probes: &'a [f64],
    /// A static load whose displacement and stress are wanted everywhere.
    pub wrap: Option<Wrap>,
    /// Two ropes beside the plane of symmetry, if that is what there are.
    pub pair: Option<Pair>,
    /// Number of modes n.
    pub modes: usize,
    /// Families to take them from.
    pub families: &'a [Family],
    /// Ropes as they lie in a turn: the modes that couple most to them and to the beam's motion are
    /// taken. Without any, the lowest.
    pub patterns: &'a [Wrap],
    /// Whether whole displacement fields are returned.
    pub fields: bool,
}

/// A rope wrapped around the arc: normal line load `tension / radius` between its fixed end and the
/// point where it leaves, and the tension along the tangent at the fixed end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrap {
    /// Rope tension \[N\].
    pub tension: f64,
    /// Angle of the fixed end \[rad\].
    pub anchor: f64,
    /// Angle where the rope leaves \[rad\], above `anchor`.
    pub leaves: f64,
}

impl Wrap {
    /// The normal line load as `pieces` forces \[N\] at the middles of equal pieces: the load per
    /// angle is the tension, whatever the radius.
    pub(super) fn line(&self, pieces: u32) -> impl Iterator<Item = (f64, f64)> {
        let step = (self.leaves - self.anchor) / f64::from(pieces);
        let (first, force) = (self.anchor + 0.5 * step, self.tension * step);
        (0..pieces).map(move |k| (first + step * f64::from(k), force))
    }
}

/// Two ropes on a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Distance of either rope from the plane z = 0 \[m\].
    pub offset: f64,
    /// Number of antisymmetric modes a.
    pub modes: usize,
}
