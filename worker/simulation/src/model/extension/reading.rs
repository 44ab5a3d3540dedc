//! Stages of the measuring chain, from stress at the gauge to its reading.
use std::fmt::Debug;

/// Stage of the measuring chain, which converts the stress at the strain gauges to recorded readings.
pub trait Reading: Debug + Send + Sync {
    /// Modifies the readings of the four gauges at one sample \[Pa\].
    fn sample(&self, _at: &SampleState, _stress: &mut [f64; 4]) {}

    /// Returns whether [`Self::sample`] uses more of the sample than the elapsed share of the revolution.
    fn needs_loads(&self) -> bool {
        true
    }

    /// Modifies the readings of the four gauges over a whole revolution \[Pa\]; samples are `spacing` \[s\]
    /// apart and periodic.
    fn series(&self, _spacing: f64, _stress: &mut [Vec<f64>; 4]) {}
}

/// Quantities at one sample of the recorded revolution that are available to a [`Reading`].
#[derive(Clone, Copy, Debug)]
pub struct SampleState {
    /// Beam angle \[rad\].
    pub beam: f64,
    /// Elapsed share of the recorded revolution, 0 to 1.
    pub elapsed: f64,
    /// Force of the back ropes on the back head, in the world frame W \[N\].
    pub head_force: [f64; 2],
    /// Tension of the back rope at the crossbeam \[N\]; the sum for twin ropes.
    pub back_tension: f64,
    /// Stiffness of one joint between two cylinders of the individual's rope [N/m].
    pub joint_stiffness: f64,
}
