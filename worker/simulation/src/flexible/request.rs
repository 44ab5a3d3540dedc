//! Input of the model reduction of a head: mesh, gauges, stations and loads.
use super::{element::Steel, gauge::Gauge, mesh::Mesh};

/// Symmetry of a displacement field about the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Symmetric field: the mirror image has `u_z` of opposite sign; `u_z` is zero on the plane.
    Symmetric,
    /// Antisymmetric field: the mirror image has `u_x` and `u_y` of opposite sign; both are zero on the
    /// plane.
    Antisymmetric,
}

impl Family {
    /// Returns the sign of each displacement component x, y, z in the mirror image of a field.
    pub const fn image(self) -> [f64; 3] {
        match self {
            Self::Symmetric => [1.0, 1.0, -1.0],
            Self::Antisymmetric => [-1.0, -1.0, 1.0],
        }
    }
}

/// Input of the reduction of a head.
#[derive(Clone, Debug)]
pub struct ReductionRequest<'a> {
    /// Mesh of the head, including its held nodes.
    pub mesh: &'a Mesh,
    /// Material of the head.
    pub steel: Steel,
    /// Gauges at which stress is computed; their number is called g.
    pub gauges: &'a [Gauge],
    /// Centre of the rope arc \[m\].
    pub center: [f64; 2],
    /// Angles of the stations at which mode shapes and influence lines are computed \[rad\]; their number is
    /// called s.
    pub stations: &'a [f64],
    /// Angles of the probes, the rim points between which the static compliance is computed \[rad\]; their
    /// number is called p.
    pub probes: &'a [f64],
    /// Wrapped rope under which the stress of the gauges and its gradient are computed, if any; with `fields`
    /// also the static displacement and stress of the whole mesh.
    pub wrap: Option<Wrap>,
    /// Pair of ropes beside the plane of symmetry; `None` for a single rope.
    pub pair: Option<Pair>,
    /// Number n of modes to keep in the reduced model.
    pub modes: usize,
    /// Symmetry families from which modes are computed and kept.
    pub families: &'a [Family],
    /// Wrapped ropes, as they occur over a revolution, used as load patterns: the modes that couple most to
    /// them and to the beam's motion are kept. If empty, the lowest modes are kept.
    pub patterns: &'a [Wrap],
    /// Loads under which the stress on the surface is computed; `None` if it is not requested.
    pub surface: Option<SurfaceLoads<'a>>,
    /// Whether to return the displacement fields of the modes and of the wrapped rope on all nodes.
    pub fields: bool,
}

/// Unit loads under which the stress on the surface of a head is computed.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceLoads<'a> {
    /// Angles between which a uniform line load of the rope is a load of its own, ascending from the rope's fixed end
    /// \[rad\]; b of them.
    pub breaks: &'a [f64],
    /// Indices of the loads whose stress is returned, in this order. Loads, by index: the b - 1 line loads; at the rope's
    /// fixed end 1 N inwards and 1 N towards increasing angles; unit accelerations along x, along y and about the origin;
    /// unit coordinates of the modes.
    pub returned: &'a [usize],
}

/// Rope wrapped around the arc: normal line load `tension / radius` between its fixed end and the point where
/// it leaves the arc, and the tension along the tangent at the fixed end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrap {
    /// Rope tension \[N\].
    pub tension: f64,
    /// Angle of the rope's fixed end on the arc \[rad\].
    pub anchor: f64,
    /// Angle where the rope leaves the arc \[rad\], greater than `anchor`.
    pub leaves: f64,
}

impl Wrap {
    /// Returns the rope's normal load on the arc as `pieces` pairs of angle \[rad\] and force \[N\], at the
    /// middles of equal intervals; the load per angle equals the tension for any radius.
    pub(super) fn line(&self, pieces: u32) -> impl Iterator<Item = (f64, f64)> {
        let step = (self.leaves - self.anchor) / f64::from(pieces);
        let (first, force) = (self.anchor + 0.5 * step, self.tension * step);
        (0..pieces).map(move |k| (first + step * f64::from(k), force))
    }
}

/// Pair of ropes on a head, symmetric about the plane z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Distance of each rope from the plane z = 0 \[m\].
    pub offset: f64,
    /// Number of antisymmetric modes to compute, called a.
    pub modes: usize,
}
