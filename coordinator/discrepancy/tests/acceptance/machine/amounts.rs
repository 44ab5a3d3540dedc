//! What a job asks of the machine, and what all its parts reckon with.
use crate::case::ORDERS;
use nalgebra::Complex;
use protocol::announce::EffectDescriptor;
use protocol::job::SimulateSpec;

/// A coefficient of an order of the crank.
pub(super) type C = Complex<f64>;

/// Orders that are solved, beyond those that are compared.
pub(super) const HIGHEST: usize = ORDERS + 8;
/// Rod, beam and head.
pub(super) const MASSES: [f64; 3] = [2.0, 4.0, 5.9];
/// Amounts of effects, by identifier and parameter.
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
