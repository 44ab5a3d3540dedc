//! Exact motion of the mass as pieces between standstills, each a sum of exponentials.
//!
//! With dry friction the equation is linear as long as the mass slides in one direction, and the mass stands
//! while the force on it does not exceed the friction. A motion is therefore divided where its velocity
//! changes sign; only those times are found numerically. Without dry friction there is one piece. All
//! quantities are in SI units; sensor errors, units of the case and conditions are handled elsewhere.
use crate::sum::Sum;
use nalgebra::Complex;

/// Parameters of the mass, its springs and damper, friction and force sensor.
#[derive(Clone, Copy, Debug)]
pub struct Oscillator {
    /// Moving mass \[kg\].
    pub mass: f64,
    /// Stiffness of both springs in parallel [N/m].
    pub stiffness: f64,
    /// Viscous damping coefficient between mass and foundation [N s/m].
    pub damping: f64,
    /// Dry friction force on the mass \[N\]; not negative.
    pub friction: f64,
    /// Time constant of the force sensor \[s\]; not negative.
    pub lag: f64,
}

/// Excitation of the oscillator: shaker force and foundation motion, as functions of time.
#[derive(Clone, Debug, Default)]
pub struct Drive {
    /// Force of the shaker on the mass \[N\].
    pub force: Sum,
    /// Displacement of the foundation \[m\].
    pub base: Sum,
}

/// State of the oscillator's mass and of its force sensor at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Displacement of the mass \[m\].
    pub x: f64,
    /// Velocity of the mass [m/s].
    pub v: f64,
    /// Reading of the force sensor \[N\].
    pub reading: f64,
}

/// Part of a motion between two standstills: sliding in one direction, or one standstill.
#[derive(Clone, Debug)]
struct Piece {
    begins: f64,
    x: Sum,
    v: Sum,
    reading: Sum,
}

impl Piece {
    fn state(&self, t: f64) -> State {
        let t = t - self.begins;
        State {
            x: self.x.at(t),
            v: self.v.at(t),
            reading: self.reading.at(t),
        }
    }
}

/// Motion over an interval of time, as consecutive pieces that each slide in one direction or stand still.
#[derive(Clone, Debug)]
pub struct Motion(Vec<Piece>);

impl Motion {
    /// Returns the state of mass and sensor at a time \[s\]; `None` for an empty motion.
    pub fn state(&self, t: f64) -> Option<State> {
        let piece = self.0.iter().rev().find(|piece| piece.begins <= t);
        Some(piece.or(self.0.first())?.state(t))
    }

    /// Returns the number of intervals of sliding or standstill that the motion consists of.
    pub const fn pieces(&self) -> usize {
        self.0.len()
    }
}

/// Error for a motion that neither comes to rest nor becomes periodic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotPeriodic;

/// Maximum number of intervals of sliding or standstill in one motion.
const MOST_PIECES: usize = 2000;
/// Maximum number of periods in which a driven motion must become periodic, to the relative tolerance
/// `REPEATS`.
const MOST_PERIODS: usize = 600;
const REPEATS: f64 = 1e-11;
/// Number of velocity samples per radian of the fastest component of the motion, among which a change of sign
/// is searched for.
const SAMPLES_PER_RADIAN: f64 = 8.0;

impl Oscillator {
    /// Computes the periodic motion under a periodic excitation of period `period` \[s\].
    ///
    /// # Errors
    /// [`NotPeriodic`] if the motion with dry friction does not become periodic.
    pub fn steady(&self, drive: &Drive, period: f64) -> Result<Motion, NotPeriodic> {
        let x = self.steady_response(drive);
        let free = self.piece(drive, 0.0, x, None);
        if self.friction <= 0.0 {
            return Ok(Motion(vec![free]));
        }
        let mut state = free.state(0.0);
        for _ in 0..MOST_PERIODS {
            let motion = self.integrate(drive, state, period)?;
            let end = motion.state(period).ok_or(NotPeriodic)?;
            let size = state.x.abs() + state.reading.abs() / self.stiffness;
            let change =
                (end.x - state.x).abs() + (end.reading - state.reading).abs() / self.stiffness;
            if change <= REPEATS * size {
                return Ok(motion);
            }
            state = end;
        }
        Err(NotPeriodic)
    }

    /// Computes the motion from an initial state over a duration `span` \[s\].
    ///
    /// # Errors
    /// [`NotPeriodic`] if the motion alternates between sliding and standstill too often.
    pub fn integrate(&self, drive: &Drive, start: State, span: f64) -> Result<Motion, NotPeriodic> {
        let mut pieces = Vec::new();
        let (mut state, mut now) = (start, 0.0);
        let mut stood = false;
        while pieces.len() < MOST_PIECES {
            let way = self.sliding_direction(drive, &state, now, stood);
            let x = match way {
                Some(way) => self.sliding(drive, &state, now, way),
                None => Sum::constant(state.x),
            };
            let piece = self.piece(drive, now, x, Some(state.reading));
            let end = self.end(drive, &piece, way, span);
            state = piece.state(end);
            pieces.push(piece);
            if end >= span {
                return Ok(Motion(pieces));
            }
            // the velocity is zero there, but for rounding
            (state.v, now, stood) = (0.0, end, way.is_none());
        }
        Err(NotPeriodic)
    }

    /// Returns the sign of the velocity just after a state: `None` if the mass stands, 0 without dry
    /// friction, where the sign is not needed. A mass that `stood` until now slides, because its friction has
    /// been overcome, regardless of rounding.
    fn sliding_direction(
        &self,
        drive: &Drive,
        state: &State,
        now: f64,
        stood: bool,
    ) -> Option<f64> {
        if self.friction <= 0.0 {
            return Some(0.0);
        }
        if state.v != 0.0 {
            return Some(state.v.signum());
        }
        let pull = self
            .applied_force(drive, &Sum::constant(state.x), now)
            .at(0.0);
        (stood || pull.abs() > self.friction).then(|| pull.signum())
    }

    /// Computes the force on the mass without dry friction, as a function of the time since `now`.
    fn applied_force(&self, drive: &Drive, x: &Sum, now: f64) -> Sum {
        let through = self.through_springs(drive, x, now);
        drive
            .force
            .since(now)
            .plus(&through.filtered(|_| (-1.0).into()))
    }

    /// Computes the force on the foundation through springs and damper, as a function of the time since
    /// `now`.
    fn through_springs(&self, drive: &Drive, x: &Sum, now: f64) -> Sum {
        let base = drive.base.since(now).filtered(|_| (-1.0).into());
        x.clone()
            .plus(&base)
            .filtered(|s| s * self.damping + self.stiffness)
    }

    /// Computes the displacement of the mass in the steady-state response to the excitation, without dry
    /// friction.
    fn steady_response(&self, drive: &Drive) -> Sum {
        let by_base = drive.base.filtered(|s| s * self.damping + self.stiffness);
        drive
            .force
            .clone()
            .plus(&by_base)
            .filtered(|s| (s * s * self.mass + s * self.damping + self.stiffness).inv())
    }

    /// Computes the displacement of the mass while it slides from a state in the direction `way` (1 or -1).
    fn sliding(&self, drive: &Drive, state: &State, now: f64, way: f64) -> Sum {
        let held = Sum::constant(-way * self.friction / self.stiffness);
        let rest = self.steady_response(drive).since(now).plus(&held);
        let [r, q] = self.own_rates();
        let (dx, dv) = (state.x - rest.at(0.0), state.v - rest.rate().at(0.0));
        let a = (-q * dx + dv) / (r - q);
        rest.plus(&Sum::term(a, r)).plus(&Sum::term(-a + dx, q))
    }

    /// Computes the eigenvalues of the free motion [1/s]; equal eigenvalues are separated by a relative 1e-6,
    /// so that the solution stays a sum of two exponentials.
    fn own_rates(&self) -> [Complex<f64>; 2] {
        let half = 0.5 * self.damping / self.mass;
        let square = self.stiffness / self.mass;
        let apart = half * half - square;
        let root = Complex::from(if apart.abs() < 1e-12 * square {
            1e-12 * square
        } else {
            apart
        });
        [root.sqrt() - half, -root.sqrt() - half]
    }

    /// Builds the part of a motion with displacement `x`, adding velocity and reading of the force sensor.
    /// `last` is the initial reading; without it, the sensor is in its steady state.
    fn piece(&self, drive: &Drive, begins: f64, x: Sum, last: Option<f64>) -> Piece {
        let force = self.through_springs(drive, &x, begins);
        let reading = if self.lag > 0.0 {
            let late = force.filtered(|s| (s * self.lag + 1.0).inv());
            let missing = last.map_or(0.0, |last| last - late.at(0.0));
            late.plus(&Sum::term(missing.into(), (-1.0 / self.lag).into()))
        } else {
            force
        };
        Piece {
            begins,
            v: x.rate(),
            x,
            reading,
        }
    }

    /// Finds the end of a sliding interval (change of sign of the velocity) or of a standstill (force above
    /// the friction), at most `span` \[s\].
    fn end(&self, drive: &Drive, piece: &Piece, way: Option<f64>, span: f64) -> f64 {
        let over: Box<dyn Fn(f64) -> bool> = match way {
            Some(0.0) => return span,
            Some(way) => Box::new(move |t| piece.v.at(t) * way < 0.0),
            None => {
                let pull = self.applied_force(drive, &piece.x, piece.begins);
                Box::new(move |t| pull.at(t).abs() > self.friction)
            }
        };
        let own = (self.stiffness / self.mass).sqrt();
        let fastest = own.max(drive.force.fastest()).max(drive.base.fastest());
        let step = 1.0 / (SAMPLES_PER_RADIAN * fastest);
        let length = span - piece.begins;
        let mut before = 0.0;
        while before < length {
            let after = (before + step).min(length);
            if over(after) {
                return piece.begins + boundary(&over, before, after);
            }
            before = after;
        }
        span
    }
}

/// Bisects to machine precision for the time at which a condition that is false at `before` and true at
/// `after` becomes true.
fn boundary(is_so: &dyn Fn(f64) -> bool, mut before: f64, mut after: f64) -> f64 {
    loop {
        let middle = f64::midpoint(before, after);
        if middle <= before || middle >= after {
            return after;
        }
        if is_so(middle) {
            after = middle;
        } else {
            before = middle;
        }
    }
}

#[cfg(test)]
mod tests;
