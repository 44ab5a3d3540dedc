//! Tests of the order of convergence of every method, bounded on both sides: on a rig in the plane, on a rig
//! that tumbles in space, and on forced equations with a known solution.
use crate::forced::Forced;
use crate::rope::*;
use simulation::element::bushing::Bushing;
use simulation::integrator::bdf::Bdf;
use simulation::integrator::dense::interpolate;
use simulation::integrator::method::{CATALOGUE, Method};
use simulation::integrator::step_control::StepControl;
use simulation::integrator::stepper::Stepper;
use simulation::integrator::tableau::ESDIRK4;
use simulation::rig::{End, Rig};
use simulation::system::State;
use simulation::system::{Equations, System};

/// Accuracy of Newton's method, far below the local error of any step.
const TIGHT: f64 = 1e-8;

/// Integrates over `time` in `steps` equal steps, and returns the final state.
fn equal_steps<E: Equations>(
    system: &mut System<E>,
    mut method: Box<dyn Stepper<E>>,
    mut from: State,
    time: f64,
    steps: usize,
) -> State {
    let mut to = from.clone();
    let begin = from.t;
    for k in 0..steps {
        let h = begin + time * (k + 1) as f64 / steps as f64 - from.t;
        method.step(system, &from, h, &mut to).unwrap();
        method.accept(&system.equations, &to);
        std::mem::swap(&mut from, &mut to);
    }
    from
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

/// Checks that halving the step divides the error by `2^order`; the observed order must lie within 0.3 of
/// `order`.
fn judge(name: &str, order: usize, errors: &[f64]) {
    for pair in errors.windows(2) {
        let found = (pair[0] / pair[1]).log2();
        eprintln!("{name}: {errors:?} order {found:.3}");
        assert!(
            (found - order as f64).abs() < 0.3,
            "{name}: order {found} instead of {order}, errors {errors:?}"
        );
    }
}

/// Builds a damped chain of five cylinders that swings down in the plane.
fn swinging() -> (System<Rig>, State) {
    let law = Bushing {
        stiffness: [900.0, 700.0],
        damping: [0.3, 0.2],
        rotational_stiffness: [0.02, 0.03],
        rotational_damping: [1e-5, 2e-5],
        preload: 0.0,
    };
    let mut setup = cantilever(5, law);
    setup.gravity = V3::new(1.3, -9.81, 0.0);
    let mut system = System::new(Rig::new(setup));
    let q = system.equations.straight(V3::zeros(), 0.0);
    let v = vec![0.0; q.len()];
    let state = started(&mut system, q, v);
    (system, state)
}

/// Builds a free chain of three cylinders that spins about its axis and tumbles in space.
fn tumbling() -> (System<Rig>, State) {
    let law = Bushing {
        stiffness: [400.0, 300.0],
        damping: [0.1, 0.1],
        rotational_stiffness: [2e-3, 3e-3],
        rotational_damping: [1e-6, 2e-6],
        preload: 0.0,
    };
    let mut setup = cantilever(3, law);
    setup.ends = [End::free(); 2];
    let mut system = System::new(Rig::new(setup));
    let q = system.equations.straight(V3::zeros(), 0.3);
    let mut v = vec![0.0; q.len()];
    for (j, v) in v.chunks_exact_mut(6).enumerate() {
        let along = 0.05 * (j as f64 - 1.0);
        (v[0], v[1], v[2]) = (0.1, 4.0 * along, -6.0 * along);
        (v[3], v[4], v[5]) = (30.0 + 10.0 * j as f64, 6.0, 4.0);
    }
    let state = started(&mut system, q, v);
    (system, state)
}

/// Returns the errors of the coordinates with `coarsest`, twice and four times as many steps.
fn errors_on_rig(
    rig: fn() -> (System<Rig>, State),
    time: f64,
    method: Method,
    coarsest: usize,
    exact: &State,
) -> [f64; 3] {
    [1, 2, 4].map(|k| {
        let (mut system, state) = rig();
        let stepper = method.stepper(&system, TIGHT);
        let end = equal_steps(&mut system, stepper, state, time, k * coarsest);
        largest_difference(&end.q, &exact.q)
    })
}

/// Checks the order of every method on a rig in the plane against 20,000 steps of the fourth-order method.
#[test]
fn halving_the_step_divides_the_error_by_two_to_the_order() {
    let (mut system, state) = swinging();
    let stepper = Method::RungeKutta(&ESDIRK4).stepper(&system, 1e-7);
    let exact = equal_steps(&mut system, stepper, state, 0.2, 20_000);
    for method in CATALOGUE {
        let (method, order) = fixed(method);
        let coarsest = if order == 4 { 200 } else { 400 };
        let errors = errors_on_rig(swinging, 0.2, method, coarsest, &exact);
        judge(method.name(), order, &errors);
    }
}

/// Returns the method and its order with equal steps. A method of variable order starts with order 1 and
/// keeps it at equal steps; its higher orders are tested from a known history in
/// `each_backward_differentiation_formula_has_its_order`.
fn fixed(method: Method) -> (Method, usize) {
    match method {
        Method::Bdf { .. } => (Method::Bdf { highest: 1 }, 1),
        Method::RungeKutta(_) | Method::Rosenbrock | Method::GeneralizedAlpha { .. } => {
            (method, method.order())
        }
    }
}

/// Checks the order of every method in space, where inertia depends on the angles and velocity terms matter:
/// the Rosenbrock method has its order only with the complete tangent.
#[test]
fn order_holds_for_a_chain_that_tumbles_in_space() {
    let (mut system, state) = tumbling();
    // linear solutions leave no residual of Newton's method behind
    let stepper = Method::Rosenbrock.stepper(&system, TIGHT);
    let exact = equal_steps(&mut system, stepper, state, 0.1, 3_000);
    let tilt = exact.q.chunks(6).map(|q| q[4].abs()).fold(0.0, f64::max);
    assert!(tilt > 0.3, "stayed in its plane: {tilt}");
    for method in CATALOGUE {
        let (method, order) = fixed(method);
        let coarsest = [0, 800, 100, 0, 40][order];
        let errors = errors_on_rig(tumbling, 0.1, method, coarsest, &exact);
        judge(method.name(), order, &errors);
    }
}

/// Checks the order of every method on forced nonlinear equations with a variable mass matrix and a known
/// solution: in coordinates and rates, and in accelerations to at least the order that the dense output
/// needs.
#[test]
fn order_holds_for_forced_equations_with_a_known_solution() {
    for method in CATALOGUE {
        let (method, order) = fixed(method);
        let coarsest = if order == 4 { 40 } else { 100 };
        let ends = [1, 2, 4].map(|k| {
            let mut system = System::new(Forced);
            let stepper = method.stepper(&system, TIGHT);
            let start = Forced::exact(0.3);
            equal_steps(&mut system, stepper, start, 1.0, k * coarsest)
        });
        let exact = Forced::exact(1.3);
        let name = method.name();
        judge(
            name,
            order,
            &ends
                .each_ref()
                .map(|end| largest_difference(&end.q, &exact.q)),
        );
        judge(
            name,
            order,
            &ends
                .each_ref()
                .map(|end| largest_difference(&end.v, &exact.v)),
        );
        let accelerations = ends.map(|end| largest_difference(&end.a, &exact.a));
        eprintln!("{name}: accelerations {accelerations:?}");
        assert!(accelerations[2] < 0.6 * accelerations[1]);
    }
}

/// Checks the order of the backward differentiation formulas of order 1 and 2, started from a known history.
#[test]
fn each_backward_differentiation_formula_has_its_order() {
    for order in 1..=2 {
        let coarsest = [400, 200][order - 1];
        let errors = [1, 2, 4].map(|k| {
            let h = 1.0 / (k * coarsest) as f64;
            let past: Vec<State> = (0..=order)
                .map(|i| Forced::exact(0.3 - h * i as f64))
                .collect();
            let mut system = System::new(Forced);
            let method = Box::new(Bdf::continuing(order, &past, TIGHT));
            let end = equal_steps(&mut system, method, past[0].clone(), 1.0, k * coarsest);
            largest_difference(&end.q, &Forced::exact(1.3).q)
        });
        judge(&format!("bdf of order {order}"), order, &errors);
    }
}

/// Checks that multistep methods keep their order with steps of varying size: generalised-alpha shifts its
/// accelerations, backward differentiation its interpolation points.
#[test]
fn order_survives_steps_of_changing_size() {
    let uneven = |method: Method, steps: usize| {
        let mut system = System::new(Forced);
        let mut stepper = method.stepper(&system, TIGHT);
        let mut from = Forced::exact(0.3);
        let mut to = from.clone();
        for k in 0..steps {
            let h = (if k % 2 == 0 { 1.3 } else { 0.7 }) / steps as f64;
            stepper.step(&mut system, &from, h, &mut to).unwrap();
            stepper.accept(&system.equations, &to);
            std::mem::swap(&mut from, &mut to);
        }
        largest_difference(&from.q, &Forced::exact(1.3).q)
    };
    for (method, order) in [
        (
            Method::GeneralizedAlpha {
                spectral_radius: 0.5,
            },
            2,
        ),
        (
            Method::GeneralizedAlpha {
                spectral_radius: 0.0,
            },
            2,
        ),
        (
            Method::GeneralizedAlpha {
                spectral_radius: 1.0,
            },
            2,
        ),
        (Method::Bdf { highest: 1 }, 1),
    ] {
        let errors = [200, 400, 800].map(|steps| uneven(method, steps));
        judge(&format!("{method:?}, uneven"), order, &errors);
    }
}

/// Checks the backward differentiation formula of order 2, started from a known history, with steps of 1.3
/// and 0.7 in turn: its points lie as unevenly as in a run with variable steps.
#[test]
fn order_2_of_backward_differentiation_survives_uneven_steps() {
    let errors = [200, 400, 800].map(|steps| {
        let h = 1.0 / f64::from(steps);
        let past = [0.0, 0.7, 2.0].map(|back| Forced::exact(0.3 - back * h));
        let mut system = System::new(Forced);
        let mut method = Bdf::continuing(2, &past, TIGHT);
        let mut from = past[0].clone();
        let mut to = from.clone();
        for k in 0..steps {
            let h = if k % 2 == 0 { 1.3 * h } else { 0.7 * h };
            method.step(&mut system, &from, h, &mut to).unwrap();
            method.accept(&system.equations, &to);
            std::mem::swap(&mut from, &mut to);
        }
        assert_eq!(method.order(), 2);
        largest_difference(&from.q, &Forced::exact(1.3).q)
    });
    judge("bdf of order 2, uneven", 2, &errors);
}

/// Integrates with step control at a small tolerance; returns the number of steps and the highest order
/// chosen.
fn chosen(highest: usize) -> (usize, usize) {
    let tolerance = 1e-6;
    let mut system = System::new(Forced);
    // Newton's method leaves 3e-9, far below the error that is aimed at
    let mut method = Bdf::new(highest, 6, 1e-3);
    let mut from = Forced::exact(0.3);
    let mut to = from.clone();
    let (mut h, mut steps, mut most) = (1e-4, 0, 1);
    while from.t < 2.3 {
        let done = method.step(&mut system, &from, h, &mut to).unwrap();
        let control = StepControl {
            order: Stepper::<Forced>::error_order(&method),
            tolerance,
            longest: 1.0,
            shortest: 0.0,
        };
        if done.error > tolerance {
            Stepper::<Forced>::reject(&mut method);
            h *= control.factor(done.error).min(0.7);
            continue;
        }
        method.accept(&system.equations, &to);
        h = Stepper::<Forced>::next(&mut method, &control, h, done.error);
        std::mem::swap(&mut from, &mut to);
        steps += 1;
        most = most.max(method.order());
    }
    let error = largest_difference(&from.q, &Forced::exact(from.t).q);
    eprintln!("up to order {highest}: {steps} steps, order {most}, error {error:.1e}");
    assert!(error < 1e-3, "up to order {highest}: {error}");
    (steps, most)
}

/// Checks that backward differentiation chooses higher orders where they save steps, and never exceeds the
/// maximum order.
#[test]
fn backward_differentiation_chooses_the_order_that_pays() {
    let [first, second] = [1, 2].map(chosen);
    assert_eq!([first.1, second.1], [1, 2]);
    assert!(2 * second.0 < first.0, "{first:?} {second:?}");
}

/// Checks that the error of the dense output between two exact states falls with the fourth power of the
/// step.
#[test]
fn dense_output_is_of_fourth_order() {
    let mut out = Forced::exact(0.0);
    let errors = [0.1, 0.05, 0.025].map(|h| {
        let (from, to) = (Forced::exact(0.3), Forced::exact(0.3 + h));
        interpolate(&from, &to, 0.3 + 0.4 * h, &mut out);
        largest_difference(&out.q, &Forced::exact(0.3 + 0.4 * h).q)
    });
    judge("dense output", 4, &errors);
}
