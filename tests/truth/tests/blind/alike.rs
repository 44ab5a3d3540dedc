//! Comparison of hidden effects with the library: a hidden effect changes the gauge signals roughly as the
//! library's effect with the same identifier, in shape, sign and size.
use protocol::{case::EffectSetting, pumping_unit::PumpingUnit};
use std::path::Path;
use std::sync::Arc;
use truth::draw::RandomStream;
use truth::law::{CATALOGUE, HiddenEffect, PlantedEffect};
use truth::machine::{Resolution, Variation, draw_coefficients, turn};
use truth::turn::Turn;

const FINENESS: Resolution = Resolution {
    cylinder: 0.15,
    step: 0.01,
    more_modes: 0,
    samples: 360,
};

fn unit() -> PumpingUnit {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    let case = case::load(&folder, &case::Overrides::default()).expect("the case");
    PumpingUnit::of(case).expect("the case")
}

/// Returns the parameter values at which the library's effect of the same identifier corresponds to a hidden
/// effect.
fn setting(hidden: &PlantedEffect) -> EffectSetting {
    let id = hidden.kind.id;
    let own = &hidden.shape;
    let share = |gauge: usize| {
        own.get(&format!("gauge_{gauge}_share_1"))
            .copied()
            .unwrap_or(0.0)
    };
    let each = |stem: &str| -> Vec<(String, f64)> {
        (1..=4)
            .map(|g| (format!("{stem}_{g}"), hidden.size * share(g)))
            .collect()
    };
    let mut parameters = match id {
        "pin_clearance" => each("step"),
        "gauge_gain" => each("gain"),
        "gauge_cross_talk" => each("into"),
        "gauge_drift" => each("drift"),
        // what a moving average of 15 deg takes from order 10, of what it leaves
        "card_smoothing" => vec![("restored".to_owned(), 0.36)],
        _ => vec![(hidden.kind.parameter.to_owned(), hidden.size)],
    };
    let mut also = |name: &str, value: f64| parameters.push((name.to_owned(), value));
    match id {
        "front_head_radius" => also("radius", own["radius_m"]),
        "fluid_pound" => {
            also("fillage", own["fillage_1"]);
            also("impact", hidden.size * own["blow_n"]);
        }
        "head_profile_wear" => {
            also(
                "centre",
                own["centre_deg"] + 0.5 * own["lean_1"] * own["base_deg"] / 2.0,
            );
            also("width", 0.5 * own["base_deg"]);
        }
        "pin_clearance" => {
            also("direction", own["direction_deg"]);
            also("bias", own["bias_n"]);
        }
        "card_smoothing" => also("harmonics", 7.0),
        _ => {}
    }
    let parameters: Vec<(&str, f64)> = parameters.iter().map(|(n, v)| (n.as_str(), *v)).collect();
    EffectSetting::new(id, &parameters)
}

/// Returns the stress curves of all gauges, each with its mean subtracted, concatenated into one vector.
fn signal(turn: &Turn) -> Vec<f64> {
    let channel = |curve: &Vec<f64>| {
        let mean = curve.iter().sum::<f64>() / curve.len() as f64;
        curve.iter().map(move |x| x - mean).collect::<Vec<f64>>()
    };
    turn.stress.iter().flat_map(channel).collect()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn what_is_hidden_under_a_name_looks_like_the_effect_of_that_name() {
    let unit = unit();
    let values = draw_coefficients(&unit.case, &mut RandomStream::new(1, "genes")).unwrap();
    let run = |unit: &PumpingUnit, hidden: &[PlantedEffect]| {
        let laws: Vec<Arc<dyn HiddenEffect>> =
            hidden.iter().map(|own| Arc::clone(&own.law)).collect();
        turn(unit, 0, (&values, &laws), Variation::default(), &FINENESS).unwrap()
    };
    let plain = run(&unit, &[]);
    for kind in CATALOGUE {
        let hidden = [kind.instantiate(1.0, &mut RandomStream::new(4, kind.id))];
        let mut truth = run(&unit, &hidden);
        let speed = truth::measuring_chain::speed(unit.machine.conditions[0].speed_rpm);
        let shares: Vec<[f64; 4]> = (0..truth.len())
            .map(|i| hidden[0].law.drift(i as f64 / truth.len() as f64))
            .collect();
        for (k, curve) in truth.stress.iter_mut().enumerate() {
            for (stress, drift) in curve.iter_mut().zip(&shares) {
                *stress += drift[k];
            }
        }
        // the program would simulate with the card that was delivered
        let mut judged = unit.clone();
        let card = &mut judged.machine.conditions[0].card.load_n;
        hidden[0].law.distort_card(card, speed);
        let believed = if *card == unit.machine.conditions[0].card.load_n {
            plain.clone()
        } else {
            run(&judged, &[])
        };
        let library = run_library(&judged, &setting(&hidden[0]), &values);
        let own = difference(&signal(&truth), &signal(&believed));
        let theirs = difference(&signal(&library), &signal(&believed));
        let [a, b] = [&own, &theirs].map(|x| dot(x, x).sqrt());
        let alike = dot(&own, &theirs) / (a * b);
        let rms = a / (own.len() as f64).sqrt();
        eprintln!(
            "{}: {rms:.3} MPa rms, cosine {alike:.3}, ratio {:.2}",
            kind.id,
            a / b
        );
        assert!(alike > 0.6, "{}: {alike}", kind.id);
        assert!((0.3..3.0).contains(&(a / b)), "{}: {a} {b}", kind.id);
        assert!(rms > 0.003, "{}: {rms}", kind.id);
    }
}

/// Simulates one crank revolution of the pumping unit with an effect of the library.
fn run_library(unit: &PumpingUnit, effect: &EffectSetting, values: &[f64]) -> Turn {
    use simulation::integrator::tableau::TR_BDF2;
    use simulation::run::{RunSettings, simulate};
    let finer = protocol::pumping_unit::Discretisation {
        cylinder_length_m: Some(FINENESS.cylinder),
        ..protocol::pumping_unit::Discretisation::default()
    };
    let unit = worker::pumping_unit::refined(unit, &finer).expect("the case fits");
    let law = worker::pumping_unit::rope_law(&unit, values).expect("the case fits");
    let individual = protocol::job::Individual {
        effects: vec![effect.clone()],
        ..protocol::job::Individual::new(0, values.to_vec())
    };
    let machine = worker::pumping_unit::machine_with(&unit, &individual).expect("the case fits");
    let settings = RunSettings {
        method: (&TR_BDF2).into(),
        lead_in: 240_f64.to_radians(),
        samples: FINENESS.samples,
        tolerance: 0.3,
        longest_step: FINENESS.step,
        ..RunSettings::default()
    };
    let mut watch = truth::turn::Watch::default();
    simulate(&machine, &law, &settings, &mut watch);
    watch.turn(&machine, &law)
}
