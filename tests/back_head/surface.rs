//! Stress on the surface of the shipped head against `CalculiX` and against the gauges of a simulation.
use crate::*;
use simulation::{
    flexible::{SurfaceLoads, SurfacePoint, SurfaceStress},
    observe::Recorder,
    run::simulate,
};
use std::collections::BTreeMap;

/// Stress at 20 places by `CalculiX` 2.20 on this mesh with quadratic bricks (C3D20R, straight edges): under unit
/// accelerations along x and y, and under a rope of 100 kN wrapped from 125 to 185 deg (nodal forces of 512 stations). The
/// places have the largest equivalent stress under the rope among those that are at least 100 mm from every edge and from
/// one another. Under the rope the linear brick C3D8I of `CalculiX` differs from them by up to 13 %.
const REFERENCE: &str = include_str!("calculix_surface.csv");

fn surface(breaks: &[f64], modes: usize, stations: &[f64]) -> Reduction {
    // intervals, two forces at the fixed end, three accelerations, modes
    let returned: Vec<usize> = (0..breaks.len() + 4 + modes).collect();
    reduce(&ReductionRequest {
        mesh: &shipped_mesh(),
        steel: STEEL,
        gauges: &gauges(&table("back_head_modes.json")),
        center: [-0.15, -0.58],
        stations,
        probes: &[],
        wrap: None,
        pair: None,
        modes,
        families: &[Family::Symmetric],
        patterns: &[],
        surface: Some(SurfaceLoads {
            breaks,
            returned: &returned,
        }),
        fields: false,
    })
    .unwrap()
}

/// Returns the equivalent stress of von Mises.
fn von_mises([xx, yy, zz, xy, yz, zx]: &[f64; 6]) -> f64 {
    let square = |x: f64| x * x;
    let normal = square(xx - yy) + square(yy - zz) + square(zz - xx);
    (0.5 * normal + 3.0 * (square(*xy) + square(*yz) + square(*zx))).sqrt()
}

fn at(surface: &SurfaceStress, place: [f64; 3]) -> impl Iterator<Item = (usize, &SurfacePoint)> {
    let near = move |own: &SurfacePoint| {
        let mut apart = own.place.iter().zip(place);
        apart.all(|(a, b)| (a - b).abs() < 2e-6)
    };
    surface
        .points
        .iter()
        .enumerate()
        .filter(move |(_, own)| near(own))
}

#[test]
fn stress_of_the_surface_is_that_of_quadratic_bricks() {
    const TENSION: f64 = 1e5;
    let angle = 10_f64.to_radians();
    let breaks: Vec<f64> = (0..=6)
        .map(|k| (125.0_f64).to_radians() + angle * f64::from(k))
        .collect();
    let surface = surface(&breaks, 1, &[]).surface.unwrap();
    let mut compared: BTreeMap<&str, usize> = BTreeMap::new();
    for line in REFERENCE.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        let theirs: [f64; 6] = std::array::from_fn(|k| number(4 + k));
        let (point, _) = at(&surface, [0, 1, 2].map(number)).next().unwrap();
        let stress = |load: usize| surface.stress[load][point];
        // six intervals, the pull at the fixed end inwards and along, accelerations
        let (ours, tolerance) = match fields[3] {
            "x" => (stress(8), 0.035),
            "y" => (stress(9), 0.02),
            _ => {
                let rope = |k: usize| {
                    let line: f64 = (0..6).map(|load| TENSION * angle * stress(load)[k]).sum();
                    line + TENSION * stress(7)[k]
                };
                (std::array::from_fn(rope), 0.02)
            }
        };
        let apart = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max) / von_mises(&theirs);
        assert!(apart < tolerance, "{line}: {apart}");
        *compared.entry(fields[3]).or_default() += 1;
    }
    assert_eq!(
        compared,
        BTreeMap::from([("x", 20), ("y", 20), ("rope", 20)])
    );
}

/// Checks that the stress on the surface beside gauges 1 and 3, from the loads that a simulation records, is what the
/// simulated gauge reads: Young's modulus times the strain along its grid. The mean over the four nearest nodes stands
/// for the strain beside the hole, which halves within three elements; hence the tolerance.
#[test]
fn recorded_loads_give_the_readings_of_the_gauges() {
    let case = folder().join("..");
    let (unit, _) = load_head(&case).unwrap();
    let condition = unit.case.objective.condition;
    let machine = worker::pumping_unit::machine(&unit, condition).unwrap();
    let law = worker::pumping_unit::rope_law(&unit, &unit.case.start()).unwrap();
    let settings = worker::pumping_unit::run_settings(&unit.machine);
    let mut recorder = Recorder::everything(0).with_head_loads();
    let result = simulate(&machine, &law, &settings, &mut recorder);
    assert_eq!(result.verdict, simulation::verdict::Verdict::Complete);
    let (curves, loads) = (&recorder.curves, &recorder.curves.head_loads);

    let radians = |degrees: &[f64]| degrees.iter().map(|x| x.to_radians()).collect::<Vec<f64>>();
    let breaks = radians(&unit.machine.load_breaks_deg());
    let reduced = surface(&breaks, 1, &[]);
    let surface = reduced.surface.as_ref().unwrap();
    let statics = loads
        .normal
        .iter()
        .chain(&loads.anchor)
        .chain(&loads.acceleration);
    let statics: Vec<&Vec<f64>> = statics.collect();
    for (number, gauge) in [(1, 0), (3, 2)] {
        let gauge_at = gauges(&table("back_head_modes.json"))[gauge].position;
        let mut near: Vec<(usize, f64)> = surface
            .points
            .iter()
            .enumerate()
            // the half has the image of a gauge at z < 0
            .filter(|(_, own)| own.normal[2] > 0.99 && (own.place[2] - 0.16).abs() < 1e-6)
            .map(|(k, own)| {
                let [dx, dy] = [own.place[0] - gauge_at[0], own.place[1] - gauge_at[1]];
                (k, dx.hypot(dy))
            })
            .collect();
        near.sort_by(|a, b| a.1.total_cmp(&b.1));
        near.truncate(4);
        let shares: f64 = near.iter().map(|(_, apart)| 1.0 / apart).sum();
        let unit_strain = |load: usize| -> f64 {
            let strain = |k: usize| {
                let [xx, yy, zz, ..] = surface.stress[load][k];
                yy - STEEL.poisson * (xx + zz)
            };
            near.iter()
                .map(|(k, apart)| strain(*k) / apart / shares)
                .sum()
        };
        let units: Vec<f64> = (0..statics.len()).map(unit_strain).collect();
        let ours: Vec<f64> = (0..curves.beam.len())
            .map(|sample| {
                statics
                    .iter()
                    .zip(&units)
                    .map(|(load, unit)| load[sample] * unit)
                    .sum()
            })
            .collect();
        let theirs = &curves.gauge[gauge];
        let mean = |curve: &[f64]| curve.iter().sum::<f64>() / curve.len() as f64;
        let [a, b] = [&ours[..], &theirs[..]].map(mean);
        let product = |p: &[f64], a: f64, q: &[f64], b: f64| -> f64 {
            p.iter().zip(q).map(|(p, q)| (p - a) * (q - b)).sum()
        };
        let (both, own, other) = (
            product(&ours, a, theirs, b),
            product(&ours, a, &ours, a),
            product(theirs, b, theirs, b),
        );
        let correlation = both / (own * other).sqrt();
        let ratio = (own / other).sqrt();
        eprintln!("gauge {number}: correlation {correlation}, ratio {ratio}, means {a:e} {b:e}");
        assert!(correlation > 0.998, "gauge {number}: {correlation}");
        assert!((0.85..1.15).contains(&ratio), "gauge {number}: {ratio}");
    }
}
