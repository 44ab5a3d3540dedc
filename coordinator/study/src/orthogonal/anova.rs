//! Analysis of variance of a balanced design in blocks: sum of squares of each factor, and the probability
//! that chance alone causes a sum as large.
use super::range::{Response, mean, means};
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};

/// Share of the total sum of squares below which the error's sum of squares is taken for rounding, so that no
/// F test is made.
const ROUNDING: f64 = 1e-12;

/// Source of variation in an analysis of variance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum VarianceSource {
    /// Factor of the design with this index, from 0.
    Factor(usize),
    /// Blocks of runs under like conditions, whose variation is separated from the error.
    Block,
    /// Residual error, explained by neither factors nor blocks.
    Error,
}

/// Row of an analysis of variance table: one source of variation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnovaTerm {
    /// Source of the variation that the row describes: a factor, the blocks or the error.
    pub source: VarianceSource,
    /// Sum of squares \[square of the unit of the response\].
    pub squares: f64,
    /// Degrees of freedom of the source of variation.
    pub freedom: usize,
    /// F statistic of a factor (mean square over that of the error); none where the error is nothing but
    /// rounding.
    pub f: Option<f64>,
    /// Probability of an F statistic at least as large under the null hypothesis.
    pub p: Option<f64>,
}

impl AnovaTerm {
    /// Returns the sum of squares per degree of freedom.
    pub fn mean_square(&self) -> f64 {
        self.squares / self.freedom as f64
    }
}

/// Analysis of variance table: factors in their order, blocks if there are several, the error last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Anova {
    /// Rows of the table: factors in their order, blocks if there are several, the error last.
    pub terms: Vec<AnovaTerm>,
}

/// Computes the table of a balanced design of `factors` factors with `levels` levels in `blocks` blocks.
/// Returns none for a saturated design, which leaves no degree of freedom for the error.
pub fn anova(
    observations: &[Response],
    levels: usize,
    factors: usize,
    blocks: usize,
) -> Option<Anova> {
    let explained = factors * (levels - 1) + (blocks - 1);
    let error = (observations.len().checked_sub(1)?).checked_sub(explained)?;
    if error == 0 {
        return None;
    }
    let grand = mean(observations.iter().map(|one| one.response));
    let squares = |groups: usize, group: &dyn Fn(&Response) -> usize| -> f64 {
        let means = means(observations, groups, group);
        let own = means.iter().map(|mean| (mean - grand).powi(2));
        own.sum::<f64>() * observations.len() as f64 / groups as f64
    };
    let all = observations
        .iter()
        .map(|one| (one.response - grand).powi(2));
    let all: f64 = all.sum();
    let factors: Vec<f64> = (0..factors)
        .map(|factor| squares(levels, &|one| one.levels[factor]))
        .collect();
    let block = squares(blocks, &|one| one.block);
    let left = (all - factors.iter().sum::<f64>() - block).max(0.0);
    let scatter = Some(left / error as f64).filter(|_| left > ROUNDING * all);
    let law = FisherSnedecor::new((levels - 1) as f64, error as f64).ok();
    let of = |(factor, squares): (usize, &f64)| {
        let freedom = levels - 1;
        let f = scatter.map(|scatter| squares / freedom as f64 / scatter);
        AnovaTerm {
            source: VarianceSource::Factor(factor),
            squares: *squares,
            freedom,
            f,
            p: f.zip(law.as_ref()).map(|(f, law)| law.sf(f)),
        }
    };
    let plain = |source, squares, freedom| AnovaTerm {
        source,
        squares,
        freedom,
        f: None,
        p: None,
    };
    let mut terms: Vec<AnovaTerm> = factors.iter().enumerate().map(of).collect();
    if blocks > 1 {
        terms.push(plain(VarianceSource::Block, block, blocks - 1));
    }
    terms.push(plain(VarianceSource::Error, left, error));
    Some(Anova { terms })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orthogonal::Array;

    fn near(value: f64, expected: f64, digits: i32) {
        let step = 0.5 * 10_f64.powi(-digits) * 1.001;
        assert!((value - expected).abs() <= step, "{value} {expected}");
    }

    fn holds(term: &AnovaTerm, (squares, freedom): (f64, usize)) {
        near(term.squares, squares, 2);
        assert_eq!(term.freedom, freedom);
    }

    /// Checks the analysis of variance of a textbook example (Montgomery's vascular grafts): one factor of
    /// four levels in six blocks.
    #[test]
    fn a_randomised_block_design_of_the_textbook() {
        const YIELD: [[f64; 6]; 4] = [
            [90.3, 89.2, 98.2, 93.9, 87.4, 97.9],
            [92.5, 89.5, 90.6, 94.7, 87.0, 95.8],
            [85.5, 90.8, 89.6, 86.2, 88.0, 93.4],
            [82.5, 89.5, 85.6, 87.4, 78.9, 90.7],
        ];
        let pressures = YIELD.iter().enumerate();
        let observations: Vec<Response> = pressures
            .flat_map(|(level, batches)| {
                batches
                    .iter()
                    .enumerate()
                    .map(move |(block, response)| Response {
                        levels: vec![level],
                        block,
                        response: *response,
                    })
            })
            .collect();
        let terms = anova(&observations, 4, 1, 6).unwrap().terms;
        holds(&terms[0], (178.17, 3));
        holds(&terms[1], (192.25, 5));
        holds(&terms[2], (109.89, 15));
        near(terms[0].f.unwrap(), 8.11, 2);
        near(terms[0].p.unwrap(), 0.0019, 4);
    }

    /// Checks the analysis of variance of a textbook Latin square (Montgomery's rocket propellant), computed
    /// as three columns of the array L25.
    #[test]
    fn a_latin_square_of_the_textbook_is_part_of_an_array() {
        const RATE: [[f64; 5]; 5] = [
            [24.0, 20.0, 19.0, 24.0, 24.0],
            [17.0, 24.0, 30.0, 27.0, 36.0],
            [18.0, 38.0, 26.0, 27.0, 21.0],
            [26.0, 31.0, 26.0, 23.0, 22.0],
            [22.0, 30.0, 20.0, 29.0, 31.0],
        ];
        let rows = Array::L25.rows(3).into_iter();
        let observe = |levels: Vec<usize>| Response {
            response: RATE[levels[0]][levels[1]],
            block: 0,
            levels,
        };
        let observations: Vec<_> = rows.map(observe).collect();
        let terms = anova(&observations, 5, 3, 1).unwrap().terms;
        assert_eq!(terms.len(), 4, "one block is none");
        holds(&terms[0], (68.0, 4));
        holds(&terms[1], (150.0, 4));
        holds(&terms[2], (330.0, 4));
        holds(&terms[3], (128.0, 12));
        near(terms[2].mean_square(), 82.5, 2);
        near(terms[2].f.unwrap(), 7.73, 2);
        near(terms[2].p.unwrap(), 0.0025, 4);
    }

    #[test]
    fn a_saturated_design_has_no_table_and_rounding_is_no_scatter() {
        let observe = |block| {
            move |levels: Vec<usize>| Response {
                response: levels[0] as f64 / 3.0 + block as f64,
                block,
                levels,
            }
        };
        let one: Vec<_> = Array::L9.rows(4).into_iter().map(observe(0)).collect();
        assert_eq!(anova(&one, 3, 4, 1), None);
        assert!(anova(&one, 3, 3, 1).is_some());
        let second = Array::L9.rows(4).into_iter().map(observe(1));
        let two: Vec<_> = one.into_iter().chain(second).collect();
        let terms = anova(&two, 3, 4, 2).unwrap().terms;
        assert!(
            terms
                .iter()
                .all(|term| term.f.is_none() && term.p.is_none())
        );
    }
}
