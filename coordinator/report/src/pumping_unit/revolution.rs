//! Figures of one simulation over the crank angle: gauges, rope tensions, motion of the suspension point,
//! crank torque.
use crate::chart::scale::AxisScale;
use crate::chart::strip::{StripCurve, curve, span, stack, strip};
use crate::chart::{ChartAxis, strips};
use crate::color::{BLUE, GREEN, INK, PURPLE, VERMILLION};
use crate::data::SimulationView;
use crate::document::Figure;
use crate::words::condition_name;
use case::{ModelKind as _, kind::PumpingUnitModel};
use protocol::case::Case;
use protocol::pumping_unit::{Sensor, Simulation};

/// Returns the axis of all curves: one revolution of the crank.
pub(super) fn axis() -> ChartAxis {
    ChartAxis {
        scale: AxisScale::turn(),
        title: format!("crank angle{} [deg]", PumpingUnitModel.abscissa_origin()),
    }
}

/// Draws the stress at all four gauges, with the measured mean and its spread where there is a record.
pub(super) fn gauges(of: &SimulationView<'_>) -> Figure {
    let name = condition_name(of.case, of.condition);
    stack(
        format!("gauges_{name}"),
        &format!("Stress at the gauges, condition {name}"),
        format!(
            "Stress at the four gauges under condition {name}, absolute values: no curve is \
             shifted here."
        ),
        &axis(),
        &strips(of, |channel| Sensor::gauge(&channel.name).is_some()),
    )
}

/// Returns the tension curves of both ropes \[kN\].
fn tensions(simulation: &Simulation) -> Vec<StripCurve> {
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

/// Draws the axial force of both ropes at their free ends.
pub(super) fn tension(simulation: &Simulation) -> Figure {
    let strips = [strip("tension [kN]", 150.0, tensions(simulation))];
    stack(
        "rope_tension",
        "Rope tension",
        "Axial force in the back rope at the crossbeam and in the front rope at the suspension."
            .to_owned(),
        &axis(),
        &strips,
    )
}

/// Draws position, velocity and acceleration of the suspension point.
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
        &axis(),
        &strips,
    )
}

/// Draws the net torque at the crank shaft.
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
        &axis(),
        &strips,
    )
}

/// Draws the curves shown next to the animated machine, and returns the extent of their plot area: left,
/// right, upper and lower end as shares of the figure's width and height.
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
        &axis(),
        &strips,
    );
    (figure, span(&strips))
}
