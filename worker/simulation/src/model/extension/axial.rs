//! Axial laws of effects: tensile forces between neighbouring cylinders of a rope as functions of strain and
//! strain rate.
use super::along::LineForceValue;
use crate::drive::DriveState;
use std::fmt::Debug;
use std::sync::Arc;

/// Axial force between two neighbouring cylinders of a rope as a function of the strain; positive in tension.
pub trait Axial: Debug + Send + Sync {
    /// Returns the tensile force \[N\] at an axial strain \[1\] and strain rate [1/s]; the energy in the
    /// result is per unit length of rope [J/m].
    fn pull(&self, at: &Strain<'_>) -> LineForceValue;

    /// Returns the tensile force \[N\] if it is constant along the rope and independent of the strain, that
    /// is, a function of time and drive only; otherwise `None`.
    fn constant_force(&self, _drive: &DriveState) -> Option<f64> {
        None
    }

    /// Returns the law's memory for the next time step at this joint; `None` for a law without memory.
    fn next_memory(&self, _at: &Strain<'_>) -> Option<Memory> {
        None
    }

    /// Returns the derivatives that concern the law's memory; `None` for a law without memory.
    fn memory_derivatives(&self, _at: &Strain<'_>) -> Option<MemoryDerivatives> {
        None
    }
}

/// Memory of an axial law with hysteresis: strain \[1\] and internal variable at the last accepted step.
pub type Memory = [f64; 2];

/// Derivatives of an axial law and of its next memory at a joint, at fixed parameters of the law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MemoryDerivatives {
    /// Derivatives of the tensile force with respect to both numbers of the memory \[N\] per unit of each.
    pub force: Memory,
    /// Derivatives of both numbers of the next memory with respect to the strain.
    pub by_strain: Memory,
    /// Derivatives of both numbers of the next memory with respect to each number of the memory.
    pub by_memory: [Memory; 2],
}

/// State of a rope joint at which an axial law is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Strain<'a> {
    /// State of the machine's drive: crank motion and load.
    pub drive: &'a DriveState,
    /// Axial strain of the joint \[1\].
    pub strain: f64,
    /// Rate of the joint's axial strain [1/s].
    pub rate: f64,
    /// Axial stiffness of the individual's rope, force per unit strain \[N\].
    pub stiffness: f64,
    /// Memory of the axial law for this joint at the last accepted step; `None` before the first step.
    pub memory: Option<Memory>,
}

/// Properties of a rope that the axial laws of effects need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RopeProperties {
    /// Axial stiffness, force per unit strain, of all ropes on a head together \[N\].
    pub(crate) stiffness: f64,
    /// Share of the force of each law that this rope carries: 1 for a single rope, 0.5 for twin ropes.
    pub(crate) share: f64,
    /// Length of rope represented by a joint \[m\].
    pub(crate) length: f64,
}

/// Axial laws of one rope at an instant.
#[derive(Clone, Copy, Debug)]
pub struct AxialLaws<'a> {
    pub(super) laws: &'a [Arc<dyn Axial>],
    pub(super) drive: &'a DriveState,
    pub(super) carrier: RopeProperties,
}

impl AxialLaws<'_> {
    /// Returns the number of axial laws on the rope; each law has its own memory in every joint.
    pub(crate) const fn len(&self) -> usize {
        self.laws.len()
    }

    /// Returns the summed force of the axial laws at a joint's extension \[m\] and extension rate [m/s], with
    /// its derivatives with respect to both and its energy \[J\].
    ///
    /// `memories` holds the memory of each law at this joint; empty before the first step.
    pub(crate) fn pull(&self, extension: f64, rate: f64, memories: &[Memory]) -> LineForceValue {
        let mut at = self.strain(extension, rate);
        let RopeProperties { share, length, .. } = self.carrier;
        let mut sum = LineForceValue::default();
        for (k, law) in self.laws.iter().enumerate() {
            at.memory = memories.get(k).copied();
            let one = law.pull(&at);
            sum.spring += one.spring;
            sum.non_conservative += one.non_conservative;
            sum.energy += one.energy * length;
            sum.by_place += one.by_place / length;
            sum.by_rate += one.by_rate / length;
        }
        LineForceValue {
            spring: sum.spring * share,
            non_conservative: sum.non_conservative * share,
            energy: sum.energy * share,
            by_place: sum.by_place * share,
            by_rate: sum.by_rate * share,
        }
    }

    /// Returns the sum of the laws if all of them are constant along the rope, otherwise `None`.
    pub(crate) fn uniform(&self) -> Option<f64> {
        let each = self.laws.iter().map(|law| law.constant_force(self.drive));
        let sum: Option<f64> = each.sum();
        sum.map(|sum| sum * self.carrier.share)
    }

    /// Updates the memories of the axial laws at a joint for the next step; `first` states that no memory
    /// exists yet. Returns whether any law has memory.
    pub(crate) fn remember(
        &self,
        extension: f64,
        rate: f64,
        memories: &mut [Memory],
        first: bool,
    ) -> bool {
        let mut at = self.strain(extension, rate);
        let mut any = false;
        for (law, memory) in self.laws.iter().zip(memories) {
            at.memory = (!first).then_some(*memory);
            if let Some(next) = law.next_memory(&at) {
                *memory = next;
                any = true;
            }
        }
        any
    }

    /// Returns the derivatives of each law at a joint that concern its memory, `None` for a law without one: those of
    /// the force of this rope, and those of the next memory with respect to the joint's extension \[m\] and to the
    /// memory.
    pub(crate) fn memory_derivatives(
        &self,
        [extension, rate]: [f64; 2],
        memories: &[Memory],
    ) -> impl Iterator<Item = Option<MemoryDerivatives>> {
        let at = self.strain(extension, rate);
        let RopeProperties { share, length, .. } = self.carrier;
        self.laws.iter().enumerate().map(move |(k, law)| {
            let at = Strain {
                memory: memories.get(k).copied(),
                ..at
            };
            let own = law.memory_derivatives(&at)?;
            Some(MemoryDerivatives {
                force: own.force.map(|by| share * by),
                by_strain: own.by_strain.map(|by| by / length),
                ..own
            })
        })
    }

    fn strain(&self, extension: f64, rate: f64) -> Strain<'_> {
        Strain {
            drive: self.drive,
            strain: extension / self.carrier.length,
            rate: rate / self.carrier.length,
            stiffness: self.carrier.stiffness,
            memory: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test law with memory: a force proportional to the largest strain so far.
    #[derive(Debug)]
    struct Largest(f64);

    impl Axial for Largest {
        fn pull(&self, at: &Strain<'_>) -> LineForceValue {
            let seen = at.memory.map_or(0.0, |[_, seen]| seen);
            LineForceValue {
                non_conservative: self.0 * seen,
                ..LineForceValue::default()
            }
        }

        fn next_memory(&self, at: &Strain<'_>) -> Option<Memory> {
            let seen = at.memory.map_or(0.0, |[_, seen]| seen);
            Some([at.strain, seen.max(self.0 * at.strain)])
        }
    }

    #[derive(Debug)]
    struct Straight;

    impl Axial for Straight {
        fn pull(&self, at: &Strain<'_>) -> LineForceValue {
            LineForceValue {
                spring: at.strain,
                ..LineForceValue::default()
            }
        }
    }

    fn pulls(laws: &[Arc<dyn Axial>]) -> Vec<f64> {
        let drive = DriveState::default();
        let carrier = RopeProperties {
            stiffness: 1.0,
            share: 1.0,
            length: 0.5,
        };
        let laws = AxialLaws {
            laws,
            drive: &drive,
            carrier,
        };
        let mut memories = vec![[0.0; 2]; laws.len()];
        let mut first = true;
        let mut begun = false;
        let extensions = [0.1, 0.4, 0.2, 0.3];
        let follow = |extension: &f64| {
            let known = if begun { &memories[..] } else { &[] };
            let LineForceValue {
                spring,
                non_conservative: other,
                ..
            } = laws.pull(*extension, 0.0, known);
            begun = laws.remember(*extension, 0.0, &mut memories, first);
            first = false;
            spring + other
        };
        extensions.iter().map(follow).collect()
    }

    /// Checks that each axial law has its own memory: several laws acting together give the sum of their
    /// separate forces, also with laws without memory between them.
    #[test]
    fn laws_with_a_past_share_no_memory() {
        let laws: [Arc<dyn Axial>; 4] = [
            Arc::new(Largest(1.0)),
            Arc::new(Straight),
            Arc::new(Largest(-3.0)),
            Arc::new(Largest(2.0)),
        ];
        let together = pulls(&laws);
        let apart = laws.each_ref().map(|law| pulls(std::slice::from_ref(law)));
        for (k, sum) in together.iter().enumerate() {
            let expected: f64 = apart.iter().map(|pulls| pulls[k]).sum();
            assert!((sum - expected).abs() < 1e-14, "{k}: {sum} {expected}");
        }
        assert!(together[3] > 1.0);
    }
}
