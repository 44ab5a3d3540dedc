//! Conversion of a case's twin ropes for the simulation.
use super::head::{PASCAL_PER_MEGAPASCAL, curves};
use protocol::{
    job::Failure,
    pumping_unit::{Machine, TwinHead, TwinRopes},
};
use simulation::model::description::{AntisymmetricHead, Twins};

/// Returns the twin ropes, if the case has them.
///
/// # Errors
/// [`Failure::Misconfigured`] if the head's tables for twin ropes have other stations than the influence
/// lines, or hold too few modes.
pub(super) fn twins(machine: &Machine) -> Result<Option<Twins>, Failure> {
    let Some(twins) = &machine.twin_ropes else {
        return Ok(None);
    };
    check(machine, twins)?;
    Ok(Some(Twins {
        offset: twins.offset_m,
        longer: [
            twins.back_length_difference_m,
            twins.front_length_difference_m,
        ],
        sway: sway(&twins.head, twins.modes),
    }))
}

fn check(machine: &Machine, twins: &TwinRopes) -> Result<(), Failure> {
    let (head, modes) = (&twins.head, twins.modes);
    let available = [
        head.frequencies_hz.len(),
        head.radial.len(),
        head.tangential.len(),
        head.lateral.len(),
        head.gauge_stress_mpa.len(),
    ];
    let least = available.into_iter().min().unwrap_or(0);
    if modes > least {
        return Err(Failure::misconfigured(
            "twin_ropes.modes",
            format!("is {modes}; the head has {least} out of its plane"),
        ));
    }
    if head.influence.psi_deg != machine.modal_head.influence.psi_deg {
        return Err(Failure::misconfigured(
            "twin_ropes.head.influence.psi_deg",
            "has other stations than the influence lines of the plane".to_owned(),
        ));
    }
    Ok(())
}

fn sway(head: &TwinHead, modes: usize) -> AntisymmetricHead {
    AntisymmetricHead {
        frequencies: head.frequencies_hz[..modes]
            .iter()
            .map(|f| f * std::f64::consts::TAU)
            .collect(),
        radial: head.radial[..modes].to_vec(),
        tangential: head.tangential[..modes].to_vec(),
        lateral: head.lateral[..modes].to_vec(),
        gauge_stress: head.gauge_stress_mpa[..modes]
            .iter()
            .map(|row| row.map(|s| s * PASCAL_PER_MEGAPASCAL))
            .collect(),
        normal_influence: curves(&head.influence.normal_mpa_per_n),
        tangential_influence: curves(&head.influence.tangential_mpa_per_n),
        lateral_influence: curves(&head.lateral_mpa_per_n),
    }
}
