//! Test of the rounding of channels that a worker returns for a diagnosis: the message size, and the rounding
//! error in units of the noise of the shipped records.
use super::folder;
use case::{Overrides, load_with_notes};
use discrepancy::laboratory::channels;
use protocol::case::EffectSetting;
use protocol::job::{Answer, Individual, Job, Observation, Outcome, Reply, SimulateSpec};
use record::basis::ChannelGroup;
use record::metric::Metric;
use record::noise::Noise;
use worker::handler::Prepared;

/// Number of harmonic orders that a diagnosis compares.
const ORDERS: usize = 120;
/// Upper limit on the length of a message of six channels of 720 samples (bytes); a real message of a
/// diagnosis has 6,800.
const MOST_BYTES: usize = 7_000;

fn done(prepared: &Prepared, individual: &Individual, reply: Reply) -> Answer {
    let spec = SimulateSpec::new(individual.clone(), reply);
    prepared.evaluate(&Job::Simulate(spec)).done().unwrap()
}

/// Returns the channels that a worker computes for an individual twice: as transmitted (rounded) and exact.
fn both(prepared: &Prepared, individual: &Individual) -> [Observation; 2] {
    let rounded = done(prepared, individual, Reply::Channels);
    let bytes = protocol::wire::encode(&Outcome::Done(rounded.clone())).unwrap();
    assert!(bytes.len() < MOST_BYTES);
    let everything = Reply::Curves { pictures: 0 };
    let whole = done(prepared, individual, everything).into_curves();
    let whole = whole.unwrap();
    let exact = Observation {
        verdict: whole.verdict,
        counters: whole.counters,
        curves: whole.channels,
        columns: Vec::new(),
    };
    [rounded.into_channels().unwrap(), exact]
}

/// Checks that rounding the channels moves each whitened residual by less than 3e-3 standard deviations, and
/// the change of the residuals with a searched coefficient (by 1/20 decade) or a friction by less than 0.05
/// in norm, so that no estimate or test statistic moves by more than 5 % of its uncertainty.
#[test]
fn rounded_channels_are_short_and_far_below_the_noise() {
    let loaded = load_with_notes(&folder(), &Overrides::default()).unwrap();
    let case = &loaded.case;
    let condition = case.objective.condition;
    let record = loaded.cycles.iter().find(|it| it.condition == condition);
    let record = record.unwrap();
    let groups = ChannelGroup::of(record, ORDERS, &[]);
    let noise = Noise::estimate(record, &groups, &[]);
    let metric = Metric::new(&groups, &noise);
    let prepared = Prepared::new(worker::SIMULATORS, case).unwrap();
    let whitened = |individual: &Individual| {
        let seen = both(&prepared, individual);
        seen.map(|seen| metric.whiten(&channels(&seen, record).unwrap()))
    };
    let plain = Individual::new(condition, case.start());
    let at = whitened(&plain);
    let moved = &at[0] - &at[1];
    eprintln!("residuals move by {:.1e} at most", moved.amax());
    assert!(moved.amax() < 3e-3);
    let mut beside = vec![plain; 3];
    beside[0].genes[0] *= 10_f64.powf(0.05);
    beside[1].genes[4] *= 10_f64.powf(0.05);
    beside[2].effects = vec![EffectSetting::new("pivot_friction", &[("moment", 500.0)])];
    for individual in &beside {
        let there = whitened(individual);
        let [rounded, exact] = [0, 1].map(|k| &there[k] - &at[k]);
        let error = (&rounded - &exact).norm();
        eprintln!(
            "a column of length {:.2} moves by {error:.1e}",
            exact.norm()
        );
        assert!(error < 0.05);
    }
}
