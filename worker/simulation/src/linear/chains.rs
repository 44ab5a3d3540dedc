//! Order in which the blocks of chains are processed.
use std::ops::Range;

/// Iterates over chains of the given lengths in pairs, alternating between a block of one chain and a block
/// of the other. Each block depends on the one before it in its own chain, so that a single chain leaves most
/// of a processor's pipeline idle.
///
/// `step` receives the chain's index in the pair (0 or 1), its first block and length, and the number of its
/// blocks already processed; it returns whether blocks remain.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn interleave_chains(
    chains: &[usize],
    mut step: impl FnMut(usize, [usize; 2], usize) -> bool,
) {
    let mut first = 0;
    for pair in chains.chunks(2) {
        let mut at = [[0; 2]; 2];
        for (at, &count) in at.iter_mut().zip(pair) {
            *at = [first, count];
            first += count;
        }
        let mut more = at.map(|[_, count]| count > 0);
        let mut done = 0;
        while more[0] || more[1] {
            for k in 0..2 {
                if more[k] {
                    more[k] = step(k, at[k], done);
                }
            }
            done += 1;
        }
    }
}

/// Iterates over the ranges of blocks of chains with the given numbers of blocks.
pub(super) fn spans(chains: &[usize]) -> impl Iterator<Item = Range<usize>> + '_ {
    chains.iter().scan(0, |end, &count| {
        let start = *end;
        *end += count;
        Some(start..*end)
    })
}

/// Applies `step` to the blocks of two chains, alternating between them. Each step receives what the step
/// before in the same chain left, zeros at first: a single chain of such steps leaves most of a processor's
/// pipeline idle.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn alternate<I: ExactSizeIterator, const N: usize>(
    mut one: I,
    mut other: I,
    step: impl Fn(I::Item, &mut [f64; N]),
) {
    let (mut first, mut second) = ([0.0; N], [0.0; N]);
    let common = one.len().min(other.len());
    for (a, b) in one.by_ref().take(common).zip(other.by_ref().take(common)) {
        step(a, &mut first);
        step(b, &mut second);
    }
    for a in one {
        step(a, &mut first);
    }
    for b in other {
        step(b, &mut second);
    }
}
