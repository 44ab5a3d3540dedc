//! Settings of a case that only the oscillator reads; they are transmitted as uninterpreted text.
use serde::Deserialize;

/// Oscillator settings of a case, apart from unknowns, channels and records.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Settings in `[model]` apart from its kind.
    pub model: RigSettings,
    /// Settings in `[[conditions]]` apart from their names, in the case's order.
    pub conditions: Vec<Excitation>,
}

/// Settings of the oscillator that hold under all conditions.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigSettings {
    /// Displacement at which the oscillator's mass would strike the stop, which ends a simulation \[mm\].
    pub stop_mm: f64,
}

/// Excitation of the mass under one condition: a shaker, or a release from a displacement.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Frequency of the shaker's first harmonic \[Hz\]; none where the mass is released.
    pub drive_hz: Option<f64>,
    /// Harmonics of the shaker's force.
    #[serde(default)]
    pub drive: Vec<Order>,
    /// Displacement from which the mass is released \[mm\].
    #[serde(default)]
    pub release_mm: f64,
}

/// Harmonic of the shaker's force.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// Order of the harmonic: number of periods per turn of the shaker.
    pub order: u32,
    /// Amplitude of the harmonic of the shaker's force \[N\].
    pub amplitude_n: f64,
    /// Phase lead of the harmonic, in degrees of its own period \[deg\].
    pub phase_deg: f64,
}

impl Settings {
    /// Parses the oscillator's settings from the text in a case.
    ///
    /// # Errors
    /// A message that says which field is wrong.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let text = std::str::from_utf8(bytes).map_err(|_| "is not valid UTF-8 text".to_owned())?;
        let read: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        let turns = |hz: f64| hz > 0.0 && hz.is_finite();
        match read
            .conditions
            .iter()
            .position(|c| !c.drive_hz.is_none_or(turns))
        {
            Some(at) => Err(format!("conditions[{at}].drive_hz must be above 0")),
            None => Ok(read),
        }
    }
}
