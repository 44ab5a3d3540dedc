//! Amounts of the effects that a job requests of the stand-in machine, and constants and types shared by its
//! parts.
use crate::case::ORDERS;
use nalgebra::Complex;
use protocol::announce::EffectDescriptor;
use protocol::job::SimulateSpec;

/// Complex Fourier coefficient of a curve over the crank angle.
pub(super) type C = Complex<f64>;

/// Highest order of the crank for which the machine's motion is solved, eight above the highest compared.
pub(super) const HIGHEST: usize = ORDERS + 8;
/// Masses of rod, beam and head of the stand-in machine (kN t^2/m, with t the unit of time).
pub(super) const MASSES: [f64; 3] = [2.0, 4.0, 5.9];
/// Amounts of effects requested by a job, looked up by identifier and parameter index.
pub(super) struct Amounts<'a> {
    pub(super) library: &'a [EffectDescriptor],
    pub(super) spec: &'a SimulateSpec,
}

impl Amounts<'_> {
    pub(super) fn get(&self, id: &str, k: usize) -> f64 {
        let Some(known) = self.library.iter().find(|e| e.id == id) else {
            return 0.0;
        };
        let name = &known.parameters[k].name;
        let given = self.spec.individual.effects.iter().find(|e| e.id == id);
        given
            .and_then(|e| e.parameters.iter().find(|(n, _)| n == name))
            .map_or(known.parameters[k].absent, |(_, value)| *value)
    }

    pub(super) fn on(&self, id: &str) -> bool {
        self.spec.individual.effects.iter().any(|e| e.id == id)
    }
}
