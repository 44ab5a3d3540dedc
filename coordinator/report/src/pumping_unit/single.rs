//! Tables of one simulation of the machine.
use crate::data::SingleRun;
use crate::document::{Row, Table};
use crate::number::{NONE, figure, fixed, range};
use crate::table::{self, agreement, one, range_row, sums, work};
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

/// Builds the table of stroke, agreement with the record, energy balance and solver work of a run.
pub fn balance(run: &SingleRun, simulation: &Simulation) -> Table {
    let mut rows = Vec::new();
    let stroke = range(simulation.suspension_m.iter().copied())
        .map_or_else(|| NONE.to_owned(), |(low, high)| fixed(high - low, 3));
    rows.push(one("stroke", "m", stroke));
    rows.extend(agreement(run));
    rows.extend(energy(&simulation.energy));
    rows.extend(work(&simulation.counters, simulation.wall_s));
    sums("Stroke, agreement, energy and work", rows).noted([
        "Error of the balance: what it leaves over, relative to the larger of input and \
             output work.",
    ])
}

fn energy(energy: &Energy) -> Vec<Row> {
    let joules = |value: f64| fixed(1e-3 * value, 2);
    vec![
        Row::group("Energy of the revolution"),
        one("work of the crank pin", "kJ", joules(energy.input_j)),
        one("work on the load", "kJ", joules(energy.output_j)),
        one("dissipated", "kJ", joules(energy.dissipated_j)),
        one("stored", "kJ", joules(energy.stored_j)),
        one("error of the balance", "", figure(energy.relative_error)),
    ]
}
