//! Small asymmetric reference machine with a synthetic head, used in tests and to fingerprint the numerics of
//! a build by the bits of its simulation.
//!
//! Two programs that agree on every bit of [`bits`] integrate the same equations with the same arithmetic; a
//! change of a law, a tolerance or an elementary function changes the bits.
use crate::effect::{Effect, EffectRequest, Parameter, Selection, catalogue};
use crate::element::{bushing::Bushing, impact::Impact};
use crate::model::Machine;
use crate::model::description::{
    self, AntisymmetricHead, Crank, Description, Head, Rod, Rope, RopeLaw, StressRecovery, Twins,
};
use crate::observe::Recorder;
use crate::run::{RunSettings, simulate};
use crate::sensitivity::{self, Coefficient, Column, ColumnOrigin, Derivative, DerivativePlan};
use crate::statistics::Statistics;
use std::sync::Arc;

/// Returns a synthetic table over the stations of the head's arc, in place of a mode shape or influence line.
fn wave(k: u32, scale: f64) -> Vec<f64> {
    (0..27)
        .map(|i| scale * libm::sin(0.3 + 0.21 * f64::from(k + 1) * f64::from(i)))
        .collect()
}

/// Returns the reference machine with twin ropes, whose lengths differ by `longer` on the back and on the
/// front head \[m\], and with an out-of-plane flexible head.
pub fn twins(longer: [f64; 2]) -> Description {
    Description {
        twins: Some(Twins {
            offset: 0.12,
            longer,
            sway: AntisymmetricHead {
                frequencies: vec![290.0, 600.0],
                radial: vec![wave(0, 0.01), wave(1, 0.02)],
                tangential: vec![wave(2, 0.01), wave(3, 0.01)],
                lateral: vec![wave(1, 0.05), wave(0, 0.02)],
                gauge_stress: vec![[-1e9, 2e9, 3e9, -2e9], [4e9, 5e9, 3e9, 2e9]],
                normal_influence: vec![wave(3, 80.0); 4],
                tangential_influence: vec![wave(4, 90.0); 4],
                lateral_influence: vec![wave(5, 300.0); 4],
            },
        }),
        ..description()
    }
}

/// Returns the description of a machine of the real unit's shape with fewer, longer cylinders: 24 in the back
/// rope and 38 in the front rope.
pub fn description() -> Description {
    Description {
        gravity: 9.81,
        beam_inertia: 2.4e4,
        beam_gravity_moment: 700.0,
        beam_gravity_height: 0.0,
        crank: Crank {
            center: [-2.6, -5.1],
            radius: 1.0973,
            sense: -1.0,
            speed: 5.0 * std::f64::consts::TAU / 60.0,
            counterweight_moment: 1.06e5,
            counterweight_phase: 0.02,
        },
        rod: Rod {
            length: 2.876,
            mass: 450.0,
            center_of_mass: 2.04,
            inertia: 385.0,
        },
        suspension_mass: 175.0,
        rope: Rope {
            diameter: 0.01,
            pitch: 0.15,
            density: 7850.0,
            reference_pitch: 0.05,
            end_pitches: 0.5,
            back: 24,
            front: 38,
        },
        front_arc: description::Arc {
            center: [0.0, 0.0],
            radius: 3.6,
            anchor: 36.6_f64.to_radians(),
            sense: 1.0,
        },
        back_arc: description::Arc {
            center: [-0.15, -0.58],
            radius: 1.9,
            anchor: 125_f64.to_radians(),
            sense: -1.0,
        },
        head: Head {
            frequencies: vec![700.0, 900.0],
            damping_ratio: 0.01,
            recovery: StressRecovery::default(),
            start: 118_f64.to_radians(),
            step: 4_f64.to_radians(),
            radial: vec![wave(0, 0.004), wave(1, 0.007)],
            tangential: vec![wave(2, 0.003), wave(3, 0.002)],
            gauge_stress: vec![[2e9, -1e9, 3e9, 1e9], [1e9, 2e9, -4e9, 2e9]],
            participation: vec![[1.3, -3.6, 11.0], [8.0, -15.0, 45.0]],
            weight_stress: [[1e4, 2e4, 3e4, 4e4], [5e4, -2e4, 1e4, -3e4]],
            turning_stress: [4e5, -2e5, -5e5, 2e5],
            influence_start: 118_f64.to_radians(),
            influence_step: 4_f64.to_radians(),
            load_breaks: (0..=8)
                .map(|k| f64::from(125 + 10 * k).to_radians())
                .collect(),
            normal_influence: vec![wave(4, 100.0); 4],
            tangential_influence: vec![wave(5, 200.0); 4],
        },
        twins: None,
        card: (0..72)
            .map(|i| 57e3 + 15e3 * libm::sin(0.0873 * f64::from(i)))
            .collect(),
    }
}

/// Returns the optimised coefficients of Table 3 of the paper, in SI units.
pub fn law() -> RopeLaw {
    let deg = 180.0 / std::f64::consts::PI;
    RopeLaw {
        bushing: Bushing {
            stiffness: [7.81e8, 2.26e8],
            damping: [5201.0, 4287.0],
            rotational_stiffness: [204.0 * deg, 308.0 * deg],
            rotational_damping: [45.0 * deg, 56.0 * deg],
            preload: 0.0,
        },
        contact: Impact {
            stiffness: 4.01e8,
            exponent: 1.5,
            damping: 1020.0,
            full_damping_penetration: 1e-4,
        },
    }
}

/// Returns the gauge stress of a run of the reference machine, as bits, and the statistics of the run.
///
/// The bits are empty if the description is invalid, which a test rules out.
pub fn bits() -> (Vec<u64>, Statistics) {
    run(description(), &[], &RunSettings::default())
}

/// Returns gauge-stress bits and work counters of three inexpensive runs that together fingerprint the
/// numerics of a build. The machine has fewer cylinders and a faster crank. Two runs are complete: the plain
/// machine, and one with every named effect at its typical size and every generic force at a tenth of it. The
/// run with twin ropes is limited to 2000 Newton iterations.
pub fn fingerprint() -> [(Vec<u64>, Statistics); 3] {
    let settings = quick();
    let short = RunSettings {
        budget: 2000,
        ..settings
    };
    let asked: Vec<EffectRequest<'_>> = catalogue()
        .iter()
        .map(|d| {
            let share = if d.generic { 0.1 } else { 1.0 };
            let value = |p: &Parameter| p.absent + share * (p.typical - p.absent);
            EffectRequest {
                id: &d.id,
                parameters: d.parameters.iter().map(|p| (p.name, value(p))).collect(),
            }
        })
        .collect();
    let all = Selection::new(&asked).unwrap_or_default();
    [
        run(small(description()), &[], &settings),
        run(small(description()), all.effects(), &settings),
        run(small(twins([2e-3, -1e-3])), &[], &short),
    ]
}

/// Returns derivatives of a run as bits, to fingerprint the numerics of a build. The run is the plain one of
/// [`fingerprint`] with bearing friction added; the derivatives are with respect to the most influential
/// coefficients (`Kb1`, `Kc`), a size and a shape parameter of an effect that the machine has, a size of an
/// effect that it lacks, and a generic force.
///
/// The result is empty if a derivative does not exist, which a test rules out.
pub fn columns() -> Vec<u64> {
    let description = small(description());
    let friction = EffectRequest {
        id: "pivot_friction",
        parameters: vec![("moment", 1500.0), ("creep", 4e-3)],
    };
    let effects = [friction];
    let built = Selection::new(&effects).unwrap_or_default();
    let Ok(machine) = Machine::with_effects(description.clone(), 2, built.effects()) else {
        return Vec::new();
    };
    let parameter = |effect: &str, parameter: &str| Column::Parameter {
        effect: effect.to_owned(),
        parameter: parameter.to_owned(),
        values: Vec::new(),
    };
    let generic = catalogue().iter().find(|one| one.generic);
    let generic = generic.and_then(|one| Some(parameter(&one.id, one.parameters.first()?.name)));
    let columns: Vec<Column> = [Coefficient::Kb1, Coefficient::Kc]
        .map(Column::Coefficient)
        .into_iter()
        .chain([
            parameter("pivot_friction", "moment"),
            parameter("pivot_friction", "creep"),
            parameter("head_profile_wear", "depth"),
        ])
        .chain(generic)
        .collect();
    let origin = ColumnOrigin {
        description: &description,
        modes: 2,
        effects: &effects,
    };
    let Ok(plan) = DerivativePlan::new(&origin, &machine, &columns) else {
        return Vec::new();
    };
    let settings = RunSettings {
        samples: 72,
        ..quick()
    };
    let mut recorder = Recorder::gauges_only();
    let (_, found) = sensitivity::simulate(&machine, &law(), &settings, &plan, &mut recorder);
    let mut bits = Vec::new();
    for column in found.map(|found| found.columns).unwrap_or_default() {
        let Derivative::Curves(changes) = column else {
            return Vec::new();
        };
        bits.extend(changes.gauge.iter().flatten().map(|x| x.to_bits()));
    }
    bits
}

/// Returns run settings for the fingerprint runs, with a short run-up to full speed.
fn quick() -> RunSettings {
    RunSettings {
        lead_in: 20_f64.to_radians(),
        ramp: 0.3,
        ..RunSettings::default()
    }
}

/// Reduces a machine to a sixth of its cylinders and triples its crank speed.
fn small(mut description: Description) -> Description {
    description.crank.speed *= 3.0;
    description.rope.pitch *= 6.0;
    description.rope.back /= 6;
    description.rope.front /= 6;
    description
}

fn run(
    description: Description,
    effects: &[Arc<dyn Effect>],
    settings: &RunSettings,
) -> (Vec<u64>, Statistics) {
    let Ok(machine) = Machine::with_effects(description, 2, effects) else {
        return Default::default();
    };
    let settings = RunSettings {
        samples: 72,
        ..*settings
    };
    let mut recorder = Recorder::gauges_only();
    let result = simulate(&machine, &law(), &settings, &mut recorder);
    let bits = recorder.curves.gauge.iter().flatten().map(|x| x.to_bits());
    (bits.collect(), result.statistics)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_run_completes_and_repeats_bit_for_bit() {
        let (first, statistics) = bits();
        assert_eq!(first.len(), 4 * 72);
        assert!(first.iter().all(|bits| f64::from_bits(*bits).is_finite()));
        assert!(statistics.steps > 100);
        assert_eq!(bits(), (first, statistics));
    }

    #[test]
    fn the_columns_that_name_a_build_are_all_there_and_repeat_bit_for_bit() {
        let first = columns();
        assert_eq!(first.len(), 6 * 4 * 72);
        let values: Vec<f64> = first.iter().map(|bits| f64::from_bits(*bits)).collect();
        assert!(values.iter().all(|x| x.is_finite()));
        for (at, column) in values.chunks(4 * 72).enumerate() {
            assert!(column.iter().any(|x| *x != 0.0), "column {at}");
        }
        assert_eq!(columns(), first);
    }

    #[test]
    fn the_runs_that_name_a_build_differ_and_repeat_bit_for_bit() {
        let first = fingerprint();
        let [plain, effects, twins] = first.each_ref().map(|(bits, _)| bits);
        assert_eq!((plain.len(), effects.len()), (4 * 72, 4 * 72));
        assert!(twins.len() > 4 * 4, "{}", twins.len());
        let all = [plain, effects, twins].into_iter().flatten();
        assert!(all.copied().all(|bits| f64::from_bits(bits).is_finite()));
        assert!(plain != effects && plain[..twins.len()] != twins[..]);
        assert_eq!(fingerprint(), first);
    }
}
