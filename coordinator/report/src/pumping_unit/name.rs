//! Names of what only this machine and its model have, as people call them.
use protocol::pumping_unit::{Integrator, ModeFamily};

/// A family of modes.
pub const fn mode_family(family: ModeFamily) -> &'static str {
    match family {
        ModeFamily::Symmetric => "symmetric",
        ModeFamily::Antisymmetric => "antisymmetric",
    }
}

/// A method of integration, as people call it.
pub const fn integrator_name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::TrBdf2 => "TR-BDF2",
        Integrator::Esdirk4 => "ESDIRK4",
        Integrator::Rodas4 => "RODAS4",
        Integrator::GeneralizedAlpha => "generalised-alpha",
        Integrator::Bdf => "BDF, order ≤ 2",
        Integrator::Bdf5 => "BDF, order ≤ 5",
    }
}
