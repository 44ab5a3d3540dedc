//! The whole reduction: mesh in, modes along the rope arc and static influence lines out.
//!
//! Every computation runs on the half z >= 0. A rope over the whole width pulls symmetrically, so
//! antisymmetric modes move the rim by nothing on the mean and couple to no plane motion; a gauge
//! feels them. Two ropes beside each other do drive them ([`super::sway`]). Here is what is asked and answered; [`super::problem`] does the work.
use super::{
    ReductionError,
    arc::{Rim, Station},
    coupling::{CANDIDATES, LeftOut, Patterns, pick},
    element::Steel,
    gauge::Gauge,
    mesh::{Half, Mesh},
    problem::Problem,
    sway::{Pair, SwayTables},
};

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

/// One mode of unit modal mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Its family.
    pub family: Family,
    /// Angular frequency [rad/s].
    pub frequency: f64,
    /// Outward radial displacement at the stations [kg^-1/2]; s.
    pub radial: Vec<f64>,
    /// Tangential displacement towards increasing psi; s.
    pub tangential: Vec<f64>,
    /// Stress at the gauges [Pa per unit modal coordinate]; g.
    pub gauge_stress: Vec<f64>,
    /// Integrals of density times `(phi_x, phi_y, x phi_y - y phi_x)`.
    pub participation: [f64; 3],
    /// Largest share of any load pattern's static energy that it holds \[1\]; 0 without patterns.
    pub coupling: f64,
    /// Displacement of every node of the whole mesh; empty unless asked for.
    pub field: Vec<[f64; 3]>,
}

/// A reduced head.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// Modes, lowest first; n.
    pub modes: Vec<Mode>,
    /// Modes that couple less to the load patterns, lowest first; empty without patterns.
    pub left_out: Vec<LeftOut>,
    /// Stress per newton of inward normal force [Pa/N], station by station; s x g.
    pub normal_influence: Vec<Vec<f64>>,
    /// Stress per newton of tangential force towards increasing psi; s x g.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Stress per unit base acceleration in x, y and about the pivot; 3 x g.
    pub inertia_stress: [Vec<f64>; 3],
    /// Outward radial displacement at probe j per inward newton at probe i [m/N]; p x p.
    pub compliance: Vec<Vec<f64>>,
    /// Displacement of every node under the wrapped rope \[m\]; empty without one.
    pub wrap_field: Vec<[f64; 3]>,
    /// Stress at every element's centre under the wrapped rope \[Pa\]: xx, yy, zz, xy, yz, zx.
    pub wrap_stress: Vec<[f64; 6]>,
    /// What two ropes ask for, where there are two.
    pub sway: Option<SwayTables>,
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass in the plane \[m\].
    pub center_of_mass: [f64; 2],
    /// Moment of inertia about the origin [kg m2].
    pub inertia: f64,
    /// Unknown displacements of the symmetric half.
    pub unknowns: usize,
    /// Solves that all modes took.
    pub lanczos_steps: usize,
}

/// Reduces a head.
///
/// # Errors
/// [`ReductionError`]: a mesh that is not usable, stations or gauges beside it, too few modes.
pub fn reduce(request: &Request<'_>) -> Result<Reduction, ReductionError> {
    let half = Half::new(request.mesh)?;
    let rim = Rim::new(&half.mesh, request.center);
    let stations = request.stations.iter().map(|&psi| rim.station(psi));
    let stations: Vec<Station> = stations.collect::<Result<_, _>>()?;
    let rows = gauge_rows(request, &half)?;
    let mut modes = Vec::new();
    let mut lanczos_steps = 0;
    let statics = Problem::new(request, &half, Family::Symmetric)?;
    let patterns = match request.patterns {
        [] => None,
        ropes => Some(Patterns::new(&statics, &rim, ropes)?),
    };
    let count = request.modes * patterns.as_ref().map_or(1, |_| CANDIDATES);
    for &family in request.families {
        let other;
        let problem = if family == Family::Symmetric {
            &statics
        } else {
            other = Problem::new(request, &half, family)?;
            &other
        };
        let (found, steps) =
            problem.modes((request, count), patterns.as_ref(), &stations, &rows)?;
        modes.extend(found);
        lanczos_steps += steps;
    }
    let (modes, left_out) = if patterns.is_some() {
        pick(modes, request.modes)
    } else {
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        modes.truncate(request.modes);
        (modes, Vec::new())
    };
    let mut reduction = statics.answer(request, &rim, &stations, &rows)?;
    if let Some(pair) = &request.pair {
        let problem = Problem::new(request, &half, Family::Antisymmetric)?;
        reduction.sway = Some(problem.sway(request, &rim, pair, &rows)?);
    }
    reduction.modes = modes;
    reduction.left_out = left_out;
    reduction.lanczos_steps = lanczos_steps;
    Ok(reduction)
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

/// Row of `u_y` factors of a gauge on the half, and whether the gauge sits on the image.
pub(super) type Row = (Vec<(usize, f64)>, bool);

fn gauge_rows(request: &Request<'_>, half: &Half) -> Result<Vec<Row>, ReductionError> {
    let young = request.steel.young;
    let row = |(k, gauge): (usize, &Gauge)| {
        let [x, y, z] = gauge.position;
        let there = Gauge {
            position: [x, y, z.abs()],
            ..*gauge
        };
        Ok((there.row(&half.mesh, young, k + 1)?, z < 0.0))
    };
    request.gauges.iter().enumerate().map(row).collect()
}
