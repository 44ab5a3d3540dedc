//! State of the equations of motion, and data types for its evaluation.

/// State of the equations of motion: coordinates, rates and accelerations at a time.
#[derive(Debug, PartialEq)]
pub struct State {
    /// Time \[s\].
    pub t: f64,
    /// Generalised coordinates.
    pub q: Vec<f64>,
    /// Rates of the coordinates.
    pub v: Vec<f64>,
    /// Accelerations of the coordinates.
    pub a: Vec<f64>,
}

/// Manual implementation, since a derived `clone_from` would allocate instead of reusing the vectors.
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
    /// Returns the coordinates and rates without accelerations.
    pub fn motion(&self) -> StateRef<'_> {
        let Self { t, q, v, .. } = self;
        StateRef { t: *t, q, v }
    }

    /// Creates a state at rest: zero rates and accelerations.
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

/// Coordinates and rates at a time, the point at which forces are evaluated.
#[derive(Clone, Copy, Debug)]
pub struct StateRef<'a> {
    /// Time \[s\].
    pub t: f64,
    /// Generalised coordinates.
    pub q: &'a [f64],
    /// Rates of the coordinates.
    pub v: &'a [f64],
}

impl<'a> StateRef<'a> {
    /// Creates a reference to coordinates and rates at a time.
    pub const fn new(t: f64, q: &'a [f64], v: &'a [f64]) -> Self {
        Self { t, q, v }
    }
}

/// Factors of inertia and damping in an iteration matrix `mass M - damping D - K`, where `K = dQ/dq` and `D =
/// dQ/dv`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateShift {
    /// Factor of the mass matrix `M` in the iteration matrix [1/s2].
    pub mass: f64,
    /// Factor of the damping matrix `D` in the iteration matrix [1/s].
    pub damping: f64,
}

impl StateShift {
    /// Factors of zero for inertia and damping: the matrix is the stiffness `-K` alone.
    pub const NONE: Self = Self {
        mass: 0.0,
        damping: 0.0,
    };
}

/// Powers at one instant, or their integrals over time (work).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Powers {
    /// Power of the crank pin on the rod \[W\]; as work \[J\].
    pub input: f64,
    /// Power of the suspension point on the load \[W\]; as work \[J\].
    pub output: f64,
    /// Power dissipated in joints, contact and head \[W\]; as work \[J\].
    pub dissipated: f64,
}

impl Powers {
    /// Adds `other` multiplied by `weight`; if the weight is a time step, powers are integrated to work.
    pub const fn add(&mut self, weight: f64, powers: &Self) {
        self.input += weight * powers.input;
        self.output += weight * powers.output;
        self.dissipated += weight * powers.dissipated;
    }
}
