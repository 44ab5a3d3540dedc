//! Units of the parameters of effects that may be added to the model of a pumping unit.

/// Symbols of all units that a parameter of a pumping unit's effect may have; the effect defines which
/// applies.
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
