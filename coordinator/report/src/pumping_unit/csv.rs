//! CSV files with the data behind the figures; units are part of the column names.
//!
//! An empty field is a missing value; numbers have full precision.
use crate::data::SimulationView;
use crate::number::field;
use crate::words::condition_name;
use protocol::{
    case::{Case, Channel},
    pumping_unit::{Machine, Sensor, Simulation},
};
use std::io::Write;

const CURVE_COLUMNS: [&str; 22] = [
    "condition",
    "parameters",
    "turn_deg",
    "measured_1_mpa",
    "measured_2_mpa",
    "measured_3_mpa",
    "measured_4_mpa",
    "spread_1_mpa",
    "spread_2_mpa",
    "spread_3_mpa",
    "spread_4_mpa",
    "simulated_1_mpa",
    "simulated_2_mpa",
    "simulated_3_mpa",
    "simulated_4_mpa",
    "back_rope_tension_n",
    "front_rope_tension_n",
    "beam_deg",
    "suspension_m",
    "suspension_velocity_m_s",
    "suspension_acceleration_m_s2",
    "crank_torque_n_m",
];

/// Returns the number of modes of the back head that a case includes in its simulation.
fn modes(case: &Case) -> usize {
    Machine::of(case).map_or(0, |machine| machine.run.modes)
}

/// Returns the column names of the curves, followed by one column per simulated, mass-normalised mode of the
/// back head.
fn head(modes: usize) -> impl Iterator<Item = String> {
    let modes = (1..=modes).map(|mode| format!("mode_{mode}_sqrt_kg_m"));
    CURVE_COLUMNS.map(str::to_owned).into_iter().chain(modes)
}

/// Writes the curves of named parameter sets of one case: one row per crank angle and parameter set. Rows
/// have measured values where the crank angle is on the record's grid; a failed simulation has rows up to the
/// failure.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub fn curves(to: impl Write, runs: &[(&str, SimulationView<'_>)]) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    let modes = runs.first().map_or(0, |(_, first)| modes(first.case));
    writer.write_record(head(modes))?;
    for (parameters, run) in runs {
        rows((&mut writer, modes), parameters, run)?;
    }
    Ok(writer.flush()?)
}

fn rows(
    (writer, modes): (&mut csv::Writer<impl Write>, usize),
    parameters: &str,
    &SimulationView {
        case,
        condition,
        curves,
    }: &SimulationView<'_>,
) -> Result<(), csv::Error> {
    let Ok(simulation) = Simulation::of(curves) else {
        return Ok(());
    };
    let name = condition_name(case, condition);
    let measured: Vec<_> = case.measured(condition).collect();
    for (index, &turn) in simulation.turn_deg.iter().enumerate() {
        let value = |sensor: Sensor, spread: bool| {
            let name = sensor.name();
            let mut measured = measured.iter();
            let (_, channel, record) = measured.find(|(_, channel, _)| channel.name == name)?;
            let values = if spread { &record.spread } else { &record.mean };
            values.get(on_grid(channel, turn)?).copied()
        };
        let gauges = || (1..=4).map(Sensor::Gauge);
        let mut fields = vec![name.clone(), parameters.to_owned(), field(Some(turn))];
        fields.extend(gauges().map(|gauge| field(value(gauge, false))));
        fields.extend(gauges().map(|gauge| field(value(gauge, true))));
        let [first, second, third, fourth] = &simulation.gauge_mpa;
        let curves = [
            first,
            second,
            third,
            fourth,
            &simulation.back_rope_tension_n,
            &simulation.front_rope_tension_n,
            &simulation.beam_deg,
            &simulation.suspension_m,
            &simulation.suspension_velocity_m_s,
            &simulation.suspension_acceleration_m_s2,
            &simulation.crank_torque_n_m,
        ];
        fields.extend(curves.map(|curve| field(curve.get(index).copied())));
        let value = |mode: usize| simulation.modal.get(mode)?.get(index).copied();
        fields.extend((0..modes).map(|mode| field(value(mode))));
        writer.write_record(fields)?;
    }
    Ok(())
}

/// Writes position, tension and contact force of every cylinder at each snapshot of a simulation, from the
/// free ends of the ropes on.
///
/// # Errors
/// [`csv::Error`] when the writer fails.
pub fn ropes(to: impl Write, simulation: &Simulation) -> Result<(), csv::Error> {
    let mut writer = csv::Writer::from_writer(to);
    let columns = [
        "turn_deg",
        "rope",
        "cylinder",
        "x_m",
        "y_m",
        "tension_n",
        "contact_n",
    ];
    writer.write_record(columns)?;
    for motion in &simulation.motion {
        let back = motion.back_rope_m.iter();
        let back = back.zip(motion.back_tension_n.iter().zip(&motion.back_contact_n));
        let front = motion.front_rope_m.iter();
        let front = front.zip(motion.front_tension_n.iter().zip(&motion.front_contact_n));
        for (rope, cylinders) in [("back", back), ("front", front)] {
            for (number, ([x, y], (tension, contact))) in (1_u32..).zip(cylinders) {
                let mut fields = vec![
                    field(Some(motion.turn_deg)),
                    rope.to_owned(),
                    number.to_string(),
                ];
                let values = [x, y, tension, contact];
                fields.extend(values.map(|value| field(Some(f64::from(*value)))));
                writer.write_record(fields)?;
            }
        }
    }
    Ok(writer.flush()?)
}

/// Returns the index of the channel's grid point at a crank angle, if there is one within 1e-6 deg.
fn on_grid(channel: &Channel, turn_deg: f64) -> Option<usize> {
    const SAME_DEG: f64 = 1e-6;
    let grid = &channel.abscissa.points;
    let row = grid.partition_point(|&known| known < turn_deg - SAME_DEG);
    ((grid.get(row)? - turn_deg).abs() <= SAME_DEG).then_some(row)
}
