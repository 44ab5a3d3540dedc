//! Rope rigs shared by the tests, and functions to find their equilibrium and to integrate them.
use nalgebra::Vector3;
use simulation::element::{bushing::Bushing, impact::Impact};
use simulation::integrator::adaptive::Adaptive;
use simulation::integrator::method::Method;
use simulation::integrator::stepper::TimeStep;
use simulation::integrator::tableau::ESDIRK4;
use simulation::model::chain::Chain;
use simulation::model::description::RopeLaw;
use simulation::rig::{End, Rig, Setup};
use simulation::settle::minimize;
use simulation::system::{State, StateRef, System};

pub(crate) type V3 = Vector3<f64>;

const PER_DEGREE: f64 = 180.0 / std::f64::consts::PI;

/// Returns the recommended coefficients of Table 3 of the paper.
pub(crate) fn recommended() -> RopeLaw {
    RopeLaw {
        bushing: Bushing {
            stiffness: [3.14e8, 1.25e8],
            damping: [400.0, 400.0],
            rotational_stiffness: [110.0 * PER_DEGREE, 137.0 * PER_DEGREE],
            rotational_damping: [40.0 * PER_DEGREE, 40.0 * PER_DEGREE],
            preload: 0.0,
        },
        contact: Impact {
            stiffness: 1.0e6,
            exponent: 1.5,
            damping: 50.0,
            full_damping_penetration: 1e-4,
        },
    }
}

/// Returns the optimised coefficients of Table 3 of the paper.
pub(crate) fn optimised() -> RopeLaw {
    RopeLaw {
        bushing: Bushing {
            stiffness: [7.81e8, 2.26e8],
            damping: [5201.0, 4287.0],
            rotational_stiffness: [204.0 * PER_DEGREE, 308.0 * PER_DEGREE],
            rotational_damping: [45.0 * PER_DEGREE, 56.0 * PER_DEGREE],
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

/// Returns the recommended rope with its rotational coefficients divided by 1000.
pub(crate) fn soft() -> RopeLaw {
    let mut law = recommended();
    law.bushing.rotational_stiffness = law.bushing.rotational_stiffness.map(|k| 1e-3 * k);
    law.bushing.rotational_damping = law.bushing.rotational_damping.map(|c| 1e-3 * c);
    law
}

/// Returns the bushing of a string: almost no bending stiffness, and no damping.
///
/// It is softer along its axis than the unit's rope: the lateral stiffness is a few newtons per metre, and
/// would be lost to rounding beside an axial stiffness of 3e8 N/m (measured: 0.9 % of a frequency).
pub(crate) fn string() -> Bushing {
    Bushing {
        stiffness: [1e6, 1e6],
        damping: [0.0; 2],
        rotational_stiffness: [1e-3, 1e-4],
        rotational_damping: [0.0; 2],
        preload: 0.0,
    }
}

/// Returns a chain of the unit's cylinders: steel, 10 mm thick, 50 mm long.
pub(crate) fn chain(count: usize) -> Chain {
    Chain::solid(0, count, 0.01, 0.05, 7850.0)
}

/// Returns the law of an end joint that lets a rope rotate in the plane but prevents twist; a chain free to
/// twist at both ends has no unique equilibrium.
pub(crate) fn pinned(law: &Bushing) -> Bushing {
    let mut pin = law.revolute();
    pin.rotational_stiffness[0] = law.rotational_stiffness[0];
    pin
}

pub(crate) fn clamped(law: Bushing) -> End {
    End::Held {
        place: V3::zeros(),
        angle: 0.0,
        law,
    }
}

/// Returns a chain with a clamped base at the origin and a free end, without gravity and drum.
pub(crate) fn cantilever(count: usize, law: Bushing) -> Setup {
    Setup {
        chain: chain(count),
        gravity: V3::zeros(),
        joint: law,
        ends: [clamped(law), End::free()],
        drum: None,
    }
}

/// Returns a chain between two pins at one height, `span` apart \[m\], under downward `gravity` \[m/s2\].
pub(crate) fn strung(count: usize, law: Bushing, span: f64, gravity: f64) -> Setup {
    let pin = |x: f64| End::Held {
        place: V3::new(x, 0.0, 0.0),
        angle: 0.0,
        law: pinned(&law),
    };
    Setup {
        gravity: V3::new(0.0, -gravity, 0.0),
        ends: [pin(0.0), pin(span)],
        ..cantilever(count, law)
    }
}

/// Finds the static equilibrium of a rig, starting from coordinates `q`.
pub(crate) fn settled(setup: &Setup, mut q: Vec<f64>) -> (System<Rig>, Vec<f64>) {
    let mut system = System::new(Rig::new(*setup));
    assert!(minimize(&mut system, 0.0, &mut q), "no equilibrium");
    let mut force = vec![0.0; q.len()];
    let still = vec![0.0; q.len()];
    system.forces(StateRef::new(0.0, &q, &still), &mut force);
    (system, q)
}

/// Returns the coordinates of a chain of 5 m sagging as a circular arc of its own length between two points
/// at one height, 4 m apart: `sin(bow) / bow = b / S`.
pub(crate) fn bowed(count: usize, span: f64) -> Vec<f64> {
    let bow = 1.131_102_f64;
    let arc = 0.5 * 0.05 * count as f64 / bow;
    (0..count)
        .flat_map(|j| {
            let angle = bow * ((2 * j + 1) as f64 / count as f64 - 1.0);
            let (s, c) = angle.sin_cos();
            [
                0.5 * span + arc * s,
                arc * (bow.cos() - c),
                0.0,
                0.0,
                0.0,
                angle,
            ]
        })
        .collect()
}

/// Finds the static equilibrium of a rig, starting from a straight chain along +x.
pub(crate) fn settled_straight(setup: &Setup) -> (System<Rig>, Vec<f64>) {
    let q = Rig::new(*setup).straight(V3::zeros(), 0.0);
    settled(setup, q)
}

/// Settings of the time integration of a rig.
#[derive(Clone, Copy)]
pub(crate) struct Course {
    pub(crate) method: Method,
    pub(crate) tolerance: f64,
    pub(crate) longest: f64,
}

impl Course {
    pub(crate) fn accurate(tolerance: f64) -> Self {
        Self {
            method: Method::RungeKutta(&ESDIRK4),
            tolerance,
            longest: 0.01,
        }
    }
}

/// Returns a state at time 0 with the accelerations that satisfy the equations of motion.
pub(crate) fn started(system: &mut System<Rig>, q: Vec<f64>, v: Vec<f64>) -> State {
    let mut state = State::at_rest(0.0, q);
    state.v = v;
    let at = StateRef::new(0.0, &state.q, &state.v);
    system.accelerations(at, &mut state.a).unwrap();
    state
}

/// Integrates a rig from `state` to time `until`; `each` is called with start and end of every accepted step.
pub(crate) fn advance(
    system: &mut System<Rig>,
    course: &Course,
    state: &mut State,
    until: f64,
    mut each: impl FnMut(&State, &State, &TimeStep),
) {
    let mut method = Adaptive::new(course.method, system, course.tolerance, course.longest);
    let mut to = state.clone();
    while state.t < until - 1e-12 {
        if let Some(step) = method.attempt(system, state, until, &mut to).unwrap() {
            each(state, &to, &step);
            std::mem::swap(state, &mut to);
        }
    }
}

/// Parses the numbers of a CSV table, row by row; `#` opens a comment line, the first line names the columns.
pub(crate) fn table(text: &str) -> Vec<Vec<f64>> {
    csv::Reader::from_reader(text.as_bytes())
        .records()
        .map(|row| row.unwrap().iter().map(|x| x.parse().unwrap()).collect())
        .collect()
}
