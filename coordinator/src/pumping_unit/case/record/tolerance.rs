//! How good the instruments of a test are, as its data sheet states it.
use serde::Deserialize;

/// One standard deviation of each instrument's error, constant over a test; none where the sheet states
/// nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tolerance {
    /// Of each gauge's reading, relative \[1\].
    gauge_factor: Option<f64>,
    /// Of the index mark's place on the crank \[deg\].
    index_deg: Option<f64>,
    /// Of the load card's load, relative \[1\].
    load_cell: Option<f64>,
    /// Of the amplifier's delay, which is never negative \[s\].
    amplifier_lag_s: Option<f64>,
    /// Of the rod position's reading, relative \[1\].
    position: Option<f64>,
    /// Of the crank torque's reading, relative \[1\].
    torque: Option<f64>,
    /// Of the friction of the saddle bearing, which is never negative [N m].
    bearing_friction_nm: Option<f64>,
    /// Of the moment of the beam's own weight about the saddle bearing [N m].
    balance_nm: Option<f64>,
}

impl Tolerance {
    /// What is stated, by the names of its keys.
    pub(super) fn stated(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [
            ("gauge_factor", self.gauge_factor),
            ("index_deg", self.index_deg),
            ("load_cell", self.load_cell),
            ("amplifier_lag_s", self.amplifier_lag_s),
            ("position", self.position),
            ("torque", self.torque),
            ("bearing_friction_nm", self.bearing_friction_nm),
            ("balance_nm", self.balance_nm),
        ];
        let stated = |(name, value): (_, Option<f64>)| value.map(|value| (name, value));
        all.into_iter().filter_map(stated)
    }
}
