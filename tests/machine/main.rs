//! Tests of the shipped pumping unit: its case, converted as a worker converts it.
#![expect(clippy::unwrap_used, reason = "helpers of tests")]
mod columns;
mod conditions;
mod effect;
mod gene;
mod rounding;
mod start;
mod twins;

use protocol::{case::Case, pumping_unit::PumpingUnit};
use simulation::integrator::method::{CATALOGUE, Method};
use simulation::integrator::tableau::ESDIRK4;
use simulation::model::Machine;
use simulation::model::description::RopeLaw;
use simulation::model::kinematics::Position;
use simulation::observe::Recorder;
use simulation::run::{RunResult, RunSettings, simulate};
use simulation::verdict::Verdict;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb")
}

fn case() -> Case {
    case::load(&folder(), &case::Overrides::default()).unwrap()
}

/// Returns the shipped case together with its machine description.
fn unit() -> PumpingUnit {
    PumpingUnit::of(case()).unwrap()
}

/// Returns two individuals with their names: the recommended coefficients and the optimised ones of Table 3
/// of the paper.
fn individuals(case: &Case) -> [(&'static str, Vec<f64>); 2] {
    let optimised = folder().join("table3_optimised.toml");
    [
        ("recommended", case.start()),
        ("optimised", case::read_genes(&optimised, case).unwrap()),
    ]
}

fn run(machine: &Machine, law: &RopeLaw, settings: &RunSettings) -> (RunResult, Recorder) {
    let mut recorder = Recorder::gauges_only();
    let result = simulate(machine, law, settings, &mut recorder);
    assert_eq!(result.verdict, Verdict::Complete);
    (result, recorder)
}

/// Checks that the energy ledger (crank work = load work + losses + stored energy) closes over one
/// revolution: to 1e-4 with the default settings of the case (measured: 4e-6 and 3e-5) and with the other
/// Runge-Kutta method, to 2e-3 with the Rosenbrock method and to 1e-2 with the remaining methods. These have
/// numerical damping, or sample the powers of a chattering contact only three times a step.
#[test]
fn energy_ledger_closes_over_one_revolution() {
    let unit = unit();
    let machine = worker::pumping_unit::machine(&unit, 0).unwrap();
    for (name, genes) in individuals(&unit.case) {
        let law = worker::pumping_unit::rope_law(&unit, &genes).unwrap();
        for method in CATALOGUE {
            let default = worker::pumping_unit::run_settings(&unit.machine);
            let settings = if method.name() == default.method.name() {
                default
            } else {
                RunSettings {
                    method,
                    longest_step: 0.03,
                    slow_swing: f64::INFINITY,
                    ..default
                }
            };
            let (result, _) = run(&machine, &law, &settings);
            let work = result.work;
            let gained = work.input - work.output - work.dissipated;
            let defect = (result.stored - gained).abs() / work.input;
            eprintln!(
                "{name} {}: {defect:.1e} {:?}",
                method.name(),
                result.statistics
            );
            let allowed = match method {
                Method::RungeKutta(_) => 1e-4,
                Method::Rosenbrock => 2e-3,
                Method::GeneralizedAlpha { .. } | Method::Bdf { .. } => 1e-2,
            };
            assert!(defect < allowed, "{name} {}: {defect}", method.name());
        }
    }
}

/// Returns run settings with exactly the given method, tolerance and longest step: no shortening of the step
/// for fast-swinging beams, and no limit on the work.
fn stated(unit: &PumpingUnit, method: Method, tolerance: f64, longest_step: f64) -> RunSettings {
    RunSettings {
        method,
        tolerance,
        longest_step,
        slow_swing: f64::INFINITY,
        budget: u64::MAX,
        ..worker::pumping_unit::run_settings(&unit.machine)
    }
}

/// Checks that, with steps that resolve the ropes' own modes, the energy ledger closes to 3e-4 of the crank's
/// work with every method, and that the defect is at least halved with each tenth of the Newton tolerance
/// until it reaches the rounding and quadrature error, 5e-6. The Rosenbrock method has no Newton remainder:
/// its 1e-5 to 3e-5 are the error of Simpson's rule for the powers and decrease with the step.
#[test]
fn energy_ledger_tightens_with_step_and_tolerance() {
    let unit = unit();
    let machine = worker::pumping_unit::machine(&unit, 0).unwrap();
    for (name, genes) in individuals(&unit.case) {
        let law = worker::pumping_unit::rope_law(&unit, &genes).unwrap();
        for method in CATALOGUE {
            let steps = match method {
                Method::RungeKutta(tableau) if tableau.order > 2 => [0.02; 3],
                Method::RungeKutta(_) => [0.004; 3],
                Method::Rosenbrock => [0.01, 0.005, 0.0025],
                Method::GeneralizedAlpha { .. } | Method::Bdf { .. } => [0.002; 3],
            };
            let defects = [0, 1, 2].map(|k| {
                let settings = stated(&unit, method, [1.0, 0.1, 0.01][k], steps[k]);
                let (result, _) = run(&machine, &law, &settings);
                let work = result.work;
                let gained = work.input - work.output - work.dissipated;
                (result.stored - gained).abs() / work.input
            });
            let method = method.name();
            eprintln!("{name} {method}: {defects:?}");
            assert!(defects[0] < 3e-4, "{name} {method}: {defects:?}");
            for pair in defects.windows(2) {
                let tighter = pair[1] < 0.5 * pair[0] || pair[1] < 5e-6;
                assert!(tighter, "{name} {method}: {defects:?}");
            }
        }
    }
}

/// Checks the kinematics with inextensible ropes against the table of the case, which another program
/// computed.
///
/// The table has seven significant digits: beam angles to 5e-6 deg, and the pin angle of its first row, from
/// which its exact turns of 0.5 deg are counted, to 5e-6 deg as well (later rows print the pin as 356.7800
/// for 356.77996, and are not used). The length from pin to anchor is given to 1 mm, and agrees to better
/// than 1e-6 m: the program that made the table had the same 6.476 m.
#[test]
fn kinematics_agree_with_the_table_to_its_last_digit() {
    let unit = unit();
    let machine = worker::pumping_unit::machine(&unit, 0).unwrap();
    let mechanism = machine.mechanism(machine.description.back_arc.radius, machine.back_length());
    let text = std::fs::read_to_string(folder().join("machine/kinematics_720.csv")).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 720);
    let first = rows[0][1];
    let bottom = machine.bottom;
    let offset = (bottom.pin.to_degrees() - first + 180.0).rem_euclid(360.0) - 180.0;
    let speed = machine.description.crank.speed;
    let arm = machine.description.front_arc.radius;
    let arc = machine.description.back_arc;
    // velocity of the stroke at a turn near a known position
    let velocity = |turn: f64, near: Position| {
        let pin = first.to_radians() - turn;
        let at = mechanism.position(pin, near.beam, near.tangent).unwrap();
        -arm * at.ratio * speed
    };
    let mut at = bottom;
    let mut worst = [0.0_f64; 9];
    for row in &rows {
        let turn = row[0].to_radians();
        at = mechanism
            .position(first.to_radians() - turn, at.beam, at.tangent)
            .unwrap();
        let wrap = arc.radius * (at.tangent - arc.anchor);
        let step = 1e-4;
        let change = velocity(turn + step, at) - velocity(turn - step, at);
        let errors = [
            at.beam.to_degrees() - row[2],
            arm * (at.beam - bottom.beam) - row[3],
            at.arm - row[6],
            (at.tangent + at.beam).to_degrees() - row[8],
            at.tangent.to_degrees() - row[9],
            wrap - row[10],
            mechanism.length - wrap - row[11],
            velocity(turn, at) - row[4],
            0.5 * change / step * speed - row[5],
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            *worst = worst.max(error.abs());
        }
    }
    eprintln!("{worst:?}; bottom dead centre {offset:.1e} deg");
    assert!(worst[0] < 8e-6, "beam {} deg", worst[0]);
    // 5e-7 m, and 0.48 times the first pin angle's 5e-6 deg on an arm of 3.6 m
    assert!(worst[1] < 6.6e-7, "stroke {} m", worst[1]);
    assert!(worst[2] < 6.6e-7, "arm {} m", worst[2]);
    // the direction of the free rope and its tangent point have four decimals of a degree
    assert!(worst[3] < 6e-5, "direction {} deg", worst[3]);
    assert!(worst[4] < 6e-5, "tangent point {} deg", worst[4]);
    assert!(worst[5] < 1e-6, "wrapped length {} m", worst[5]);
    assert!(worst[6] < 1e-6, "free length {} m", worst[6]);
    assert!(worst[7] < 1e-6, "velocity {} m/s", worst[7]);
    assert!(worst[8] < 1e-5, "acceleration {} m/s2", worst[8]);
    assert!(offset.abs() < 1e-5, "bottom dead centre {offset} deg");
}

/// Checks that torsional coefficients change no bit of a gauge in the symmetric unit, where no load twists a
/// rope.
#[test]
fn torsion_leaves_every_gauge_bit_alone() {
    let unit = unit();
    let machine = worker::pumping_unit::machine(&unit, 0).unwrap();
    let settings = worker::pumping_unit::run_settings(&unit.machine);
    for (name, genes) in individuals(&unit.case) {
        let law = worker::pumping_unit::rope_law(&unit, &genes).unwrap();
        let (_, plain) = run(&machine, &law, &settings);
        for factor in [0.1, 10.0] {
            let mut other = law;
            other.bushing.rotational_stiffness[0] *= factor;
            other.bushing.rotational_damping[0] *= 1.0 / factor;
            let (_, turned) = run(&machine, &other, &settings);
            assert_eq!(
                plain.curves.gauge, turned.curves.gauge,
                "{name} times {factor}"
            );
        }
    }
}

/// Checks that all integration methods give the same gauges if their steps resolve the rope: to 0.1 % of the
/// range with fourth-order methods and steps of 10 ms, to 1.5 % with second-order methods and steps of 4 ms.
#[test]
fn gauges_do_not_depend_on_the_method() {
    let unit = unit();
    let machine = worker::pumping_unit::machine(&unit, 0).unwrap();
    for (name, genes) in individuals(&unit.case) {
        let law = worker::pumping_unit::rope_law(&unit, &genes).unwrap();
        let with = |method, tolerance, longest_step| {
            let settings = stated(&unit, method, tolerance, longest_step);
            let (result, recorder) = run(&machine, &law, &settings);
            assert_eq!(result.verdict, Verdict::Complete);
            (result, recorder.curves)
        };
        let (_, exact) = with(Method::RungeKutta(&ESDIRK4), 0.01, 0.005);
        for method in CATALOGUE {
            let (longest_step, allowed) = if method.order() > 2 {
                (0.01, 1e-3)
            } else {
                (0.004, 1.5e-2)
            };
            let (result, curves) = with(method, 0.03, longest_step);
            let worst = (0..4)
                .map(|k| difference(&curves.gauge[k], &exact.gauge[k]))
                .fold(0.0, f64::max);
            let method = method.name();
            eprintln!("{name} {method}: {worst:.1e} {:?}", result.statistics);
            assert!(worst < allowed, "{name} {method}: {worst}");
        }
    }
}

/// Computes the root mean square difference of two curves divided by the range of the second curve.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let square: Vec<f64> = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).collect();
    let low = b.iter().copied().fold(f64::MAX, f64::min);
    let high = b.iter().copied().fold(f64::MIN, f64::max);
    mean(&square).sqrt() / (high - low)
}

/// Returns the unit with twice as many rope cylinders of half the length.
fn halved(unit: &PumpingUnit) -> PumpingUnit {
    let mut fine = unit.clone();
    fine.machine.ropes.cylinder_length_m *= 0.5;
    fine.machine.ropes.back_cylinders *= 2;
    fine.machine.ropes.front_cylinders *= 2;
    fine
}

/// Checks that dividing the rope into cylinders of 25 mm instead of 50 mm changes no gauge by more than 0.5 %
/// of its range (measured: 0.25 % and 0.13 %). The rope stays the same, because its coefficients are scaled
/// with the cylinder length.
#[test]
fn gauges_converge_with_shorter_cylinders() {
    let coarse = unit();
    let fine = halved(&coarse);
    for (name, genes) in individuals(&coarse.case) {
        let [coarse, fine] = [&coarse, &fine].map(|unit| {
            let machine = worker::pumping_unit::machine(unit, 0).unwrap();
            let law = worker::pumping_unit::rope_law(unit, &genes).unwrap();
            let settings = RunSettings {
                method: Method::RungeKutta(&ESDIRK4),
                longest_step: 0.03,
                slow_swing: f64::INFINITY,
                ..worker::pumping_unit::run_settings(&unit.machine)
            };
            run(&machine, &law, &settings).1
        });
        let worst = (0..4)
            .map(|k| difference(&coarse.curves.gauge[k], &fine.curves.gauge[k]))
            .fold(0.0, f64::max);
        eprintln!("{name}: 50 to 25 mm changes a gauge by {worst:.2e} of its range");
        assert!(worst < 5e-3, "{name}: {worst}");
    }
}

/// Checks the documented counts of steps, Newton iterations and factorisations of a default run. Cylinders of
/// half the length change the iterations by less than a tenth.
#[test]
fn a_default_run_costs_what_is_documented() {
    let unit = unit();
    let fine = halved(&unit);
    let documented = [[319, 3_414, 165], [550, 5_961, 471]];
    for ((name, genes), documented) in individuals(&unit.case).into_iter().zip(documented) {
        let [coarse, fine] = [&unit, &fine].map(|unit| {
            let machine = worker::pumping_unit::machine(unit, 0).unwrap();
            let law = worker::pumping_unit::rope_law(unit, &genes).unwrap();
            let settings = worker::pumping_unit::run_settings(&unit.machine);
            run(&machine, &law, &settings).0.statistics
        });
        eprintln!("{name}: {coarse:?}, of half the length {fine:?}");
        let counted = [
            coarse.steps,
            coarse.newton_iterations,
            coarse.factorizations,
        ];
        assert_eq!(counted, documented, "{name}");
        let share = fine.newton_iterations as f64 / coarse.newton_iterations as f64;
        assert!((share - 1.0).abs() < 0.1, "{name}: {share}");
    }
}
