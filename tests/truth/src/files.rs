//! A test record as a delivered folder: load cards, samples and data sheets by condition.
use crate::chain::{Sample, Sensors};
use anyhow::Context as _;
use flate2::{Compression, write::GzEncoder};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// What is delivered of one condition.
#[derive(Clone, Debug)]
pub struct Delivered<'a> {
    /// Name of the condition, as `5rpm`.
    pub condition: &'a str,
    /// Crank speed [1/min].
    pub rpm: f64,
    /// Cycles, about.
    pub cycles: usize,
    /// Load over one turn, equally spaced \[N\].
    pub card: &'a [f64],
    /// Samples that arrived.
    pub samples: &'a [Sample],
    /// Samples that did not.
    pub lost: usize,
}

/// Writes `card_C.csv`, `test_C.csv.gz` and `test_C.toml` into a folder.
///
/// # Errors
/// What the file system refuses.
pub fn write(
    folder: &Path,
    name: &str,
    sensors: &Sensors,
    delivered: &Delivered<'_>,
) -> anyhow::Result<()> {
    let condition = delivered.condition;
    let put = |file: String, content: &[u8]| {
        let path = folder.join(file);
        fs::write(&path, content).with_context(|| format!("writing {}", path.display()))
    };
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(samples(delivered.samples)?.as_bytes())?;
    put(format!("test_{condition}.csv.gz"), &encoder.finish()?)?;
    put(
        format!("card_{condition}.csv"),
        card(delivered.card)?.as_bytes(),
    )?;
    let sheet = sheet(name, sensors, delivered);
    put(format!("test_{condition}.toml"), sheet.as_bytes())
}

fn samples(samples: &[Sample]) -> Result<String, std::fmt::Error> {
    let mut text = "time_s,crank_deg,stress_1_mpa,stress_2_mpa,stress_3_mpa,stress_4_mpa,\
                    polished_rod_load_n,polished_rod_position_m,crank_torque_nm\n"
        .to_owned();
    for s in samples {
        // to tenths of a degree; it never reads 360
        let crank = (10.0 * s.crank).round().rem_euclid(3600.0) / 10.0;
        write!(text, "{:.2},{crank:.1}", s.time)?;
        for stress in s.stress {
            write!(text, ",{stress:.3}")?;
        }
        let tens = |value: f64| 10.0 * (0.1 * value).round();
        let (load, torque) = (tens(s.load), tens(s.torque));
        writeln!(text, ",{load:.0},{:.3},{torque:.0}", s.position)?;
    }
    Ok(text)
}

fn card(load: &[f64]) -> Result<String, std::fmt::Error> {
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
        others: [position, torque],
        cycles: [load, _],
        ..
    } = sensors;
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

[position]
noise_rms_m = {position}
[torque]
noise_rms_nm = {torque}
meaning = \"net torque at the crank shaft including counterweight\"

[tolerance]  # the instruments of this record are exact but for their noise
gauge_factor = 0
index_deg = 0
load_cell = 0
amplifier_lag_s = 0
position = 0
torque = 0
bearing_friction_nm = 0
balance_nm = 0
"
    )
}
