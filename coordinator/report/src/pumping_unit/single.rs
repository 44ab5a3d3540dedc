//! Tables of one simulation of the machine.
use crate::data::SingleRun;
use crate::document::{Row, Table};
use crate::number::{MISSING, fixed, range, significant};
use crate::table::{self, agreement, range_row, value_row, value_table, work};
use protocol::pumping_unit::{Energy, Simulation};

/// Builds the table with the verdict of a simulation and the range of every curve.
pub fn simulation(run: &SingleRun, simulation: &Simulation) -> Table {
    let mut rows = vec![Row::group("Stress")];
    for (gauge, values) in (1..).zip(&simulation.gauge_mpa) {
        rows.push(range_row(&format!("gauge {gauge}"), values, 1.0, "MPa"));
    }
    rows.push(Row::group("Machine"));
    let curves: [(&str, &[f64], f64, &str); 6] = [
        (
            "back rope tension",
            &simulation.back_rope_tension_n,
            1e-3,
            "kN",
        ),
        (
            "front rope tension",
            &simulation.front_rope_tension_n,
            1e-3,
            "kN",
        ),
        ("beam angle", &simulation.beam_deg, 1.0, "deg"),
        ("suspension height", &simulation.suspension_m, 1.0, "m"),
        (
            "suspension acceleration",
            &simulation.suspension_acceleration_m_s2,
            1.0,
            "m/s²",
        ),
        (
            "net crank torque",
            &simulation.crank_torque_n_m,
            1e-3,
            "kN m",
        ),
    ];
    for (label, values, factor, unit) in curves {
        rows.push(range_row(label, values, factor, unit));
    }
    table::simulation(run, rows)
}

/// Builds the table of stroke, agreement with the measured record, energy balance and solver work of a
/// simulation.
pub fn balance(run: &SingleRun, simulation: &Simulation) -> Table {
    let mut rows = Vec::new();
    let stroke = range(simulation.suspension_m.iter().copied())
        .map_or_else(|| MISSING.to_owned(), |(low, high)| fixed(high - low, 3));
    rows.push(value_row("stroke", "m", stroke));
    rows.extend(agreement(run));
    rows.extend(energy(&simulation.energy));
    rows.extend(work(&simulation.counters, simulation.wall_s));
    value_table("Stroke, agreement, energy and work", rows).with_notes([
        "Error of the balance: what it leaves over, relative to the larger of input and \
             output work.",
    ])
}

fn energy(energy: &Energy) -> Vec<Row> {
    let joules = |value: f64| fixed(1e-3 * value, 2);
    vec![
        Row::group("Energy of the revolution"),
        value_row("work of the crank pin", "kJ", joules(energy.input_j)),
        value_row("work on the load", "kJ", joules(energy.output_j)),
        value_row("dissipated", "kJ", joules(energy.dissipated_j)),
        value_row("stored", "kJ", joules(energy.stored_j)),
        value_row(
            "error of the balance",
            "",
            significant(energy.relative_error),
        ),
    ]
}
