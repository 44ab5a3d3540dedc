//! A state of the equations of motion, and what is asked of it: plain data.

/// Coordinates, rates and accelerations at a time.
#[derive(Debug, PartialEq)]
pub struct State {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Rates.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
}

/// Written out, since a derived one allocates where it overwrites.
impl Clone for State {
    fn clone(&self) -> Self {
        Self {
            t: self.t,
            q: self.q.clone(),
            v: self.v.clone(),
            a: self.a.clone(),
        }
    }

    fn clone_from(&mut self, other: &Self) {
        self.t = other.t;
        self.q.clone_from(&other.q);
        self.v.clone_from(&other.v);
        self.a.clone_from(&other.a);
    }
}

impl State {
    /// Coordinates and rates alone.
    pub fn motion(&self) -> StateRef<'_> {
        let Self { t, q, v, .. } = self;
        StateRef { t: *t, q, v }
    }

    /// At rest.
    pub fn at_rest(t: f64, q: Vec<f64>) -> Self {
        let n = q.len();
        Self {
            t,
            q,
            v: vec![0.0; n],
            a: vec![0.0; n],
        }
    }
}

/// Coordinates and rates at a time: where forces are asked for.
#[derive(Clone, Copy, Debug)]
pub struct StateRef<'a> {
    /// Time \[s\].
    pub t: f64,
    /// Coordinates.
    pub q: &'a [f64],
    /// Rates.
    pub v: &'a [f64],
}

impl<'a> StateRef<'a> {
    /// Coordinates and rates at a time.
    pub const fn new(t: f64, q: &'a [f64], v: &'a [f64]) -> Self {
        Self { t, q, v }
    }
}

/// What stands beside the stiffness in an iteration matrix `mass M - damping D - K`, where
/// `K = dQ/dq` and `D = dQ/dv`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// Factor of the inertia [1/s2].
    pub mass: f64,
    /// Factor of the damping [1/s].
    pub damping: f64,
}

impl Shift {
    /// The stiffness alone.
    pub const NONE: Self = Self {
        mass: 0.0,
        damping: 0.0,
    };
}

/// Powers and energies at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Powers {
    /// Of the crank pin on the rod \[W\].
    pub input: f64,
    /// Of the suspension point on the load \[W\].
    pub output: f64,
    /// Lost in joints, contact and head \[W\].
    pub dissipated: f64,
}

impl Powers {
    /// Adds `weight` times other powers: work, where the weight is a time.
    pub const fn add(&mut self, weight: f64, powers: &Self) {
        self.input += weight * powers.input;
        self.output += weight * powers.output;
        self.dissipated += weight * powers.dissipated;
    }
}
