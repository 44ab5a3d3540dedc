//! Links of the chain from strain to reading.
use std::fmt::Debug;

/// A link of the chain from strain to reading.
pub trait Reading: Debug + Send + Sync {
    /// Changes the reading of one sample \[Pa\].
    fn sample(&self, _at: &Sampled, _stress: &mut [f64; 4]) {}

    /// Changes the readings of a whole revolution, samples `spacing` \[s\] apart and periodic.
    fn series(&self, _spacing: f64, _stress: &mut [Vec<f64>; 4]) {}
}

/// What a link may know of a sample of the recorded revolution.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// Beam angle \[rad\].
    pub beam: f64,
    /// Share of the recorded revolution that is over, 0 to 1.
    pub elapsed: f64,
    /// Force of the back ropes on their head, in W \[N\].
    pub head_push: [f64; 2],
    /// Tension of the back rope at the crossbeam, of both where there are two \[N\].
    pub back_tension: f64,
    /// Stiffness of one joint between two cylinders of the individual's rope [N/m].
    pub joint_stiffness: f64,
}
