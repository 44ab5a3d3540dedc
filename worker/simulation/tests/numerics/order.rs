//! Order of convergence, two-sided.
use crate::rope::*;
use simulation::element::bushing::Bushing;
use simulation::integrator::esdirk::Esdirk;
use simulation::integrator::tableau::{ESDIRK4, TR_BDF2, Tableau};
use simulation::rig::Rig;
use simulation::system::System;

/// Coordinates of a damped swinging chain after 0.2 s in `steps` equal steps.
fn swung(method: &'static Tableau, steps: u32) -> Vec<f64> {
    let law = Bushing {
        stiffness: [900.0, 700.0],
        damping: [0.3, 0.2],
        rotational_stiffness: [0.02, 0.03],
        rotational_damping: [1e-5, 2e-5],
    };
    let mut setup = cantilever(5, law);
    setup.gravity = V3::new(1.3, -9.81, 0.0);
    let mut system = System::new(Rig::new(setup));
    let q = system.equations.straight(V3::zeros(), 0.0);
    let v = vec![0.0; q.len()];
    let mut from = started(&mut system, q, v);
    let mut to = from.clone();
    let mut method = Esdirk::new(method, from.q.len(), 1e-7);
    let h = 0.2 / f64::from(steps);
    for _ in 0..steps {
        method.step(&mut system, &from, h, &mut to).unwrap();
        std::mem::swap(&mut from, &mut to);
    }
    from.q
}

/// Halving the step divides the global error by `2^p`, and not by more: a lost order and a
/// mislabelled one both show. Coordinates are compared with 20,000 steps of the fourth-order method.
#[test]
fn halving_the_step_divides_the_error_by_two_to_the_order() {
    let exact = swung(&ESDIRK4, 20_000);
    for (method, coarsest) in [(&TR_BDF2, 400), (&ESDIRK4, 200)] {
        let error = |steps: u32| {
            swung(method, steps)
                .iter()
                .zip(&exact)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max)
        };
        let errors = [1, 2, 4].map(|k| error(k * coarsest));
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            eprintln!("{} {errors:?} order {order:.3}", method.name);
            assert!(
                (order - f64::from(method.order)).abs() < 0.3,
                "{}: order {order}, errors {errors:?}",
                method.name
            );
        }
    }
}
