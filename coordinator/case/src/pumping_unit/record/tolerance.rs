//! Tolerances of the instruments of a test, as stated in its data sheet, and the model parameter that
//! represents each instrument's error: that of a library effect or the gain of a channel.
use protocol::pumping_unit::Sensor;
use record::{Acts, Nuisance};
use serde::Deserialize;

/// Standard deviation of each instrument's error, which is constant over a test; `None` where the sheet
/// states nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tolerance {
    /// Standard deviation of each gauge's gain, relative \[1\].
    gauge_factor: Option<f64>,
    /// Standard deviation of the angular position of the index mark on the crank \[deg\].
    index_deg: Option<f64>,
    /// Standard deviation of the load cell's error, relative to the load \[1\].
    load_cell: Option<f64>,
    /// Standard deviation of the amplifier's delay, which is never negative \[s\].
    amplifier_lag_s: Option<f64>,
    /// Standard deviation of the rod position's gain, relative \[1\].
    position: Option<f64>,
    /// Standard deviation of the crank torque's gain, relative \[1\].
    torque: Option<f64>,
    /// Standard deviation of the friction moment of the saddle bearing, which is never negative [N m].
    bearing_friction_nm: Option<f64>,
    /// Standard deviation of the moment of the beam's own weight about the saddle bearing [N m].
    balance_nm: Option<f64>,
}

/// Model parameter that represents an instrument's error.
pub(super) enum ErrorModel {
    /// Parameter that sets the size of a library effect: identifier of the effect, name of the parameter.
    Effect(&'static str, &'static str),
    /// Parameter that sets the size of a library effect which only one sensor shows: sensor, identifier of
    /// the effect, name of the parameter.
    Seen(Sensor, &'static str, &'static str),
    /// Gain of a sensor: the sensor, and the identifier of the gain.
    Gain(Sensor, &'static str),
}

/// Key of the `[tolerance]` table: name, default standard deviation where the sheet states none, unit,
/// whether the error is never negative, and the model parameters that represent the error. The defaults are
/// those of a good foil gauge, an index mark set by hand and a load cell of class 0.3.
pub(super) type Key = (&'static str, f64, &'static str, bool, &'static [ErrorModel]);

/// All keys of the `[tolerance]` table, in its order.
pub(super) const KEYS: [Key; 8] = [
    (
        "gauge_factor",
        0.005,
        "1",
        false,
        &[
            ErrorModel::Seen(Sensor::Gauge(1), "gauge_gain", "gain_1"),
            ErrorModel::Seen(Sensor::Gauge(2), "gauge_gain", "gain_2"),
            ErrorModel::Seen(Sensor::Gauge(3), "gauge_gain", "gain_3"),
            ErrorModel::Seen(Sensor::Gauge(4), "gauge_gain", "gain_4"),
        ],
    ),
    (
        "index_deg",
        0.06,
        "deg",
        false,
        &[ErrorModel::Effect("crank_angle_offset", "angle")],
    ),
    (
        "load_cell",
        0.003,
        "1",
        false,
        &[ErrorModel::Effect("load_cell_gain", "gain")],
    ),
    (
        "amplifier_lag_s",
        0.002,
        "s",
        true,
        &[ErrorModel::Effect("amplifier_lag", "lag")],
    ),
    (
        "position",
        0.002,
        "1",
        false,
        &[ErrorModel::Gain(Sensor::Position, "position_gain")],
    ),
    (
        "torque",
        0.005,
        "1",
        false,
        &[ErrorModel::Gain(Sensor::Torque, "torque_gain")],
    ),
    (
        "bearing_friction_nm",
        50.0,
        "N.m",
        true,
        &[ErrorModel::Effect("pivot_friction", "moment")],
    ),
    (
        "balance_nm",
        200.0,
        "N.m",
        false,
        &[ErrorModel::Effect("beam_balance", "moment")],
    ),
];

impl Tolerance {
    /// Returns the standard deviation of each key of the `[tolerance]` table, in the order of [`KEYS`];
    /// `None` where the sheet states none.
    const fn values(&self) -> [Option<f64>; KEYS.len()] {
        [
            self.gauge_factor,
            self.index_deg,
            self.load_cell,
            self.amplifier_lag_s,
            self.position,
            self.torque,
            self.bearing_friction_nm,
            self.balance_nm,
        ]
    }

    /// Returns the standard deviations that the sheet states, with the names of their keys.
    pub(super) fn stated(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let stated = |((name, ..), value): (Key, Option<f64>)| Some((name, value?));
        KEYS.into_iter().zip(self.values()).filter_map(stated)
    }

    /// Returns the nuisance parameters of a record with the given sensors; unstated standard deviations take
    /// their defaults and are marked as assumed.
    pub(super) fn nuisances(&self, recorded: &[Sensor]) -> Vec<Nuisance> {
        let of_key = |((_, usual, unit, never_negative, means), stated): (Key, Option<f64>)| {
            means.iter().filter_map(move |means| {
                let (id, parameter, sensor, acts) = match *means {
                    ErrorModel::Effect(id, parameter) => (id, parameter, None, Acts::Effect),
                    ErrorModel::Seen(sensor, id, parameter) => {
                        (id, parameter, Some(sensor), Acts::Effect)
                    }
                    ErrorModel::Gain(sensor, id) => {
                        let curve = Sensor::ALL.iter().position(|own| *own == sensor)?;
                        (id, "gain", Some(sensor), Acts::Gain { curve })
                    }
                };
                let shown = sensor.is_none_or(|sensor| recorded.contains(&sensor));
                shown.then(|| Nuisance {
                    id: id.to_owned(),
                    parameter: parameter.to_owned(),
                    unit: unit.to_owned(),
                    acts,
                    deviation: stated.unwrap_or(usual),
                    never_negative,
                    assumed: stated.is_none(),
                })
            })
        };
        KEYS.into_iter()
            .zip(self.values())
            .flat_map(of_key)
            .collect()
    }
}
