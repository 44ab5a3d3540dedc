//! How the mass moves, exactly: pieces between standstills, each a sum of exponentials.
//!
//! With dry friction the equation is linear as long as the mass slides one way, and the mass stands
//! while nothing overcomes the friction. So a motion is cut where its velocity changes sign; only
//! those moments are searched for numerically. Without dry friction there is one piece. Sensors that
//! read wrongly, units and conditions are not known here: everything is in SI.
use crate::sum::Sum;
use nalgebra::Complex;

/// The mass with its springs and dampers.
#[derive(Clone, Copy, Debug)]
pub struct Oscillator {
    /// Moving mass \[kg\].
    pub mass: f64,
    /// Stiffness of both springs together [N/m].
    pub stiffness: f64,
    /// Viscous damping [N s/m].
    pub damping: f64,
    /// Dry friction \[N\]; not negative.
    pub friction: f64,
    /// Time constant of the force sensor \[s\]; not negative.
    pub lag: f64,
}

/// What moves it.
#[derive(Clone, Debug, Default)]
pub struct Drive {
    /// Force on the mass \[N\].
    pub force: Sum,
    /// Displacement of the foundation \[m\].
    pub base: Sum,
}

/// Where a motion begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Displacement of the mass \[m\].
    pub x: f64,
    /// Its velocity [m/s].
    pub v: f64,
    /// Reading of the force sensor \[N\].
    pub reading: f64,
}

/// A part of a motion without a standstill, or one standstill.
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

/// A motion over some time.
#[derive(Clone, Debug)]
pub struct Motion(Vec<Piece>);

impl Motion {
    /// The state at a time \[s\] that is not before its beginning.
    pub fn state(&self, t: f64) -> Option<State> {
        let piece = self.0.iter().rev().find(|piece| piece.begins <= t);
        Some(piece.or(self.0.first())?.state(t))
    }

    /// Number of its pieces.
    pub const fn pieces(&self) -> usize {
        self.0.len()
    }
}

/// No motion: it neither comes to rest nor repeats itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Restless;

/// Pieces of one motion before it is given up.
const MOST_PIECES: usize = 2000;
/// Periods after which a driven motion must repeat itself, and how well, relative to its size.
const MOST_PERIODS: usize = 600;
const REPEATS: f64 = 1e-11;
/// Looks at the velocity in every radian of the fastest part of the motion.
const LOOKS: f64 = 8.0;

impl Oscillator {
    /// The motion that repeats itself after `period` \[s\].
    ///
    /// # Errors
    /// [`Restless`] where dry friction and drive find no common rhythm.
    pub fn steady(&self, drive: &Drive, period: f64) -> Result<Motion, Restless> {
        let x = self.answer(drive);
        let free = self.piece(drive, 0.0, x, None);
        if self.friction <= 0.0 {
            return Ok(Motion(vec![free]));
        }
        let mut state = free.state(0.0);
        for _ in 0..MOST_PERIODS {
            let motion = self.go(drive, state, period)?;
            let end = motion.state(period).ok_or(Restless)?;
            let size = state.x.abs() + state.reading.abs() / self.stiffness;
            let change =
                (end.x - state.x).abs() + (end.reading - state.reading).abs() / self.stiffness;
            if change <= REPEATS * size {
                return Ok(motion);
            }
            state = end;
        }
        Err(Restless)
    }

    /// The motion from a state on, for `span` \[s\].
    ///
    /// # Errors
    /// [`Restless`] where it stops and goes on without end.
    pub fn go(&self, drive: &Drive, start: State, span: f64) -> Result<Motion, Restless> {
        let mut pieces = Vec::new();
        let (mut state, mut now) = (start, 0.0);
        let mut stood = false;
        while pieces.len() < MOST_PIECES {
            let way = self.way(drive, &state, now, stood);
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
        Err(Restless)
    }

    /// The sign of the velocity from a state on; none where the mass stands, and 0 without dry friction,
    /// when it makes no difference. What `stood` till now has been overcome, whatever the last bit says.
    fn way(&self, drive: &Drive, state: &State, now: f64, stood: bool) -> Option<f64> {
        if self.friction <= 0.0 {
            return Some(0.0);
        }
        if state.v != 0.0 {
            return Some(state.v.signum());
        }
        let pull = self.pull(drive, &Sum::constant(state.x), now).at(0.0);
        (stood || pull.abs() > self.friction).then(|| pull.signum())
    }

    /// Force on the mass beside dry friction, from `now` on.
    fn pull(&self, drive: &Drive, x: &Sum, now: f64) -> Sum {
        let through = self.through_springs(drive, x, now);
        drive
            .force
            .since(now)
            .plus(&through.through(|_| (-1.0).into()))
    }

    /// Force on the foundation through springs and damper, from `now` on.
    fn through_springs(&self, drive: &Drive, x: &Sum, now: f64) -> Sum {
        let base = drive.base.since(now).through(|_| (-1.0).into());
        x.clone()
            .plus(&base)
            .through(|s| s * self.damping + self.stiffness)
    }

    /// What the drive alone brings about in the long run.
    fn answer(&self, drive: &Drive) -> Sum {
        let by_base = drive.base.through(|s| s * self.damping + self.stiffness);
        drive
            .force
            .clone()
            .plus(&by_base)
            .through(|s| (s * s * self.mass + s * self.damping + self.stiffness).inv())
    }

    /// Sliding from a state on, towards positive or negative x.
    fn sliding(&self, drive: &Drive, state: &State, now: f64, way: f64) -> Sum {
        let held = Sum::constant(-way * self.friction / self.stiffness);
        let rest = self.answer(drive).since(now).plus(&held);
        let [r, q] = self.own_rates();
        let (dx, dv) = (state.x - rest.at(0.0), state.v - rest.rate().at(0.0));
        let a = (-q * dx + dv) / (r - q);
        rest.plus(&Sum::term(a, r)).plus(&Sum::term(-a + dx, q))
    }

    /// Rates of the free motion [1/s]; two that are equal are taken apart by a millionth.
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

    /// A piece of this displacement with what the force sensor reads, from its last reading on; none
    /// where it has read for ever.
    fn piece(&self, drive: &Drive, begins: f64, x: Sum, last: Option<f64>) -> Piece {
        let force = self.through_springs(drive, &x, begins);
        let reading = if self.lag > 0.0 {
            let late = force.through(|s| (s * self.lag + 1.0).inv());
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

    /// When a piece ends: its velocity changes sign, or the pull overcomes the friction; `span` at the
    /// latest.
    fn end(&self, drive: &Drive, piece: &Piece, way: Option<f64>, span: f64) -> f64 {
        let over: Box<dyn Fn(f64) -> bool> = match way {
            Some(0.0) => return span,
            Some(way) => Box::new(move |t| piece.v.at(t) * way < 0.0),
            None => {
                let pull = self.pull(drive, &piece.x, piece.begins);
                Box::new(move |t| pull.at(t).abs() > self.friction)
            }
        };
        let own = (self.stiffness / self.mass).sqrt();
        let fastest = own.max(drive.force.fastest()).max(drive.base.fastest());
        let step = 1.0 / (LOOKS * fastest);
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

/// The first moment, to the last bit, of what is not yet so at `before` and is so at `after`.
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
