//! Observations of a study's experiments, by which equal experiments are answered without a simulation.
//!
//! Fits that start where another ended, and fits of one model in another metric, ask for a point whose curves
//! and derivatives are known. A derivative has the same bits whichever others are computed with it, so that an
//! observation also answers a request for fewer derivatives.
use protocol::{
    job::{Column, Observation, SimulateSpec, Verdict},
    wire::{self, WireError},
};
use std::collections::{BTreeMap, VecDeque};

/// Numbers of curves and derivatives that are kept at most, half a gigabyte; beyond it the oldest observations
/// are forgotten.
const KEPT: usize = 1 << 26;

/// Experiment without its derivatives, as bytes.
pub(super) type Key = Vec<u8>;

/// Observations by experiment. What is kept depends on the order of insertion alone.
#[derive(Debug, Default)]
pub(super) struct KnownObservations {
    by_key: BTreeMap<Key, (Vec<Column>, Observation)>,
    order: VecDeque<Key>,
    numbers: usize,
}

/// Returns the experiment without its derivatives, as bytes.
///
/// # Errors
/// If it cannot be encoded.
pub(super) fn key(spec: &SimulateSpec) -> Result<Key, WireError> {
    wire::encode(&SimulateSpec {
        columns: Vec::new(),
        ..spec.clone()
    })
}

/// Returns the places of `wanted` among `columns`; `None` if one is missing.
pub(super) fn places(wanted: &[Column], columns: &[Column]) -> Option<Vec<usize>> {
    let place = |one: &Column| columns.iter().position(|own| own == one);
    wanted.iter().map(place).collect()
}

/// Returns an observation with the derivatives at the given places alone; a failed simulation has none.
pub(super) fn part(observation: &Observation, places: &[usize]) -> Option<Observation> {
    let column = |k: &usize| observation.columns.get(*k).cloned();
    let columns = if observation.verdict == Verdict::Complete {
        places.iter().map(column).collect::<Option<Vec<_>>>()?
    } else {
        Vec::new()
    };
    Some(Observation {
        verdict: observation.verdict,
        counters: observation.counters,
        curves: observation.curves.clone(),
        columns,
    })
}

impl KnownObservations {
    /// Returns the observation of an experiment with these derivatives, if it is known.
    pub(super) fn answer(&self, key: &Key, wanted: &[Column]) -> Option<Observation> {
        let (columns, observation) = self.by_key.get(key)?;
        if observation.verdict != Verdict::Complete {
            return part(observation, &[]);
        }
        part(observation, &places(wanted, columns)?)
    }

    /// Keeps an observation, in place of one of the same experiment with other derivatives.
    pub(super) fn insert(&mut self, key: Key, columns: Vec<Column>, observation: Observation) {
        let size = |own: &Observation| {
            let curves: usize = own.curves.iter().map(Vec::len).sum();
            curves * (1 + own.columns.len())
        };
        self.numbers += size(&observation);
        match self.by_key.insert(key.clone(), (columns, observation)) {
            Some((_, earlier)) => self.numbers -= size(&earlier),
            None => self.order.push_back(key),
        }
        while self.numbers > KEPT
            && let Some(oldest) = self.order.pop_front()
        {
            let forgotten = self.by_key.remove(&oldest);
            self.numbers -= forgotten.map_or(0, |(_, own)| size(&own));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::job::{Counters, Derivative, Identifier, Individual, Reached, Reply};

    fn spec(gene: f64, columns: &[&str]) -> SimulateSpec {
        SimulateSpec {
            columns: columns.iter().map(|name| Column::new(*name)).collect(),
            ..SimulateSpec::new(Individual::new(0, vec![gene]), Reply::Channels)
        }
    }

    fn seen(verdict: Verdict, columns: usize) -> Observation {
        let column = |k: usize| Derivative::Missing {
            reason: k.to_string(),
        };
        Observation {
            verdict,
            counters: Counters::default(),
            curves: vec![vec![1.0]],
            columns: (0..columns).map(column).collect(),
        }
    }

    /// Checks that fewer derivatives are answered in the order in which they are asked for, and others not.
    #[test]
    fn an_observation_answers_requests_for_fewer_derivatives() {
        let mut known = KnownObservations::default();
        let first = spec(1.0, &["a", "b", "c"]);
        let complete = seen(Verdict::Complete, 3);
        known.insert(key(&first).unwrap(), first.columns, complete.clone());
        let answer = |asked: &SimulateSpec| known.answer(&key(asked).unwrap(), &asked.columns);
        assert_eq!(
            answer(&spec(1.0, &["a", "b", "c"])).as_ref(),
            Some(&complete)
        );
        let fewer = answer(&spec(1.0, &["c", "a"])).unwrap();
        assert_eq!(
            fewer.columns,
            [complete.columns[2].clone(), complete.columns[0].clone()]
        );
        assert!(answer(&spec(1.0, &[])).unwrap().columns.is_empty());
        assert_eq!(answer(&spec(1.0, &["d"])), None);
        assert_eq!(answer(&spec(2.0, &["a"])), None);
    }

    /// Checks that a failed simulation answers whatever derivatives are asked for, as it would again.
    #[test]
    fn a_failed_simulation_fails_again() {
        let mut known = KnownObservations::default();
        let first = spec(1.0, &[]);
        let verdict = Verdict::Failed {
            kind: Identifier::parse("budget").unwrap(),
            reached: Reached::LoadFraction(0.5),
        };
        let failed = seen(verdict, 0);
        known.insert(key(&first).unwrap(), Vec::new(), failed.clone());
        let again = spec(1.0, &["a"]);
        let answer = known.answer(&key(&again).unwrap(), &again.columns).unwrap();
        assert_eq!(answer, failed);
    }
}
