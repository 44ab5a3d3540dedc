//! Effect library that the stand-in machine announces: named effects and generic forces.
use crate::case::{effect, size};
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Place, Role, Sign};

/// Joints of the stand-in machine at which a probe force (without physical cause) may act.
pub(crate) const JOINTS: [&str; 4] = ["rod", "beam", "head", "crank"];
/// Forms of a probe force other than harmonics of the period.
pub(crate) const FORMS: [&str; 6] = ["const", "sgn_v", "v", "v2", "d2", "d3"];
/// Highest harmonic of a probe force.
pub(crate) const HARMONICS: u32 = 5;

fn shape(name: &str, unit: &str, typical: f64, range: [f64; 2], scale: f64) -> ParameterDescriptor {
    ParameterDescriptor {
        name: name.to_owned(),
        unit: unit.to_owned(),
        role: Role::Shape,
        sign: Sign::Either,
        lower: range[0],
        upper: range[1],
        absent: typical,
        typical,
        scale,
    }
}

/// Returns the effects of the library that have a physical cause.
pub(crate) fn named() -> Vec<EffectDescriptor> {
    use Place::{Drive, Dynamics, Load, Sensor};
    use Sign::{Either, Positive};
    let four = |unit: &str, typical: f64| -> Vec<ParameterDescriptor> {
        (1..=4)
            .map(|k| size(&format!("gauge_{k}"), unit, typical, Either))
            .collect()
    };
    vec![
        effect(
            "pivot_friction",
            "beam",
            Dynamics,
            vec![size("coefficient", "1", 0.01, Positive)],
        ),
        effect(
            "stuffing_box_friction",
            "rod",
            Dynamics,
            vec![size("force", "kN", 0.8, Positive)],
        ),
        effect(
            "rod_drag",
            "rod",
            Dynamics,
            vec![size("drag", "kN/(m/t)^2", 1.0, Positive)],
        ),
        effect(
            "card_time_shift",
            "load",
            Load,
            vec![size("shift", "deg", 1.0, Either)],
        ),
        effect(
            "load_cell_lag",
            "load",
            Load,
            vec![size("lag", "t", 0.01, Positive)],
        ),
        effect(
            "load_cell_gain",
            "load",
            Load,
            vec![size("gain", "1", 0.02, Either)],
        ),
        effect(
            "load_offset",
            "load",
            Load,
            vec![size("offset", "kN", 2.0, Either)],
        ),
        effect(
            "crank_angle_offset",
            "crank",
            Drive,
            vec![size("offset", "deg", 1.0, Either)],
        ),
        effect(
            "crank_speed_ripple",
            "crank",
            Drive,
            vec![
                size("cosine", "1", 0.03, Either),
                size("sine", "1", 0.03, Either),
            ],
        ),
        effect(
            "counterweight_phase",
            "crank",
            Drive,
            vec![size("phase", "deg", 1.0, Either)],
        ),
        effect("gauge_gain", "gauge", Sensor, four("1", 0.02)),
        effect("gauge_drift", "gauge", Sensor, four("MPa", 0.5)),
        effect(
            "amplifier_lag",
            "gauge",
            Sensor,
            vec![size("lag", "t", 0.01, Positive)],
        ),
        effect(
            "head_profile_wear",
            "head",
            Dynamics,
            vec![
                size("depth", "1", 0.03, Positive),
                shape("place", "1", 0.5, [0.05, 0.95], 0.1),
                shape("width", "1", 0.12, [0.05, 0.3], 0.1),
            ],
        ),
        effect(
            "pin_clearance",
            "head",
            Dynamics,
            vec![
                size("gap", "m", 0.002, Positive),
                shape("load", "kN", 65.0, [45.0, 85.0], 10.0),
            ],
        ),
        effect(
            "rope_toe",
            "back_rope",
            Dynamics,
            vec![size("stretch", "m", 0.004, Positive)],
        ),
        effect(
            "beam_inertia",
            "beam",
            Dynamics,
            vec![size("mass", "1", 0.4, Either)],
        ),
    ]
}

/// Returns the probe forces of the library, identified as `probe.JOINT.FORM`.
pub(crate) fn generic() -> Vec<EffectDescriptor> {
    let harmonics = (1..=HARMONICS).flat_map(|h| [format!("cos{h}"), format!("sin{h}")]);
    let forms: Vec<String> = FORMS
        .iter()
        .map(|f| (*f).to_owned())
        .chain(harmonics)
        .collect();
    let mut all = Vec::new();
    for joint in JOINTS {
        for form in &forms {
            let id = format!("probe.{joint}.{form}");
            let mut one = effect(
                &id,
                joint,
                Place::Dynamics,
                vec![size("amplitude", "kN", 1.0, Sign::Either)],
            );
            one.generic = true;
            all.push(one);
        }
    }
    all
}
