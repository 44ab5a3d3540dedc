//! Curves of one revolution, and the machine at a sample: plain data.

/// Curves of one revolution, one entry per sample reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// Stress at gauges 1 to 4 \[Pa\].
    pub gauge: [Vec<f64>; 4],
    /// Tension of the back rope at the crossbeam, of both where there are two \[N\].
    pub back_tension: Vec<f64>,
    /// Tension of the front rope at the suspension point, of both where there are two \[N\].
    pub front_tension: Vec<f64>,
    /// By how much the rope at +z pulls more than the one at -z, back and front \[N\]; empty where
    /// there is one.
    pub tension_difference: [Vec<f64>; 2],
    /// Beam angle \[rad\].
    pub beam: Vec<f64>,
    /// Height of the suspension point in W \[m\], its velocity and acceleration.
    pub suspension: [Vec<f64>; 3],
    /// Net crank torque [N m].
    pub torque: Vec<f64>,
    /// Modal coordinates, mode by mode.
    pub modal: Vec<Vec<f64>>,
    /// Shapes at every `shape_every`-th sample.
    pub shapes: Vec<Shape>,
}

/// The machine at one sample, in W.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Index of the sample.
    pub sample: usize,
    /// Crank pin \[m\].
    pub pin: [f64; 2],
    /// Rope end of the rod \[m\].
    pub crossbeam: [f64; 2],
    /// Beam angle \[rad\].
    pub beam: f64,
    /// Suspension point \[m\].
    pub suspension: [f64; 2],
    /// Cylinder centres of back and front rope from the free end on, of two ropes those at +z \[m\].
    pub centers: [Vec<[f64; 2]>; 2],
    /// Tension in the joint before each cylinder, of both ropes where there are two \[N\].
    pub tension: [Vec<f64>; 2],
    /// Contact force on each cylinder, of both where there are two \[N\].
    pub contact: [Vec<f64>; 2],
}
