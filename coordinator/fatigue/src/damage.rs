//! Damage of a stress history by the linear rule of Palmgren and Miner.
use crate::{
    curve::Curve,
    mean_stress::MeanStress,
    rainflow::{Residue, StressCycle, cycles},
};

/// What the damage of a history is judged by.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// Curve of allowable stress range.
    pub curve: Curve,
    /// Rule for the mean stress.
    pub mean_stress: MeanStress,
    /// Factor on every stress: a partial factor of safety, or a load factor \[1\].
    pub factor: f64,
}

impl Assessment {
    /// Returns the damage of a cycle: its count over the number of cycles that the curve allows.
    pub fn of_cycle(&self, cycle: &StressCycle) -> f64 {
        let (range, mean) = (self.factor * cycle.range, self.factor * cycle.mean);
        let reversed = self.mean_stress.reversed(range, mean);
        cycle.count / self.curve.cycles(reversed)
    }
}

/// Returns the damage of one period of a repeated stress history \[MPa\]: the share of the life that it uses up;
/// infinite where a mean stress reaches the strength.
pub fn damage(assessment: &Assessment, history: &[f64]) -> f64 {
    let cycles = cycles(history, Residue::Repeating);
    cycles.iter().map(|own| assessment.of_cycle(own)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn assessment(name: &str) -> Assessment {
        Assessment {
            curve: Curve::named(name).unwrap(),
            mean_stress: MeanStress::Ignored,
            factor: 1.0,
        }
    }

    #[test]
    fn a_sine_lives_as_long_as_its_range_allows() {
        // 100 samples: the peaks at a quarter and three quarters are among them
        let sine: Vec<f64> = (0..100)
            .map(|k| 20.0 + 50.0 * libm::sin(TAU * f64::from(k) / 100.0))
            .collect();
        let own = damage(&assessment("en-100"), &sine);
        assert!((own * 2e6 - 1.0).abs() < 1e-9, "{own}");
        let doubled = Assessment {
            factor: 2.0,
            ..assessment("en-100")
        };
        assert!((damage(&doubled, &sine) / own - 8.0).abs() < 1e-9);
    }

    #[test]
    fn two_blocks_add_up() {
        // three cycles of 140 MPa, ten of 60 MPa, about one mean, and the cycle that joins them is one of the three
        let block = |count: usize, amplitude: f64| vec![[amplitude, -amplitude]; count].concat();
        let history = [block(3, 70.0), block(10, 30.0)].concat();
        let curve = Curve::named("en-71").unwrap();
        let by_hand = 3.0 / curve.cycles(140.0) + 10.0 / curve.cycles(60.0);
        // from -70 of the first block up to 30, down and up within the second, and back to 70: 9 whole cycles of 60,
        // and one of 30 to -30 that the way back up from -30 closes
        let own = damage(&assessment("en-71"), &history);
        assert!((own / by_hand - 1.0).abs() < 1e-9, "{own} {by_hand}");
        assert!(damage(&assessment("en-160"), &block(5, 20.0)).abs() <= 0.0);
    }
}
