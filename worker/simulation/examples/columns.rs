//! Runs with columns beside the plain run, in one process: what they cost in its time.
use simulation::effect::{Role, catalogue};
use simulation::model::Machine;
use simulation::observe::Recorder;
use simulation::reference;
use simulation::run::{RunSettings, simulate};
use simulation::sensitivity::{self, Coefficient, Column, Origin, Plan};
use std::time::Instant;
fn main() {
    let mut description = reference::description();
    description.rope.pitch = 0.05;
    description.rope.back = 72;
    description.rope.front = 114;
    for key in 2..6 {
        let mut m = |k: usize| {
            description.head.frequencies.push(900.0 + 100.0 * k as f64);
            let r = description.head.radial[0].clone();
            description.head.radial.push(r);
            let r = description.head.tangential[1].clone();
            description.head.tangential.push(r);
            description.head.gauge_stress.push([1e9; 4]);
            description.head.participation.push([1.0, 2.0, 3.0]);
        };
        m(key);
    }
    let modes = 6;
    let machine = Machine::new(description.clone(), modes).unwrap();
    let mut law = reference::law();
    let deg = 180.0 / std::f64::consts::PI;
    law.bushing.stiffness = [3.14e8, 1.25e8];
    law.bushing.damping = [400.0; 2];
    law.bushing.rotational_stiffness = [110.0 * deg, 137.0 * deg];
    law.bushing.rotational_damping = [40.0 * deg; 2];
    law.contact.stiffness = 1e6;
    law.contact.damping = 50.0;
    let settings = RunSettings {
        samples: 24,
        ..RunSettings::default()
    };
    let origin = Origin {
        description: &description,
        modes,
        effects: &[],
    };
    let of = |generic: bool| -> Vec<Column> {
        catalogue()
            .iter()
            .filter(|d| d.generic == generic)
            .flat_map(|d| {
                d.parameters
                    .iter()
                    .filter(|p| p.role == Role::Size)
                    .map(|p| Column::Parameter {
                        effect: d.id.to_string(),
                        parameter: p.name.to_owned(),
                        values: vec![],
                    })
            })
            .collect()
    };
    let coefficients: Vec<Column> = Coefficient::ALL.map(Column::Coefficient).to_vec();
    let named = of(false);
    let probes = of(true);
    let pick = |place: &[&str]| -> Vec<Column> {
        named.iter().filter(|c| matches!(c, Column::Parameter { effect, .. } if place.contains(&effect.as_str()))).cloned().collect()
    };
    let sets = [
        ("none", vec![]),
        ("one (kb1)", coefficients[..1].to_vec()),
        ("coefficients", coefficients.clone()),
        (
            "coefficients + pivot friction",
            [coefficients.clone(), pick(&["pivot_friction"])].concat(),
        ),
        (
            "load",
            pick(&[
                "load_offset",
                "load_cell_gain",
                "card_time_shift",
                "card_smoothing",
            ]),
        ),
        (
            "geometry",
            pick(&["front_head_radius", "rope_stretch", "head_profile_wear"]),
        ),
        (
            "gauges",
            pick(&[
                "gauge_gain",
                "gauge_drift",
                "pin_clearance",
                "gauge_cross_talk",
            ]),
        ),
        ("along ropes", pick(&["rope_toe", "rope_hysteresis"])),
        ("named", named.clone()),
        ("probes on coordinates", probes[..72].to_vec()),
        ("probes on ropes", probes[72..].to_vec()),
        ("157 signatures", [named.clone(), probes.clone()].concat()),
    ];
    let plain = || {
        let mut r = Recorder::gauges_only();
        let t = Instant::now();
        let s = simulate(&machine, &law, &settings, &mut r);
        (t.elapsed().as_secs_f64(), s)
    };
    println!("{:?}", plain().1.statistics);
    for (name, columns) in sets.into_iter().filter(|(name, _)| {
        std::env::args()
            .nth(1)
            .is_none_or(|only| name.starts_with(&only))
    }) {
        let t = Instant::now();
        let plan = Plan::new(&origin, &machine, &columns).unwrap();
        let planned = t.elapsed().as_secs_f64();
        let (mut best, mut base) = (f64::MAX, f64::MAX);
        for _ in 0..4 {
            base = base.min(plain().0);
            let mut r = Recorder::gauges_only();
            let t = Instant::now();
            let _ = sensitivity::simulate(&machine, &law, &settings, &plan, &mut r);
            best = best.min(t.elapsed().as_secs_f64());
        }
        println!(
            "{name}: {} columns, {:.2} plain runs (plan {:.2}), each {:.3}; plain {base:.3} s",
            columns.len(),
            best / base,
            planned / base,
            (best / base - 1.0) / columns.len().max(1) as f64
        );
    }
}
