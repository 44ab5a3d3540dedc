//! Units of the parameters of the pumping unit's effects.

/// Symbols of all units that parameters of effects may have; each effect defines its quantity itself.
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
