//! Selection of parents by roulette.
use super::{population::Individual, settings::Roulette};
use crate::{random::Stream, strategy::evaluation_result::EvaluationResult};

/// Roulette wheel that draws individuals of a population with probabilities by fitness.
#[derive(Clone, Debug)]
pub(super) struct RouletteWheel {
    /// Cumulative sums of the individuals' selection weights, in the order of the population.
    sums: Vec<f64>,
}

impl RouletteWheel {
    /// Creates a wheel whose weights follow the roulette rule. A failed individual has weight zero if any
    /// individual is complete; if all failed, their grades count as fitness, and if all weights are zero,
    /// they are made equal.
    pub(super) fn new(population: &[Individual], rule: Roulette) -> Self {
        let any_survived = population.iter().any(|one| one.told.survived());
        let eligible =
            |told: EvaluationResult| told.survived() || (!any_survived && told.fitness.is_finite());
        let all: Vec<EvaluationResult> = population.iter().map(|one| one.told).collect();
        let worst = all
            .iter()
            .filter(|told| eligible(**told))
            .fold(f64::NEG_INFINITY, |worst, told| worst.max(told.fitness));
        let weight = |told: EvaluationResult| {
            if !eligible(told) {
                return 0.0;
            }
            let fitness = told.fitness.max(0.0);
            match rule {
                Roulette::Inverse => 1.0 / fitness.max(1e-300),
                Roulette::InversePlusOne => 1.0 / (1.0 + fitness),
                Roulette::Difference => worst - told.fitness,
                Roulette::Rank => {
                    let better = all.iter().filter(|other| other.beats(told)).count();
                    (all.len() - better) as f64
                }
            }
        };
        let mut sums = Vec::with_capacity(all.len());
        let mut sum = 0.0;
        for &one in &all {
            sum += weight(one);
            sums.push(sum);
        }
        if !(sum > 0.0 && sum.is_finite()) {
            sums = (1..=all.len()).map(|n| n as f64).collect();
        }
        Self { sums }
    }

    /// Draws an individual at random by its weight and returns its index in the population.
    pub(super) fn draw(&self, stream: &mut Stream) -> usize {
        let total = self.sums.last().copied().unwrap_or(0.0);
        let mark = stream.unit() * total;
        let found = self.sums.partition_point(|sum| *sum <= mark);
        found.min(self.sums.len().saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        random::{Phase, Streams},
        strategy::memetic::chromosome::Chromosome,
    };

    fn population(told: &[(f64, bool)]) -> Vec<Individual> {
        let one = |&(fitness, complete): &(f64, bool)| Individual {
            chromosome: Chromosome(vec![]),
            told: EvaluationResult { fitness, complete },
        };
        told.iter().map(one).collect()
    }

    fn shares(told: &[(f64, bool)], rule: Roulette) -> Vec<f64> {
        let wheel = RouletteWheel::new(&population(told), rule);
        let mut counts = vec![0.0; told.len()];
        for index in 0..20_000 {
            let mut stream = Streams::new(5, 0).at(0, Phase::Selection, index);
            counts[wheel.draw(&mut stream)] += 1.0 / 20_000.0;
        }
        counts
    }

    fn assert_shares(told: &[(f64, bool)], rule: Roulette, expected: &[f64]) {
        for (share, expected) in shares(told, rule).iter().zip(expected) {
            assert!(
                (share - expected).abs() < 0.015,
                "{rule:?}: {share}, not {expected}"
            );
        }
    }

    #[test]
    fn weights_follow_the_rule() {
        let told = [(1.0, true), (3.0, true), (5.0, true)];
        assert_shares(
            &told,
            Roulette::Inverse,
            &[15.0 / 23.0, 5.0 / 23.0, 3.0 / 23.0],
        );
        assert_shares(
            &told,
            Roulette::InversePlusOne,
            &[6.0 / 11.0, 3.0 / 11.0, 2.0 / 11.0],
        );
        assert_shares(&told, Roulette::Difference, &[4.0 / 6.0, 2.0 / 6.0, 0.0]);
        assert_shares(&told, Roulette::Rank, &[3.0 / 6.0, 2.0 / 6.0, 1.0 / 6.0]);
    }

    #[test]
    fn a_failure_is_never_drawn_beside_a_complete_run() {
        for rule in [Roulette::Inverse, Roulette::InversePlusOne, Roulette::Rank] {
            assert_shares(
                &[(9.0, true), (0.1, false), (f64::NAN, true)],
                rule,
                &[1.0, 0.0, 0.0],
            );
        }
    }

    #[test]
    fn if_all_fail_the_grades_count_and_without_grades_all_are_equal() {
        assert_shares(
            &[(1e6, false), (3e6, false)],
            Roulette::Inverse,
            &[0.75, 0.25],
        );
        let infinite = [(f64::INFINITY, false), (f64::INFINITY, false)];
        assert_shares(&infinite, Roulette::Inverse, &[0.5, 0.5]);
    }

    #[test]
    fn a_perfect_fit_takes_the_wheel_without_overflow() {
        assert_shares(&[(0.0, true), (0.1, true)], Roulette::Inverse, &[1.0, 0.0]);
    }
}
