//! Test record as delivered files: load cards, samples and data sheets by condition.
use crate::law::Tolerance;
use crate::measuring_chain::{Sample, Sensors};
use anyhow::{Context as _, ensure};
use flate2::{Compression, write::GzEncoder};
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display, Formatter, Write as _};
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// Channels that are recorded in addition to angle and load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Channels {
    /// Whether each of gauges 1 to 4 is recorded.
    pub gauges: [bool; 4],
    /// Whether position and torque are recorded.
    pub others: bool,
}

impl Default for Channels {
    fn default() -> Self {
        Self {
            gauges: [true; 4],
            others: true,
        }
    }
}

impl Channels {
    /// Gauges 1 and 3 only, as in the paper.
    pub const TWO: Self = Self {
        gauges: [true, false, true, false],
        others: false,
    };

    /// Returns these channels with only the given gauges.
    ///
    /// # Errors
    /// If no gauge is given, or a number is not in 1 to 4.
    pub fn with_gauges(self, numbers: &[usize]) -> anyhow::Result<Self> {
        let known = numbers.iter().all(|number| (1..=4).contains(number));
        ensure!(
            known && !numbers.is_empty(),
            "gauge numbers must be between 1 and 4, and at least one gauge must be given"
        );
        Ok(Self {
            gauges: [1, 2, 3, 4].map(|gauge| numbers.contains(&gauge)),
            ..self
        })
    }

    /// Returns the zero-based indices of the recorded gauges.
    fn gauges(self) -> impl Iterator<Item = usize> {
        (0..4).filter(move |k| self.gauges[*k])
    }
}

impl Display for Channels {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for gauge in self.gauges() {
            write!(f, "{}", gauge + 1)?;
        }
        f.write_str(if self.others { "+" } else { "" })
    }
}

/// Data delivered for one condition.
#[derive(Clone, Debug)]
pub struct Delivered<'a> {
    /// Name of the condition, for example `5rpm`.
    pub condition: &'a str,
    /// Crank speed [1/min].
    pub rpm: f64,
    /// Approximate number of crank revolutions (cycles) in the record.
    pub cycles: usize,
    /// Delivered load card: load at the suspension over one crank turn, at equally spaced angles \[N\].
    pub card: &'a [f64],
    /// Samples of the test record that the wireless link delivered.
    pub samples: &'a [Sample],
    /// Number of samples that the wireless link lost.
    pub lost: usize,
    /// Channels recorded in addition to angle and load.
    pub channels: Channels,
}

/// Writes `card_C.csv`, `test_C.csv.gz` and `test_C.toml` of condition C into a folder.
///
/// # Errors
/// If a file cannot be written.
pub fn write(
    folder: &Path,
    name: &str,
    (sensors, tolerance): (&Sensors, &Tolerance),
    delivered: &Delivered<'_>,
) -> anyhow::Result<()> {
    let condition = delivered.condition;
    let put = |file: String, content: &[u8]| {
        let path = folder.join(file);
        fs::write(&path, content).with_context(|| format!("writing {}", path.display()))
    };
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    let lines = samples(delivered.samples, delivered.channels)?;
    encoder.write_all(lines.as_bytes())?;
    put(format!("test_{condition}.csv.gz"), &encoder.finish()?)?;
    put(
        format!("card_{condition}.csv"),
        card(delivered.card)?.as_bytes(),
    )?;
    let sheet = sheet(name, sensors, delivered) + &tolerance_table(tolerance)?;
    put(format!("test_{condition}.toml"), sheet.as_bytes())
}

fn samples(samples: &[Sample], channels: Channels) -> Result<String, fmt::Error> {
    let mut text = "time_s,crank_deg".to_owned();
    for gauge in channels.gauges() {
        write!(text, ",stress_{}_mpa", gauge + 1)?;
    }
    text.push_str(",polished_rod_load_n");
    if channels.others {
        text.push_str(",polished_rod_position_m,crank_torque_nm");
    }
    text.push('\n');
    for s in samples {
        // to tenths of a degree; it never reads 360
        let crank = (10.0 * s.crank).round().rem_euclid(3600.0) / 10.0;
        write!(text, "{:.2},{crank:.1}", s.time)?;
        for gauge in channels.gauges() {
            write!(text, ",{:.3}", s.stress[gauge])?;
        }
        let tens = |value: f64| 10.0 * (0.1 * value).round();
        write!(text, ",{:.0}", tens(s.load))?;
        if channels.others {
            write!(text, ",{:.3},{:.0}", s.position, tens(s.torque))?;
        }
        text.push('\n');
    }
    Ok(text)
}

fn card(load: &[f64]) -> Result<String, fmt::Error> {
    let mut text = "turn_deg,polished_rod_load_n\n".to_owned();
    let step = 360.0 / load.len() as f64;
    for (i, load) in load.iter().enumerate() {
        writeln!(text, "{:.1},{load:.0}", step * i as f64)?;
    }
    Ok(text)
}

fn sheet(name: &str, sensors: &Sensors, delivered: &Delivered<'_>) -> String {
    let Delivered {
        condition,
        rpm,
        cycles,
        samples,
        lost,
        ..
    } = delivered;
    let recorded = samples.len();
    let Sensors {
        rate,
        gauge_noise,
        correlation,
        resolution,
        position_torque_noise: [position, torque],
        cycle_spread: [load, _],
        ..
    } = sensors;
    let others = if delivered.channels.others {
        format!(
            "[position]
noise_rms_m = {position}
[torque]
noise_rms_nm = {torque}
meaning = \"net torque at the crank shaft including counterweight\"

"
        )
    } else {
        String::new()
    };
    format!(
        "# test record
name = \"{name}\"
strokes_per_minute = {rpm:.1}
revolutions = {cycles}
sample_rate_hz = {rate:.1}
samples_recorded = {recorded}
samples_lost = {lost}

[crank]
zero = \"bottom dead centre of the design kinematics\"
sense = \"clockwise\"
angle_resolution_deg = 0.1
index_pulses_per_revolution = 1
index_tolerance_deg = 0.2
between_pulses = \"uniform in time\"

[gauges]
unit = \"MPa\"
resolution_mpa = {resolution}
noise_rms_mpa = {gauge_noise}
noise_correlation_per_sample = {correlation}
elastic_modulus_gpa = 206
zero = \"unloaded rope\"

[load]
file = \"card_{condition}.csv\"
channel = \"polished_rod_load_n replays the dynamometer card of a separate session at the same \
speed; it is not a simultaneous measurement\"
cycle_to_cycle_variation = {load}

{others}"
    )
}

/// Formats the stated instrument tolerances as the `[tolerance]` table of the data sheet.
fn tolerance_table(tolerance: &Tolerance) -> anyhow::Result<String> {
    let keys = toml::to_string(tolerance)?;
    Ok(format!(
        "[tolerance]  # one standard deviation, constant over the test\n{keys}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_recorded_has_no_column() {
        let sample = Sample {
            time: 0.01,
            crank: 0.3,
            stress: [1.0, 2.0, 3.0, 4.0],
            load: 50_004.0,
            position: 0.5,
            torque: 12.0,
        };
        let whole = samples(&[sample], Channels::default()).unwrap();
        assert!(whole.ends_with("0.01,0.3,1.000,2.000,3.000,4.000,50000,0.500,10\n"));
        let two = samples(&[sample], Channels::TWO).unwrap();
        let expected = "time_s,crank_deg,stress_1_mpa,stress_3_mpa,polished_rod_load_n\n\
                        0.01,0.3,1.000,3.000,50000\n";
        assert_eq!(two, expected);
        assert_eq!(Channels::TWO.to_string(), "13");
        Channels::TWO.with_gauges(&[5]).unwrap_err();
        Channels::TWO.with_gauges(&[]).unwrap_err();
    }

    #[test]
    fn a_sheet_states_how_good_the_instruments_are() {
        let text = tolerance_table(&Tolerance::USUAL).unwrap();
        let read: toml::Table = toml::from_str(&text).unwrap();
        assert_eq!(read["tolerance"]["balance_nm"].as_float(), Some(200.0));
        assert_eq!(read["tolerance"].as_table().map(toml::Table::len), Some(8));
    }
}
