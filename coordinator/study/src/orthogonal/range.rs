//! Range analysis: mean response at every level of a factor, and the range of these means.
use serde::{Deserialize, Serialize};

/// Observation of a designed experiment: factor levels and response of one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Response {
    /// Index of each factor's level in the observation, from 0.
    pub levels: Vec<usize>,
    /// Index of the block, from 0; runs of one block share conditions other than the factors.
    pub block: usize,
    /// Observed response in any unit; smaller is better.
    pub response: f64,
}

/// Range analysis of one factor: mean response at each of its levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Range {
    /// Mean response at each level of the factor \[unit of the response\].
    pub means: Vec<f64>,
    /// Largest minus smallest mean response of the factor's levels \[unit of the response\].
    pub range: f64,
    /// Index of the factor's level with the smallest mean response; the first of equal ones.
    pub best: usize,
}

/// Computes the ranges of the first `factors` factors, each of `levels` levels. In a balanced design, the
/// mean over all runs of a level is unaffected by the other factors.
pub fn ranges(observations: &[Response], levels: usize, factors: usize) -> Vec<Range> {
    let of = |factor: usize| {
        let group = |one: &Response| one.levels[factor];
        let means = means(observations, levels, group);
        let largest = means.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let smallest = means.iter().copied().fold(f64::INFINITY, f64::min);
        Range {
            range: largest - smallest,
            best: means.iter().position(|mean| *mean <= smallest).unwrap_or(0),
            means,
        }
    };
    (0..factors).map(of).collect()
}

/// Predicts the response at the best level of every factor under an additive model \[unit of the response\].
pub fn predicted(observations: &[Response], ranges: &[Range]) -> f64 {
    let grand = mean(observations.iter().map(|one| one.response));
    let gains = ranges.iter().map(|own| own.means[own.best] - grand);
    grand + gains.sum::<f64>()
}

/// Computes the mean response of each of `groups` groups of observations; NaN for an empty group.
pub(super) fn means(
    observations: &[Response],
    groups: usize,
    group: impl Fn(&Response) -> usize,
) -> Vec<f64> {
    let of = |number| {
        let own = observations.iter().filter(|one| group(one) == number);
        mean(own.map(|one| one.response))
    };
    (0..groups).map(of).collect()
}

pub(super) fn mean(responses: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = responses.fold((0.0, 0_u32), |(sum, count), one| (sum + one, count + 1));
    sum / f64::from(count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orthogonal::Array;

    /// Checks that the range analysis recovers additive effects of factors and predicts the best combination
    /// exactly.
    #[test]
    fn additive_effects_come_back() {
        const EFFECTS: [[f64; 3]; 4] = [
            [0.3, -0.2, -0.1],
            [0.0, 0.05, -0.05],
            [-1.0, 0.25, 0.75],
            [0.0, 0.0, 0.0],
        ];
        let observe = |levels: Vec<usize>| {
            let gains = levels.iter().zip(EFFECTS).map(|(level, own)| own[*level]);
            Response {
                response: 2.0 + gains.sum::<f64>(),
                block: 0,
                levels,
            }
        };
        let rows = Array::L9.rows(4).into_iter().map(observe);
        let observations: Vec<_> = rows.collect();
        let ranges = ranges(&observations, 3, 4);
        let best: Vec<usize> = ranges.iter().map(|own| own.best).collect();
        assert_eq!(best[..3], [1, 2, 0]);
        for (own, effect) in ranges.iter().zip(EFFECTS) {
            for (mean, effect) in own.means.iter().zip(effect) {
                assert!((mean - 2.0 - effect).abs() < 1e-12);
            }
        }
        assert!((ranges[2].range - 1.75).abs() < 1e-12);
        let expected = 2.0 - 0.2 - 0.05 - 1.0;
        assert!((predicted(&observations, &ranges) - expected).abs() < 1e-12);
    }
}
