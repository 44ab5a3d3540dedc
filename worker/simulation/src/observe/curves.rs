//! Curves recorded over one revolution, and the machine's shape at a sample, as plain data.

/// Curves recorded over one revolution, with one value per recorded sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// Stress at gauges 1 to 4 \[Pa\].
    pub gauge: [Vec<f64>; 4],
    /// Tension of the back rope at the crossbeam \[N\]; the sum for twin ropes.
    pub back_tension: Vec<f64>,
    /// Tension of the front rope at the suspension point \[N\]; the sum for twin ropes.
    pub front_tension: Vec<f64>,
    /// Tension of the rope at +z minus that of the rope at -z, back and front \[N\]; empty for single ropes.
    pub tension_difference: [Vec<f64>; 2],
    /// Beam angle \[rad\].
    pub beam: Vec<f64>,
    /// Height of the suspension point in the world frame W \[m\], its velocity and its acceleration.
    pub suspension: [Vec<f64>; 3],
    /// Net crank torque [N m].
    pub torque: Vec<f64>,
    /// Modal coordinates of the back head, for each mode.
    pub modal: Vec<Vec<f64>>,
    /// Loads of the back head; empty unless requested.
    pub head_loads: HeadLoadCurves,
    /// Shapes of the machine, one at every `shape_every`-th sample (see [`Recorder`](super::Recorder)).
    pub shapes: Vec<Shape>,
}

/// Loads of the back head, with one value per recorded sample: its stress anywhere is a linear function of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeadLoadCurves {
    /// Inward normal force of the rope in each interval of the arc (`load_breaks`) \[N\]; the sum for twin ropes.
    pub normal: Vec<Vec<f64>>,
    /// Force of the rope's end on the head, inwards and towards increasing psi \[N\].
    pub anchor: [Vec<f64>; 2],
    /// Acceleration of the beam frame along its x and y, with gravity as an acceleration upwards [m/s2], and about the
    /// pivot [rad/s2].
    pub acceleration: [Vec<f64>; 3],
    /// Modal coordinates less their static response to these loads [kg^1/2 m].
    pub beyond: Vec<Vec<f64>>,
}

/// Positions of the machine's moving bodies and loads of its ropes at one sample, in the world frame W.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Index of the sample at which the shape was recorded.
    pub sample: usize,
    /// Position of the crank pin \[m\].
    pub pin: [f64; 2],
    /// Position of the crossbeam, where the rod meets the back rope \[m\].
    pub crossbeam: [f64; 2],
    /// Beam angle \[rad\].
    pub beam: f64,
    /// Position of the suspension point \[m\].
    pub suspension: [f64; 2],
    /// Cylinder centres of the back and front rope, starting at the base end; of twin ropes, those of the
    /// rope at +z \[m\].
    pub centers: [Vec<[f64; 2]>; 2],
    /// Tension in the joint before each cylinder \[N\]; the sum for twin ropes.
    pub tension: [Vec<f64>; 2],
    /// Contact force on each cylinder \[N\]; the sum for twin ropes.
    pub contact: [Vec<f64>; 2],
}
