//! The head's answer to two ropes that pull unequally: antisymmetric modes and influence lines at a
//! distance from the plane of symmetry.
//!
//! A rope beside the plane is a line, not a mean over the width: shapes hold where it lies on the rim,
//! at `z = +offset`, and forces act there. Every force has its image at `z = -offset`: opposite for one
//! in the plane of motion, equal for one along z.
use super::{
    ReductionError,
    arc::{Rim, Station},
    eigen::lowest,
    problem::Problem,
    reduction::{Request, Row},
};

/// Two ropes on a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Distance of either rope from the plane z = 0 \[m\].
    pub offset: f64,
    /// Number of antisymmetric modes a.
    pub modes: usize,
}

/// The antisymmetric side of a reduced head; a modes of unit modal mass, lowest first, seen at the
/// stations at `z = +offset`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SwayTables {
    /// Angular frequencies [rad/s]; a.
    pub frequencies: Vec<f64>,
    /// Outward radial displacement [kg^-1/2]; a x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential displacement towards increasing psi; a x s.
    pub tangential: Vec<Vec<f64>>,
    /// Displacement along z; a x s.
    pub lateral: Vec<Vec<f64>>,
    /// Stress at the gauges [Pa per unit modal coordinate]; a x g.
    pub gauge_stress: Vec<Vec<f64>>,
    /// Stress per newton inwards at +offset and one outwards at -offset [Pa/N]; s x g.
    pub normal_influence: Vec<Vec<f64>>,
    /// Stress per newton towards increasing psi at +offset and one back at -offset; s x g.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Stress per newton along +z at either; s x g.
    pub lateral_influence: Vec<Vec<f64>>,
}

impl Problem<'_> {
    /// Everything that two ropes ask for, of antisymmetric equations.
    pub(super) fn sway(
        &self,
        request: &Request<'_>,
        rim: &Rim<'_>,
        pair: &Pair,
        rows: &[Row],
    ) -> Result<SwayTables, ReductionError> {
        let stations = request.stations.iter();
        let stations: Vec<Station> = stations
            .map(|&psi| rim.station_beside(psi, pair.offset))
            .collect::<Result<_, _>>()?;
        let mut tables = SwayTables::default();
        if pair.modes > 0 {
            let found = lowest(&self.assembly, &self.factor, pair.modes)?;
            for (value, shape) in found.eigenvalues.iter().zip(&found.shapes) {
                let (field, gauge_stress) = self.signed(rows, self.unit_mass(shape));
                tables.frequencies.push(value.sqrt());
                tables.gauge_stress.push(gauge_stress);
                let along = |of: &dyn Fn(&Station) -> f64| stations.iter().map(of).collect();
                tables.radial.push(along(&|s| s.mean(&field, s.radial)));
                tables
                    .tangential
                    .push(along(&|s| s.mean(&field, s.tangential)));
                tables.lateral.push(along(&|s| s.mean_along_z(&field)));
            }
        }
        let lines = self.lines(rows);
        // a newton on the half that is solved has its image on the other
        let stress = |of: &dyn Fn(&[[f64; 3]]) -> f64| -> Vec<f64> {
            let signed = lines.iter().zip(rows);
            signed
                .map(|(line, row)| self.sign(row) * of(line))
                .collect()
        };
        for s in &stations {
            tables
                .normal_influence
                .push(stress(&|line| -s.mean(line, s.radial)));
            tables
                .tangential_influence
                .push(stress(&|line| s.mean(line, s.tangential)));
            tables
                .lateral_influence
                .push(stress(&|line| s.mean_along_z(line)));
        }
        Ok(tables)
    }
}
