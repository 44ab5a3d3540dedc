//! Laws of effects along a rope: pulls between its cylinders by strain and rate.
use super::along::Along;
use crate::drive::DriveState;
use std::fmt::Debug;
use std::sync::Arc;

/// A force along a rope between two cylinders, as a law of its strain; positive where it pulls.
pub trait Axial: Debug + Send + Sync {
    /// Pull \[N\] at a strain \[1\] and its rate [1/s]; energies are per length [J/m].
    fn pull(&self, at: &Strain<'_>) -> Along;

    /// The pull \[N\] of a law that says the same all along the rope, whatever its strain: those of a force
    /// that only time and the drive know.
    fn uniform(&self, _drive: &DriveState) -> Option<f64> {
        None
    }

    /// What the law wants to know at the next step of this joint; a law without a past wants nothing.
    fn remember(&self, _at: &Strain<'_>) -> Option<Memory> {
        None
    }
}

/// State of a law with a past: strain \[1\] and inner variable at the last accepted step.
pub type Memory = [f64; 2];

/// A joint of a rope.
#[derive(Clone, Copy, Debug)]
pub struct Strain<'a> {
    /// Crank and load.
    pub drive: &'a DriveState,
    /// Strain \[1\].
    pub strain: f64,
    /// Its rate [1/s].
    pub rate: f64,
    /// Stiffness of the individual's rope, force per strain \[N\].
    pub stiffness: f64,
    /// What this law remembered of this joint; nothing before the run has begun to move.
    pub memory: Option<Memory>,
}

/// The rope that laws act along.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carrier {
    /// Force per strain of all ropes of a head together \[N\].
    pub(crate) stiffness: f64,
    /// What of the laws this rope carries: half of them where there are two.
    pub(crate) share: f64,
    /// Length of rope that a joint stands for \[m\].
    pub(crate) length: f64,
}

/// The laws along one rope at an instant.
#[derive(Clone, Copy, Debug)]
pub struct AxialLaws<'a> {
    pub(super) laws: &'a [Arc<dyn Axial>],
    pub(super) drive: &'a DriveState,
    pub(super) carrier: Carrier,
}

impl AxialLaws<'_> {
    /// How many laws there are: each has a memory of its own in every joint.
    pub(crate) const fn len(&self) -> usize {
        self.laws.len()
    }

    /// Sum of the laws at an extension \[m\] and its rate [m/s]; derivatives by those, energy in J.
    ///
    /// `memories` are those of the joint, law by law, or empty before the run has begun to move.
    pub(crate) fn pull(&self, extension: f64, rate: f64, memories: &[Memory]) -> Along {
        let mut at = self.strain(extension, rate);
        let Carrier { share, length, .. } = self.carrier;
        let mut sum = Along::default();
        for (k, law) in self.laws.iter().enumerate() {
            at.memory = memories.get(k).copied();
            let one = law.pull(&at);
            sum.spring += one.spring;
            sum.other += one.other;
            sum.energy += one.energy * length;
            sum.by_place += one.by_place / length;
            sum.by_rate += one.by_rate / length;
        }
        Along {
            spring: sum.spring * share,
            other: sum.other * share,
            energy: sum.energy * share,
            by_place: sum.by_place * share,
            by_rate: sum.by_rate * share,
        }
    }

    /// The sum of the laws where it is the same all along the rope.
    pub(crate) fn uniform(&self) -> Option<f64> {
        let each = self.laws.iter().map(|law| law.uniform(self.drive));
        let sum: Option<f64> = each.sum();
        sum.map(|sum| sum * self.carrier.share)
    }

    /// Replaces the memories of a joint by what the laws want to know at the next step; `first`: there
    /// are none yet. Whether any law has a past.
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
            if let Some(next) = law.remember(&at) {
                *memory = next;
                any = true;
            }
        }
        any
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

    /// Pulls by the largest strain that it has seen, times a factor.
    #[derive(Debug)]
    struct Largest(f64);

    impl Axial for Largest {
        fn pull(&self, at: &Strain<'_>) -> Along {
            let seen = at.memory.map_or(0.0, |[_, seen]| seen);
            Along {
                other: self.0 * seen,
                ..Along::default()
            }
        }

        fn remember(&self, at: &Strain<'_>) -> Option<Memory> {
            let seen = at.memory.map_or(0.0, |[_, seen]| seen);
            Some([at.strain, seen.max(self.0 * at.strain)])
        }
    }

    /// Has no past.
    #[derive(Debug)]
    struct Straight;

    impl Axial for Straight {
        fn pull(&self, at: &Strain<'_>) -> Along {
            Along {
                spring: at.strain,
                ..Along::default()
            }
        }
    }

    fn pulls(laws: &[Arc<dyn Axial>]) -> Vec<f64> {
        let drive = DriveState::default();
        let carrier = Carrier {
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
            let Along { spring, other, .. } = laws.pull(*extension, 0.0, known);
            begun = laws.remember(*extension, 0.0, &mut memories, first);
            first = false;
            spring + other
        };
        extensions.iter().map(follow).collect()
    }

    /// Each law along a rope has a past of its own: together they pull what they pull one by one,
    /// whatever stands between them.
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
