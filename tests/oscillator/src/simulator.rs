//! Simulator interface of the oscillator for the worker: takes cases and jobs, returns curves.
use crate::{
    effect::{self, Effects},
    settings::Settings,
    simulate::{Run, STRIKES, Sensor, Values, run},
};
use protocol::{
    announce::EffectDescriptor,
    case::{Case, EffectSetting, merged},
    id::ContentHash,
    job::{
        Counters, Derivative, Failure, Identifier, Individual, Observation, Reached, SimulateSpec,
        Verdict,
    },
};
use worker::simulator::{Model, Simulator};

/// Simulator of models of the kind `oscillator`.
#[derive(Clone, Copy, Debug)]
pub struct Oscillators;

/// Oscillator prepared for one case.
#[derive(Debug)]
struct Prepared {
    case: Case,
    settings: Settings,
    /// Sensors of the case's channels, one list for each condition.
    sensors: Vec<Vec<Sensor>>,
}

/// Unknowns that each case must have, in the order of [`Values`], with their units.
const UNKNOWNS: [(&str, &str); 7] = [
    ("mass", "kg"),
    ("armature", "kg"),
    ("left", "N/mm"),
    ("right", "N/mm"),
    ("damping", "N.s/m"),
    ("lead", "deg"),
    ("crosstalk", "mm/N"),
];

impl Simulator for Oscillators {
    fn kind(&self) -> &'static str {
        "oscillator"
    }

    fn digest(&self) -> String {
        ContentHash::of(format!("{:?}", reference()).as_bytes()).to_string()
    }

    fn effects(&self) -> Vec<EffectDescriptor> {
        effect::descriptors()
    }

    fn prepare(&self, case: &Case) -> Result<Box<dyn Model>, Failure> {
        Ok(Box::new(Prepared::new(case)?))
    }

    fn run_custom(&self, name: &str, _: &[u8]) -> Result<Vec<u8>, Failure> {
        Err(Failure::Refused {
            reason: format!("the oscillator model does not support the job `{name}`"),
        })
    }
}

/// Simulates a fixed oscillator with all effects; the bits of the result identify the numerics of this build.
fn reference() -> Run {
    let excitation = crate::settings::Excitation {
        drive_hz: Some(6.5),
        drive: vec![crate::settings::Order {
            order: 1,
            amplitude_n: 40.0,
            phase_deg: 10.0,
        }],
        release_mm: 0.0,
    };
    let values = Values {
        mass_kg: 2.0,
        armature_kg: 0.3,
        left_n_per_mm: 5.0,
        right_n_per_mm: 7.0,
        damping_n_s_per_m: 21.0,
        lead_deg: 1.0,
        crosstalk_mm_per_n: 1e-3,
    };
    let effects = Effects {
        friction_n: 3.0,
        second_order_n: [1.0, -2.0],
        base_mm: [0.1, 0.05],
        lag_ms: 2.0,
    };
    let places: Vec<f64> = (0..36).map(|at| 10.0 * f64::from(at)).collect();
    let sensors = [
        (Sensor::Displacement, &places[..]),
        (Sensor::Force, &places),
    ];
    run(
        &crate::settings::RigSettings { stop_mm: 50.0 },
        &excitation,
        &values,
        &effects,
        &sensors,
    )
}

impl Prepared {
    fn new(case: &Case) -> Result<Self, Failure> {
        let settings = Settings::read(&case.model.settings)
            .map_err(|problem| Failure::misconfigured("model", problem))?;
        for (name, unit) in UNKNOWNS {
            let found = case.unknowns.iter().find(|unknown| unknown.name == name);
            if found.is_none_or(|unknown| unknown.unit != unit) {
                let problem =
                    format!("the case must have an unknown named {name} with the unit {unit}");
                return Err(Failure::misconfigured("unknowns", problem));
            }
        }
        let sensor = |channel: &protocol::case::Channel| {
            let known = Sensor::named(&channel.name).filter(|(_, unit)| *unit == channel.unit);
            let problem = || {
                format!(
                    "the rig does not measure {} in {}; it measures displacement in mm and force in N",
                    channel.name, channel.unit
                )
            };
            known
                .map(|(sensor, _)| sensor)
                .ok_or_else(|| Failure::misconfigured("channels", problem()))
        };
        let of = |condition| {
            case.channels_of(condition)
                .map(|(_, channel)| sensor(channel))
                .collect()
        };
        let sensors = (0..case.conditions.len())
            .map(of)
            .collect::<Result<_, _>>()?;
        for (setting, units) in case.effects.iter().zip(&case.effect_units) {
            for ((name, _), unit) in setting.parameters.iter().zip(units) {
                if effect::unit(&setting.id, name).is_some_and(|own| own != unit) {
                    let field = format!("effects.{}.{name}.unit", setting.id);
                    return Err(Failure::misconfigured(&field, format!("is {unit}")));
                }
            }
        }
        let prepared = Self {
            case: case.clone(),
            settings,
            sensors,
        };
        prepared.effects(&Individual::new(0, case.start()))?;
        Ok(prepared)
    }

    /// Merges the effects of the case with those of a job; effect parameters that are unknowns take the
    /// values of the individual.
    fn effects(&self, individual: &Individual) -> Result<Effects, Failure> {
        let mut own = self.case.effects.clone();
        for (unknown, value) in self.case.unknowns.iter().zip(&individual.genes) {
            let Some((id, parameter)) = unknown.of_effect() else {
                continue;
            };
            let setting = own.iter_mut().find(|setting| setting.id == id);
            let parameters = setting
                .into_iter()
                .flat_map(|setting| &mut setting.parameters);
            parameters
                .filter(|(name, _)| name == parameter)
                .for_each(|(_, slot)| *slot = *value);
        }
        let all: Vec<EffectSetting> = merged(&own, &individual.effects);
        Effects::read(&all)
            .map_err(|(field, problem)| Failure::misconfigured(format!("effects.{field}"), problem))
    }

    fn values(&self, individual: &Individual) -> Values {
        let [
            mass_kg,
            armature_kg,
            left_n_per_mm,
            right_n_per_mm,
            damping_n_s_per_m,
            lead_deg,
            crosstalk_mm_per_n,
        ] = UNKNOWNS.map(|(name, _)| {
            let named = self.case.unknowns.iter().zip(&individual.genes);
            let mut found = named.filter(|(unknown, _)| unknown.name == name);
            found.next().map_or(f64::NAN, |(_, value)| *value)
        });
        Values {
            mass_kg,
            armature_kg,
            left_n_per_mm,
            right_n_per_mm,
            damping_n_s_per_m,
            lead_deg,
            crosstalk_mm_per_n,
        }
    }

    fn run(&self, spec: &SimulateSpec) -> Result<Observation, Failure> {
        let individual = &spec.individual;
        let condition = individual.condition;
        let unknown =
            || Failure::misconfigured("condition", format!("there is no condition {condition}"));
        let sensors = self.sensors.get(condition).ok_or_else(unknown)?;
        let excitation = self
            .settings
            .conditions
            .get(condition)
            .ok_or_else(unknown)?;
        let places = self.case.channels_of(condition);
        let places = places.map(|(_, channel)| &channel.abscissa.points[..]);
        let channels: Vec<(Sensor, &[f64])> = sensors.iter().copied().zip(places).collect();
        let run = run(
            &self.settings.model,
            excitation,
            &self.values(individual),
            &self.effects(individual)?,
            &channels,
        );
        Ok(Observation {
            verdict: verdict(&run, &channels),
            counters: Counters {
                steps: run.pieces as u64,
                ..Counters::default()
            },
            curves: run.curves,
            columns: Derivative::none(&spec.columns),
        })
    }
}

impl Model for Prepared {
    fn observe(&self, spec: &SimulateSpec, _: bool) -> Result<Observation, Failure> {
        self.run(spec)
    }
}

/// Returns the verdict of a simulation; if the mass struck the stop, the fraction reached is that of the
/// shortest curve.
fn verdict(run: &Run, channels: &[(Sensor, &[f64])]) -> Verdict {
    let Some(kind) = run.failed else {
        return Verdict::Complete;
    };
    let shares = run
        .curves
        .iter()
        .zip(channels)
        .map(|(curve, (_, places))| curve.len() as f64 / places.len() as f64);
    let share = shares.fold(1.0, f64::min);
    Verdict::Failed {
        kind: Identifier::new(kind),
        reached: if kind == STRIKES {
            Reached::TimeFraction(share)
        } else {
            Reached::LoadFraction(0.0)
        },
    }
}
