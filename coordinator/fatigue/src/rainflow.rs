//! Rainflow counting by ASTM E1049-85 (2017), 5.4.4 and 5.4.5.
//!
//! Three neighbouring reversals a, b, c close the cycle a-b where the range b-c is at least as large as a-b. What stays
//! open at the end of the history is its residue.

/// Closed or open cycle of a stress history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StressCycle {
    /// Largest stress of the cycle less its smallest \[MPa\].
    pub range: f64,
    /// Mean of its largest and its smallest stress \[MPa\].
    pub mean: f64,
    /// Number of cycles counted: 1, or 0.5 for a range of the residue.
    pub count: f64,
    /// Indices in the history of the cycle's two reversals.
    pub at: [usize; 2],
}

/// Treatment of the residue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Residue {
    /// The history happens once: each range of the residue counts as half a cycle (5.4.4).
    HalfCycles,
    /// The history repeats: it is counted from its largest stress on, and every cycle closes (5.4.5). The result does
    /// not depend on where the history starts.
    Repeating,
}

/// Returns the cycles of a stress history, in the order in which they close. Stresses that are not finite are left out.
pub fn cycles(history: &[f64], residue: Residue) -> Vec<StressCycle> {
    let reversals = match residue {
        Residue::HalfCycles => reversals(history.iter().copied().enumerate()),
        Residue::Repeating => {
            let all = || history.iter().copied().enumerate();
            let finite = all().filter(|(_, x)| x.is_finite());
            let largest = finite.fold(None, |most: Option<(usize, f64)>, own| {
                most.filter(|most| most.1 >= own.1).or(Some(own))
            });
            let Some((start, _)) = largest else {
                return Vec::new();
            };
            reversals(all().skip(start).chain(all().take(start + 1)))
        }
    };
    let mut found = Vec::new();
    let mut stack: Vec<(usize, f64)> = Vec::new();
    for reversal in reversals {
        stack.push(reversal);
        while let [.., a, b, c] = stack[..] {
            if (c.1 - b.1).abs() < (b.1 - a.1).abs() {
                break;
            }
            if stack.len() == 3 && residue == Residue::HalfCycles {
                // it contains the start of the history
                found.push(cycle(a, b, 0.5));
                stack.remove(0);
            } else {
                found.push(cycle(a, b, 1.0));
                let at = stack.len() - 3;
                stack.drain(at..at + 2);
            }
        }
    }
    if residue == Residue::HalfCycles {
        found.extend(stack.windows(2).map(|pair| cycle(pair[0], pair[1], 0.5)));
    }
    found
}

fn cycle(a: (usize, f64), b: (usize, f64), count: f64) -> StressCycle {
    StressCycle {
        range: (a.1 - b.1).abs(),
        mean: 0.5 * (a.1 + b.1),
        count,
        at: [a.0, b.0],
    }
}

/// Returns the first and the last value of a history and those at which its slope changes sign; of equal neighbours,
/// the first.
fn reversals(history: impl Iterator<Item = (usize, f64)>) -> Vec<(usize, f64)> {
    let mut found: Vec<(usize, f64)> = Vec::new();
    for own in history.filter(|(_, x)| x.is_finite()) {
        match found[..] {
            [.., last] if (last.1 - own.1).abs() <= 0.0 => {}
            [.., before, last] if (last.1 > before.1) == (own.1 > last.1) => {
                let end = found.len() - 1;
                found[end] = own;
            }
            _ => found.push(own),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Returns the number of cycles of each range, in thousandths.
    fn counted(history: &[f64], residue: Residue) -> BTreeMap<i64, f64> {
        let mut counts = BTreeMap::new();
        for own in cycles(history, residue) {
            #[expect(clippy::cast_possible_truncation, reason = "ranges of a few units")]
            let range = (1000.0 * own.range).round() as i64;
            *counts.entry(range).or_insert(0.0) += own.count;
        }
        counts
    }

    const STANDARD: [f64; 9] = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];

    #[test]
    fn the_example_of_the_standard_is_counted_as_there() {
        let expected = [
            (3000, 0.5),
            (4000, 1.5),
            (6000, 0.5),
            (8000, 1.0),
            (9000, 0.5),
        ];
        assert_eq!(
            counted(&STANDARD, Residue::HalfCycles),
            BTreeMap::from(expected)
        );
        // 5.4.5, figure 7: E-F, A-B, H-C and D-G
        let expected = [(3000, 1.0), (4000, 1.0), (7000, 1.0), (9000, 1.0)];
        assert_eq!(
            counted(&STANDARD, Residue::Repeating),
            BTreeMap::from(expected)
        );
    }

    /// Judges: the tests of the Python packages `rainflow` (order and means of the standard's example, with zeros at both
    /// ends), `fatpack` (24 reversals; its count concatenates the residue, which is that of a repeated history) and `pylife`.
    #[test]
    fn vectors_of_other_programs_are_counted_alike() {
        let history = [0.0, -2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0, 0.0];
        let own = cycles(&history, Residue::HalfCycles);
        let counts: Vec<f64> = own.iter().map(|own| own.count).collect();
        let means: Vec<f64> = own.iter().map(|own| own.mean).collect();
        assert_eq!(counts, [0.5, 0.5, 0.5, 1.0, 0.5, 0.5, 0.5, 0.5, 0.5]);
        assert_eq!(means, [-1.0, -0.5, -1.0, 1.0, 1.0, 0.5, 0.0, 1.0, -1.0]);

        let reversals = [
            4.0, 7.0, 2.0, 10.0, 5.0, 9.0, 3.0, 4.0, 2.0, 12.0, 5.0, 11.0, 1.0, 4.0, 3.0, 10.0,
            6.0, 12.0, 4.0, 8.0, 1.0, 9.0, 4.0, 6.0,
        ];
        let own = cycles(&reversals, Residue::Repeating);
        let mut ranges: Vec<f64> = own.iter().map(|own| own.range).collect();
        ranges.sort_by(f64::total_cmp);
        assert_eq!(
            ranges,
            [1.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0, 6.0, 7.0, 8.0, 11.0, 11.0]
        );
        assert!(own.iter().all(|own| (own.count - 1.0).abs() < 1e-12));
        // pylife's example of Haibach, "Betriebsfestigkeit", fig. 3.3-30, and that of its lecture: the cycles that close, and
        // those that its residue (2, 6, 1, 5, 2; 1, 7, 1, 2) closes when it is repeated
        let haibach = [
            2.0, 5.0, 3.0, 6.0, 2.0, 3.0, 1.0, 6.0, 1.0, 4.0, 2.0, 3.0, 1.0, 4.0, 2.0, 5.0, 3.0,
            4.0, 2.0,
        ];
        let lecture = [1.0, 7.0, 4.0, 3.0, 4.0, 2.0, 5.0, 3.0, 6.0, 1.0, 2.0];
        for (history, closed, of_residue) in [
            (
                &haibach[..],
                &[2.0, 1.0, 5.0, 1.0, 3.0, 2.0, 1.0][..],
                [5.0, 3.0],
            ),
            (&lecture[..], &[1.0, 2.0, 4.0][..], [6.0, 1.0]),
        ] {
            let mut expected = [closed, &of_residue[..]].concat();
            let own = cycles(history, Residue::Repeating);
            let mut found: Vec<f64> = own.iter().map(|own| own.range).collect();
            for ranges in [&mut expected, &mut found] {
                ranges.sort_by(f64::total_cmp);
            }
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn a_repeated_history_may_start_anywhere() {
        let wave = |k: usize| {
            let x = std::f64::consts::TAU * k as f64 / 360.0;
            30.0 * libm::sin(x) + 12.0 * libm::sin(5.0 * x + 1.0) + 4.0 * libm::cos(17.0 * x)
        };
        let history: Vec<f64> = (0..360).map(wave).collect();
        let expected = counted(&history, Residue::Repeating);
        for start in [1, 77, 180, 359] {
            let mut turned = history.clone();
            turned.rotate_left(start);
            assert_eq!(counted(&turned, Residue::Repeating), expected, "{start}");
        }
        // the largest range is that of the whole history
        let most = history.iter().fold(f64::MIN, |m, x| m.max(*x));
        let least = history.iter().fold(f64::MAX, |m, x| m.min(*x));
        let largest = cycles(&history, Residue::Repeating);
        let largest = largest.iter().map(|c| c.range).fold(0.0, f64::max);
        assert!((largest - (most - least)).abs() < 1e-12);
    }

    #[test]
    fn what_does_not_vary_has_no_cycle() {
        for residue in [Residue::HalfCycles, Residue::Repeating] {
            assert_eq!(cycles(&[], residue), []);
            assert_eq!(cycles(&[3.0; 5], residue), []);
            assert_eq!(cycles(&[f64::NAN, 3.0, f64::INFINITY], residue), []);
        }
        let one = cycles(&[0.0, 2.0, 2.0, 0.0], Residue::Repeating);
        assert_eq!(one.len(), 1);
        assert_eq!((one[0].range, one[0].mean, one[0].count), (2.0, 1.0, 1.0));
    }
}
