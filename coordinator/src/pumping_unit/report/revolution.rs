//! The curves of one simulation over the crank angle: gauges, rope tensions, motion of the
//! suspension, crank torque.
use crate::report::chart::strip::{Curve, Strip, curve, span, stack, strip};
use crate::report::color::{BLUE, GREEN, INK, PURPLE, VERMILLION};
use crate::report::document::Figure;
use crate::report::words::condition_name;
use protocol::case::Case;
use protocol::pumping_unit::{Sensor, Simulation};

/// Stress at all four gauges, with the measured mean and its spread where there is a record.
pub(super) fn gauges(case: &Case, condition: usize, simulation: &Simulation) -> Figure {
    let name = condition_name(case, condition);
    let measured: Vec<_> = case.measured(condition).collect();
    let strips: Vec<_> = (1_u8..)
        .zip(&simulation.gauge_mpa)
        .map(|(gauge, stress)| {
            let named = Sensor::Gauge(gauge).name();
            let found = measured
                .iter()
                .find(|(_, channel, _)| channel.name == named);
            let label = if found.is_some() {
                "simulated".to_owned()
            } else {
                format!("gauge {gauge}")
            };
            let mut curves = vec![curve(label, VERMILLION, &simulation.turn_deg, stress, 1.0)];
            let mut band = Vec::new();
            if let Some((_, channel, record)) = found {
                let grid = &channel.abscissa.points;
                curves.insert(0, curve("measured", INK, grid, &record.mean, 1.0));
                let rows = record.mean.iter().zip(&record.spread);
                let rows = grid.iter().zip(rows);
                band = rows
                    .map(|(&x, (&mean, &spread))| (x, mean - spread, mean + spread))
                    .collect();
            }
            Strip {
                title: [
                    "gauge 1 [MPa]",
                    "gauge 2 [MPa]",
                    "gauge 3 [MPa]",
                    "gauge 4 [MPa]",
                ][usize::from(gauge - 1)],
                height: 96.0,
                curves,
                band,
                scale: None,
            }
        })
        .collect();
    stack(
        format!("gauges_{name}"),
        &format!("Stress at the gauges, condition {name}"),
        format!(
            "Stress at the four gauges under condition {name}, absolute values: no curve is \
             shifted here."
        ),
        &strips,
    )
}

/// Tension of both ropes \[kN\].
fn tensions(simulation: &Simulation) -> Vec<Curve> {
    let turn = &simulation.turn_deg;
    let (back, front) = (
        &simulation.back_rope_tension_n,
        &simulation.front_rope_tension_n,
    );
    vec![
        curve("back rope", BLUE, turn, back, 1e-3),
        curve("front rope", GREEN, turn, front, 1e-3),
    ]
}

/// Axial force of both ropes at their free ends.
pub(super) fn tension(simulation: &Simulation) -> Figure {
    let strips = [strip("tension [kN]", 150.0, tensions(simulation))];
    stack(
        "rope_tension",
        "Rope tension",
        "Axial force in the back rope at the crossbeam and in the front rope at the suspension."
            .to_owned(),
        &strips,
    )
}

/// Motion of the suspension point.
pub(super) fn motion(simulation: &Simulation) -> Figure {
    let turn = &simulation.turn_deg;
    let strips = [
        strip(
            "height [m]",
            84.0,
            vec![curve("position", INK, turn, &simulation.suspension_m, 1.0)],
        ),
        strip(
            "velocity [m/s]",
            84.0,
            vec![curve(
                "velocity",
                INK,
                turn,
                &simulation.suspension_velocity_m_s,
                1.0,
            )],
        ),
        strip(
            "acceler. [m/s²]",
            84.0,
            vec![curve(
                "acceleration",
                INK,
                turn,
                &simulation.suspension_acceleration_m_s2,
                1.0,
            )],
        ),
    ];
    stack(
        "suspension",
        "Motion of the suspension point",
        "Position above the lowest design position, velocity and acceleration of the suspension \
         point, upwards positive."
            .to_owned(),
        &strips,
    )
}

/// Net torque at the crank shaft.
pub(super) fn torque(simulation: &Simulation) -> Figure {
    let strips = [strip(
        "torque [kN m]",
        130.0,
        vec![curve(
            "net torque",
            PURPLE,
            &simulation.turn_deg,
            &simulation.crank_torque_n_m,
            1e-3,
        )],
    )];
    stack(
        "crank_torque",
        "Crank torque",
        "Net torque at the crank shaft, counterweight included; below zero the machine drives the \
         gear."
            .to_owned(),
        &strips,
    )
}

/// The strips beside the moving machine, and where their crank axis lies: left, right, upper and
/// lower end as shares of the figure's width and height.
pub(super) fn player(case: &Case, simulation: &Simulation) -> (Figure, [f64; 4]) {
    let turn = &simulation.turn_deg;
    let colors = [VERMILLION, INK, GREEN, PURPLE];
    let stress = case
        .objective
        .terms
        .iter()
        .filter_map(|term| {
            let gauge = Sensor::gauge(&term.channel)?;
            let index = usize::from(gauge) - 1;
            let values = &simulation.gauge_mpa[index];
            let label = format!("gauge {gauge}");
            Some(curve(label, colors[index], turn, values, 1.0))
        })
        .collect();
    let strips = [
        strip("stress [MPa]", 104.0, stress),
        strip("tension [kN]", 84.0, tensions(simulation)),
        strip(
            "torque [kN m]",
            84.0,
            vec![curve(
                "crank",
                PURPLE,
                turn,
                &simulation.crank_torque_n_m,
                1e-3,
            )],
        ),
    ];
    let figure = stack(
        "player",
        "Curves beside the moving machine",
        "Simulated stress, rope tension and crank torque; the vertical line follows the machine."
            .to_owned(),
        &strips,
    );
    (figure, span(&strips))
}
