//! Case folder of the oscillator with synthetic records, in which values and effects are hidden.
use crate::{
    effect::Effects,
    record::Measurement,
    settings::{Excitation, Order, RigSettings},
    simulate::{Sensor, Values, run},
};
use std::{fs, io, path::Path};

/// True values of the unknowns in the records.
pub const HIDDEN: Values = Values {
    mass_kg: 2.13,
    armature_kg: 0.4,
    left_n_per_mm: 5.62,
    right_n_per_mm: 5.62,
    damping_n_s_per_m: 26.4,
    lead_deg: 1.7,
    crosstalk_mm_per_n: 0.0,
};
/// True dry friction in the records, absent from the case \[N\].
pub const FRICTION_N: f64 = 2.4;
/// True crosstalk of the force into the displacement reading \[mm/N\].
pub const CROSSTALK: f64 = 4e-3;
/// Standard deviation of the noise of the displacement \[mm\].
pub const NOISE_MM: f64 = 0.02;
/// Standard deviation of the noise of the force \[N\].
pub const NOISE_N: f64 = 0.2;

/// Writes the case into the folder, with records of the given values and effects; `noise` is the seed of their noise.
///
/// # Errors
/// If a file cannot be written.
///
/// # Panics
/// If a simulation with these values fails.
pub fn write(folder: &Path, values: &Values, effects: &Effects, noise: u64) -> io::Result<()> {
    fs::create_dir_all(folder.join("measured"))?;
    fs::write(folder.join("case.toml"), include_str!("../case/case.toml"))?;
    let order = |order, amplitude_n, phase_deg| Order {
        order,
        amplitude_n,
        phase_deg,
    };
    let drive = [
        order(1, 45.0, 0.0),
        order(3, 12.0, 40.0),
        order(5, 6.0, -70.0),
    ];
    let driven = |hz, orders: &[Order]| Excitation {
        drive_hz: Some(hz),
        drive: orders.to_vec(),
        release_mm: 0.0,
    };
    let released = Excitation {
        drive_hz: None,
        drive: Vec::new(),
        release_mm: 6.0,
    };
    let turn: Vec<f64> = (0..120).map(|at| 3.0 * f64::from(at)).collect();
    let time: Vec<f64> = (0..150).map(|at| f64::from(at) / 200.0).collect();
    for (name, by, places) in [
        ("steady_5hz", driven(5.0, &drive), ("phase_deg", &turn[..])),
        (
            "steady_7hz",
            driven(7.0, &drive[..2]),
            ("phase_deg", &turn[..]),
        ),
        ("release", released, ("time_s", &time[..])),
    ] {
        let table = measured(name, &by, (values, effects, noise), places);
        fs::write(folder.join(format!("measured/{name}.csv")), table)?;
    }
    Ok(())
}

/// Simulates a condition and returns its record with noise, as a table.
fn measured(
    name: &str,
    by: &Excitation,
    (values, effects, noise): (&Values, &Effects, u64),
    places: (&str, &[f64]),
) -> String {
    let sensors = [(Sensor::Displacement, places.1), (Sensor::Force, places.1)];
    let stop = RigSettings { stop_mm: 40.0 };
    let seen = run(&stop, by, values, effects, &sensors);
    assert_eq!(
        seen.failed, None,
        "the records of {name} cannot be simulated"
    );
    let mut curves = seen.curves.into_iter();
    let mut curve = || curves.next().unwrap_or_default();
    let channels = [
        ("displacement_mm", curve(), NOISE_MM),
        ("force_n", curve(), NOISE_N),
    ];
    let measurement = Measurement {
        places,
        channels: &channels,
        repeats: 8,
    };
    let condition: u64 = name.bytes().map(u64::from).sum();
    measurement.table(condition + 10_000 * noise)
}
