//! Response of the head to two ropes with unequal tension: antisymmetric modes and influence lines at a
//! distance from the plane of symmetry.
//!
//! A rope beside the plane is treated as a line, not as a mean over the width: shapes are evaluated where it
//! lies on the rope surface, at `z = +offset`, and forces act there. Every force has an image at `z =
//! -offset`: opposite for a force in the plane of motion, equal for a force along z.
use super::{
    arc::{Rim, Station},
    eigen::lowest,
    error::ReductionError,
    problem::Problem,
    request::{Pair, ReductionRequest},
    result::{Row, SwayTables},
};

impl Problem<'_> {
    /// Computes the antisymmetric modes and influence lines of a head for a pair of ropes.
    pub(super) fn sway(
        &self,
        request: &ReductionRequest<'_>,
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
            lines.iter().map(|line| of(line)).collect()
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
