//! Crossover and mutation operators, drawing all random numbers from the given stream.
use super::{
    chromosome::{Chromosome, Codec},
    settings::{Crossover, Encoding, MutationUnit},
};
use crate::random::Stream;

pub(super) fn cross(
    codec: &Codec,
    rule: Crossover,
    (first, second): (&mut Chromosome, &mut Chromosome),
    stream: &mut Stream,
) {
    let point = match rule {
        Crossover::Uniform => 0,
        Crossover::OnePoint => stream.index(codec.length()),
    };
    let mut exchange = |bit: usize| match rule {
        Crossover::Uniform => stream.chance(0.5),
        Crossover::OnePoint => bit >= point,
    };
    for (gene, (a, b)) in first.0.iter_mut().zip(&mut second.0).enumerate() {
        let mask = mask(codec, gene, &mut exchange);
        let difference = (*a ^ *b) & mask;
        *a ^= difference;
        *b ^= difference;
    }
}

/// Returns a copy of the elite in which each bit (or gene) is taken from the partner with probability
/// `share`.
pub(super) fn elite_crossover(
    codec: &Codec,
    elite: &Chromosome,
    partner: &Chromosome,
    share: f64,
    stream: &mut Stream,
) -> Chromosome {
    let mut child = elite.clone();
    for (gene, (code, other)) in child.0.iter_mut().zip(&partner.0).enumerate() {
        let mask = mask(codec, gene, &mut |_| stream.chance(share));
        *code ^= (*code ^ other) & mask;
    }
    child
}

/// Mutates a chromosome in place, with a probability per bit, gene or individual.
pub(super) fn mutate(
    codec: &Codec,
    chromosome: &mut Chromosome,
    (unit, probability, real_step): (MutationUnit, f64, f64),
    stream: &mut Stream,
) {
    let bits = codec.bits() as usize;
    let genes = chromosome.0.len();
    let mut change = |places: std::ops::Range<usize>| {
        if codec.encoding() == Encoding::Real {
            let gene = (places.start + stream.index(places.len())) / bits;
            let step = real_step * stream.normal();
            if stream.chance(probability) {
                shift(codec, chromosome, gene, step);
            }
        } else {
            let place = places.start + stream.index(places.len());
            if stream.chance(probability) {
                codec.flip(chromosome, place);
            }
        }
    };
    match (unit, codec.encoding()) {
        (MutationUnit::Bit, Encoding::Binary | Encoding::Gray) => {
            (0..genes * bits).for_each(|bit| change(bit..bit + 1));
        }
        (MutationUnit::Gene, _) | (MutationUnit::Bit, Encoding::Real) => {
            (0..genes).for_each(|gene| change(gene * bits..(gene + 1) * bits));
        }
        (MutationUnit::Individual, _) => change(0..genes * bits),
    }
}

/// Returns a copy of a chromosome with `count` different random bits flipped, or, with the real encoding,
/// with `count` genes moved by a normal step.
pub(super) fn flip_some(
    codec: &Codec,
    from: &Chromosome,
    (count, real_step): (usize, f64),
    stream: &mut Stream,
) -> Chromosome {
    let mut child = from.clone();
    let places = match codec.encoding() {
        Encoding::Real => child.0.len(),
        Encoding::Binary | Encoding::Gray => codec.length(),
    };
    let mut taken: Vec<usize> = Vec::with_capacity(count);
    while taken.len() < count.min(places) {
        let place = stream.index(places);
        if taken.contains(&place) {
            continue;
        }
        taken.push(place);
        if codec.encoding() == Encoding::Real {
            let step = real_step * stream.normal();
            shift(codec, &mut child, place, step);
        } else {
            codec.flip(&mut child, place);
        }
    }
    child
}

/// Moves one gene of a chromosome by `step`, a share of its interval; stops at the ends of the interval.
fn shift(codec: &Codec, chromosome: &mut Chromosome, gene: usize, step: f64) {
    if let Some(code) = chromosome.0.get_mut(gene) {
        *code = codec.code(f64::from(*code) / f64::from(codec.largest()) + step);
    }
}

/// Returns a bit mask of a gene with those bits set for which `chosen` returns true; with the real encoding
/// all bits or none.
fn mask(codec: &Codec, gene: usize, chosen: &mut impl FnMut(usize) -> bool) -> u32 {
    let bits = codec.bits() as usize;
    if codec.encoding() == Encoding::Real {
        return if chosen(gene * bits) {
            codec.largest()
        } else {
            0
        };
    }
    (0..bits)
        .filter(|bit| chosen(gene * bits + bit))
        .fold(0, |mask, bit| mask | 1 << bit)
}
