//! What a case says to the oscillator alone, as it travels: text that nobody on the way understands.
use serde::Deserialize;

/// Everything beside unknowns, channels and records.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// What `[model]` says beside its kind.
    pub model: Rig,
    /// What `[[conditions]]` say beside their names, in the case's order.
    pub conditions: Vec<Excitation>,
}

/// The rig.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rig {
    /// Displacement at which the mass would strike the stop \[mm\].
    pub stop_mm: f64,
}

/// What moves the mass under one condition: a shaker, or a hand that lets it go.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Frequency of the shaker's first order \[Hz\]; none where the mass is let go.
    pub drive_hz: Option<f64>,
    /// Orders of the shaker's force.
    #[serde(default)]
    pub drive: Vec<Order>,
    /// Displacement from which the mass is let go \[mm\].
    #[serde(default)]
    pub release_mm: f64,
}

/// One order of the shaker's force.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// How many times a turn.
    pub order: u32,
    /// Amplitude \[N\].
    pub amplitude_n: f64,
    /// Lead over the shaker's zero, in its own turns \[deg\].
    pub phase_deg: f64,
}

impl Settings {
    /// Reads them.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn read(bytes: &[u8]) -> Result<Self, String> {
        let text = std::str::from_utf8(bytes).map_err(|_| "is no text".to_owned())?;
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
