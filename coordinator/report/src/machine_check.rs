//! Quantities of the machine by which a fit is judged beside its objective.
use protocol::case::Channel;
use serde::Serialize;

/// Quantity of the machine under one condition, before and after a fit, with its measured value and its limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MachineCheck {
    /// Name of the condition.
    pub condition: String,
    /// Name of the quantity, such as `stroke`.
    pub quantity: &'static str,
    /// Unit of the values.
    pub unit: &'static str,
    /// Measured value; `None` if it was not measured.
    pub measured: Option<f64>,
    /// Value before the fit: with the recommended parameters, or without the effects that a diagnosis added.
    pub before: Option<f64>,
    /// Value after the fit.
    pub after: Option<f64>,
    /// Value that the machine allows; `None` if none is stated.
    pub limit: Option<f64>,
    /// Reason not to trust the fit, as a sentence; `None` if there is none.
    pub flag: Option<String>,
}

/// Measured and simulated curves of one channel under a condition.
#[derive(Clone, Copy, Debug)]
pub struct ComparedChannel<'a> {
    /// Name, unit and abscissa of the channel.
    pub channel: &'a Channel,
    /// Mean measured curve; empty if it was not measured.
    pub measured: &'a [f64],
    /// Simulated curve before the fit; it ends where the simulation failed.
    pub before: &'a [f64],
    /// Simulated curve after the fit; it ends where the simulation failed.
    pub after: &'a [f64],
}

impl ComparedChannel<'_> {
    /// Evaluates a quantity of the measured and the two simulated curves; `None` for those that are not
    /// complete.
    pub fn values(&self, quantity: impl Fn(&[f64]) -> f64) -> [Option<f64>; 3] {
        let complete = self.channel.abscissa.points.len();
        [self.measured, self.before, self.after]
            .map(|curve| (complete > 0 && curve.len() == complete).then(|| quantity(curve)))
    }

    /// Returns the root mean square difference between the measured and each simulated curve; `None` for curves that are
    /// not complete.
    pub fn misfits(&self) -> [Option<f64>; 2] {
        let [measured, ..] = self.values(|_| 0.0);
        [self.before, self.after].map(|curve| {
            measured.filter(|_| curve.len() == self.measured.len())?;
            let pairs = curve.iter().zip(self.measured);
            let squares = pairs.map(|(own, record)| (own - record).powi(2));
            Some((squares.sum::<f64>() / curve.len() as f64).sqrt())
        })
    }
}
