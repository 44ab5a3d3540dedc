//! Members of a population with their results: best, worst, and diversity.
use super::chromosome::{Chromosome, Codec, distance};
use crate::strategy::evaluation_result::EvaluationResult;

/// Member of a population: a chromosome with its result.
#[derive(Clone, Debug)]
pub(super) struct Individual {
    pub(super) chromosome: Chromosome,
    pub(super) told: EvaluationResult,
}

/// Returns the index of the population's best individual; the first one on ties.
pub(super) fn best(population: &[Individual]) -> usize {
    extreme(population, EvaluationResult::beats)
}

/// Returns the index of the population's worst individual; the first one on ties.
pub(super) fn worst(population: &[Individual]) -> usize {
    extreme(population, |one, other| other.beats(one))
}

fn extreme(
    population: &[Individual],
    wins: impl Fn(EvaluationResult, EvaluationResult) -> bool,
) -> usize {
    let mut found = 0;
    for (index, one) in population.iter().enumerate() {
        if wins(one.told, population[found].told) {
            found = index;
        }
    }
    found
}

/// Returns twice the mean share of bits in which the population differs from its elite: 1 for a random
/// population, 0 for clones.
pub(super) fn diversity(codec: &Codec, population: &[Individual]) -> f64 {
    let elite = &population[best(population)].chromosome;
    let bits: u32 = population
        .iter()
        .map(|one| distance(&one.chromosome, elite))
        .sum();
    let mean = f64::from(bits) / population.len() as f64;
    (2.0 * mean / codec.length() as f64).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn population(told: &[(f64, bool)]) -> Vec<Individual> {
        let one = |&(fitness, complete): &(f64, bool)| Individual {
            chromosome: Chromosome(vec![]),
            told: EvaluationResult { fitness, complete },
        };
        told.iter().map(one).collect()
    }

    #[test]
    fn ties_go_to_the_first() {
        let told = [
            (2.0, true),
            (1.0, true),
            (1.0, true),
            (9.0, false),
            (9.0, false),
        ];
        assert_eq!(best(&population(&told)), 1);
        assert_eq!(worst(&population(&told)), 3);
    }
}
