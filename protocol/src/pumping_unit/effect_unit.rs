//! Units of the machine's effects.

/// Units that parameters of effects may have, as written; what they measure is the effect's
/// business.
pub const EFFECT_UNITS: [&str; 19] = [
    "1",
    "m",
    "s",
    "deg",
    "N",
    "N.m",
    "N.s/m",
    "N.m.s/rad",
    "m/N",
    "m/s",
    "rad/s",
    "Hz",
    "1/s",
    "kg",
    "kg.m2",
    "MPa",
    "MPa/rev",
    "MPa/m",
    "N/kg^0.5",
];
