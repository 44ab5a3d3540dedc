//! Tests of the exact motion against Runge-Kutta integration with small steps.
use super::*;
use std::f64::consts::TAU;

const OSCILLATOR: Oscillator = Oscillator {
    mass: 2.3,
    stiffness: 11_500.0,
    damping: 19.0,
    friction: 0.0,
    lag: 0.0,
};

fn drive(hz: f64) -> Drive {
    let turn = TAU * hz;
    Drive {
        force: Sum::cosine(41.0, turn, 0.3).plus(&Sum::cosine(9.0, 3.0 * turn, -1.1)),
        base: Sum::cosine(2e-4, turn, 0.9),
    }
}

/// Integrates the motion with the classical Runge-Kutta method; the mass stands where friction holds it.
fn stepped(o: &Oscillator, drive: &Drive, start: State, span: f64, steps: usize) -> State {
    let base_speed = drive.base.rate();
    let through = |t: f64, x: f64, v: f64| {
        o.stiffness * (x - drive.base.at(t)) + o.damping * (v - base_speed.at(t))
    };
    let h = span / steps as f64;
    let mut y = [start.x, start.v, start.reading];
    for step in 0..steps {
        let t = h * step as f64;
        let pull = drive.force.at(t) - through(t, y[0], 0.0);
        let holds = o.friction >= pull.abs();
        let way = if y[1] == 0.0 {
            pull.signum()
        } else {
            y[1].signum()
        };
        let stands = holds && y[1] == 0.0;
        let slope = |t: f64, y: [f64; 3]| {
            let force = through(t, y[0], y[1]);
            let net = drive.force.at(t) - force - way * o.friction;
            let acceleration = if stands { 0.0 } else { net / o.mass };
            let lagging = if o.lag > 0.0 {
                (force - y[2]) / o.lag
            } else {
                0.0
            };
            [y[1], acceleration, lagging]
        };
        let moved = |k: [f64; 3], by: f64| [0, 1, 2].map(|i| y[i] + by * k[i]);
        let a = slope(t, y);
        let b = slope(t + 0.5 * h, moved(a, 0.5 * h));
        let c = slope(t + 0.5 * h, moved(b, 0.5 * h));
        let d = slope(t + h, moved(c, h));
        let next = [0, 1, 2].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        // a mass that would turn within this step is stopped, and slides on if the pull is enough
        let turns = o.friction > 0.0 && y[1] * next[1] < 0.0;
        y = if turns { [next[0], 0.0, next[2]] } else { next };
    }
    let reading = if o.lag > 0.0 {
        y[2]
    } else {
        through(span, y[0], y[1])
    };
    State {
        x: y[0],
        v: y[1],
        reading,
    }
}

fn assert_close(exact: State, stepped: State, within: f64) {
    let [x, v] = [exact.x - stepped.x, exact.v - stepped.v];
    let force = (exact.reading - stepped.reading) / OSCILLATOR.stiffness;
    assert!(
        x.abs() < within && v.abs() < 100.0 * within && force.abs() < 10.0 * within,
        "{exact:?} {stepped:?}"
    );
}

#[test]
fn without_friction_it_is_what_small_steps_give() {
    let start = State {
        x: 4e-3,
        v: 0.11,
        reading: 20.0,
    };
    for (damping, lag) in [(19.0, 0.0), (19.0, 4e-3), (700.0, 4e-3)] {
        let oscillator = Oscillator {
            damping,
            lag,
            ..OSCILLATOR
        };
        let motion = oscillator.integrate(&drive(5.0), start, 0.37).unwrap();
        let expected = stepped(&oscillator, &drive(5.0), start, 0.37, 4000);
        assert_close(motion.state(0.37).unwrap(), expected, 1e-10);
    }
}

#[test]
fn with_friction_it_slides_and_stands_as_small_steps_do() {
    let start = State {
        x: 6e-3,
        v: 0.0,
        reading: 69.0,
    };
    for (friction, lag) in [(3.0, 0.0), (25.0, 4e-3), (38.0, 0.0)] {
        let oscillator = Oscillator {
            friction,
            lag,
            ..OSCILLATOR
        };
        let motion = oscillator.integrate(&drive(5.0), start, 0.61).unwrap();
        assert!(motion.pieces() > 4, "{}", motion.pieces());
        for part in [0.2, 0.61] {
            let expected = stepped(&oscillator, &drive(5.0), start, part, 200_000);
            assert_close(motion.state(part).unwrap(), expected, 2e-7);
        }
    }
}

/// Checks that a released mass comes to rest where friction holds it, and stays.
#[test]
fn a_mass_that_is_let_go_comes_to_rest() {
    let oscillator = Oscillator {
        friction: 8.0,
        ..OSCILLATOR
    };
    let start = State {
        x: 6e-3,
        v: 0.0,
        reading: 69.0,
    };
    let motion = oscillator.integrate(&Drive::default(), start, 3.0).unwrap();
    let [early, late] = [2.0, 3.0].map(|t| motion.state(t).unwrap());
    assert_eq!(early, late);
    assert!(late.v == 0.0 && (late.x * oscillator.stiffness).abs() <= 8.0);
    // each half swing loses twice the friction over the stiffness, and more by damping
    let peaks = motion.pieces();
    assert!((3..=6).contains(&peaks), "{peaks}");
}

#[test]
fn a_steady_motion_repeats_itself_and_is_reached_from_anywhere() {
    let period = 0.2;
    for friction in [0.0, 4.0] {
        let oscillator = Oscillator {
            friction,
            lag: 2e-3,
            ..OSCILLATOR
        };
        let motion = oscillator.steady(&drive(5.0), period).unwrap();
        let [begin, end] = [0.0, period].map(|t| motion.state(t).unwrap());
        assert_close(begin, end, 1e-11);
        let start = State {
            x: 0.0,
            v: 0.0,
            reading: 0.0,
        };
        let long = oscillator
            .integrate(&drive(5.0), start, 40.0 * period)
            .unwrap();
        assert_close(long.state(40.0 * period).unwrap(), begin, 1e-9);
    }
}

/// Checks the greatest displacement under a harmonic force with dry friction against Den Hartog's solution:
/// over half a period the free part of the motion is known for any phase, and the greatest displacement
/// follows.
#[test]
fn dry_friction_agrees_with_den_hartog() {
    let oscillator = Oscillator {
        friction: 9.0,
        damping: 0.4,
        ..OSCILLATOR
    };
    let (force, hz) = (60.0, 9.0);
    let drive = Drive {
        force: Sum::cosine(force, TAU * hz, 0.0),
        base: Sum::default(),
    };
    let motion = oscillator.steady(&drive, 1.0 / hz).unwrap();
    let seen = (0..4000).map(|i| motion.state(f64::from(i) / 4000.0 / hz).unwrap().x);
    let greatest = seen.fold(0.0, f64::max);
    let own = (oscillator.stiffness / oscillator.mass).sqrt();
    let ratio = TAU * hz / own;
    let response = 1.0 / (1.0 - ratio * ratio);
    let angle = std::f64::consts::PI / ratio;
    let u = angle.sin() / (ratio * (1.0 + angle.cos()));
    let share = oscillator.friction / force;
    let expected =
        force / oscillator.stiffness * (response * response - (share * u).powi(2)).sqrt();
    // his mass has no viscous damping; ours needs a little to forget its start
    assert!(
        (greatest / expected - 1.0).abs() < 0.01,
        "{greatest} {expected}"
    );
}
