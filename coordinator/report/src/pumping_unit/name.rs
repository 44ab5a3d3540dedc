//! Display names of mode families and integrators.
use protocol::pumping_unit::{Integrator, ModeFamily};

/// Returns the display name of a mode family.
pub const fn mode_family(family: ModeFamily) -> &'static str {
    match family {
        ModeFamily::Symmetric => "symmetric",
        ModeFamily::Antisymmetric => "antisymmetric",
    }
}

/// Returns the display name of an integrator.
pub const fn integrator_name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::TrBdf2 => "TR-BDF2",
        Integrator::Esdirk4 => "ESDIRK4",
    }
}
