//! The channels of a pumping unit: strain gauges on its back head, the height of its polished rod and
//! the torque at its crank.
use crate::case::{Abscissa, Channel, Offset};

/// Measured quantity of one channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// Stress at a gauge, by its number, 1 to 4.
    Gauge(u8),
    /// Suspension height above its lowest design position.
    Position,
    /// Net torque at the crank shaft, counterweight included.
    Torque,
}

impl Sensor {
    /// All sensors, in the order of every case's channels.
    pub const ALL: [Self; 6] = [
        Self::Gauge(1),
        Self::Gauge(2),
        Self::Gauge(3),
        Self::Gauge(4),
        Self::Position,
        Self::Torque,
    ];

    /// Creates the channel of this sensor under a condition, sampled at the crank angles `turn_deg` \[deg\],
    /// without a measured record.
    pub fn channel(self, condition: usize, turn_deg: Vec<f64>) -> Channel {
        // the steps are about a thousandth of the noise that a cycle of a record has: 0.12 kPa, a
        // micrometre, 0.12 N m
        let (name, title, unit, step) = match self {
            Self::Gauge(number) => (self.name(), format!("gauge {number}"), "MPa", -13),
            Self::Position => (self.name(), "rod position".to_owned(), "m", -20),
            Self::Torque => (self.name(), "crank torque".to_owned(), "N.m", -3),
        };
        Channel {
            limit: None,
            name,
            title,
            unit: unit.to_owned(),
            condition,
            abscissa: Abscissa {
                name: "crank".to_owned(),
                unit: "deg".to_owned(),
                points: turn_deg,
                period: Some(360.0),
            },
            noise: None,
            step: Some(step),
            weights: Vec::new(),
            offset: Offset::Free,
            record: None,
        }
    }

    /// Returns whether the sensor is a strain gauge.
    pub const fn is_gauge(self) -> bool {
        matches!(self, Self::Gauge(_))
    }

    /// Returns the name of the sensor's channel.
    pub fn name(self) -> String {
        match self {
            Self::Gauge(number) => format!("gauge_{number}"),
            Self::Position => "position".to_owned(),
            Self::Torque => "torque".to_owned(),
        }
    }

    /// Returns the sensor whose channel has the given name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sensor| sensor.name() == name)
    }

    /// Returns the number of the gauge whose channel has the given name.
    pub fn gauge(name: &str) -> Option<u8> {
        match Self::named(name)? {
            Self::Gauge(number) => Some(number),
            Self::Position | Self::Torque => None,
        }
    }
}
