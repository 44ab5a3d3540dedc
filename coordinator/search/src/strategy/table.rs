//! Searches that first evaluate a given table of individuals.
//!
//! The whole table is evaluated as one batch. Then the search is built over a space whose starting points are
//! the surviving individuals, best first ([`Space::with_starting_points`]): populations contain them in their first
//! places, a local search begins at the best, and a strategy that can use neither ignores them. Individuals
//! of the table are not evaluated again. Strategies need no knowledge of the table.
use super::{
    archive::{Archive, EvaluatedIndividual, Residual},
    ask_tell::Strategy,
    catalogue::build,
    evaluation_result::EvaluationResult,
    family::DescentEnd,
    ordered_results::Intake,
    outcome::{Best, Finish, Progress},
    proposal::{Proposal, Purpose},
    setting::{SettingsError, require},
    settings::Settings,
};
use crate::space::Space;
use std::collections::BTreeMap;

/// Relative difference below which two gene values are considered equal: a value converted to its coordinate
/// and back differs in the last bits.
const SAME: f64 = 1e-12;

/// Builds a search over a space, from a seed, that first evaluates the given individuals: values of all
/// unknowns [declared units] inside the bounds. Their evaluations are added to those that the settings plan;
/// without individuals the search is that of [`build`].
///
/// # Errors
/// As [`build`]; if there are more individuals than evaluations are planned without them.
pub fn build_after(
    settings: &Settings,
    space: &Space,
    seed: u64,
    individuals: &[Vec<f64>],
) -> Result<Box<dyn Strategy>, SettingsError> {
    let alone = build(settings, space, seed)?;
    if individuals.is_empty() {
        return Ok(alone);
    }
    let planned = alone.progress().expected_evaluations;
    let (count, most) = (
        individuals.len(),
        format!("at most {planned}, as many as the search plans"),
    );
    require(
        count as u64 <= planned,
        "individuals to start with",
        count,
        &most,
    )?;
    let proposal = |(id, genes): (u64, &Vec<f64>)| Proposal {
        id,
        genes: genes.clone(),
        generation: 0,
        purpose: Purpose::Initial,
    };
    let outbox: Vec<Proposal> = (0..).zip(individuals).map(proposal).collect();
    let mut intake = Intake::default();
    for one in &outbox {
        intake.expect(one.id, one.genes.clone());
    }
    Ok(Box::new(TableFirst {
        outbox,
        intake,
        table: count,
        inner: alone,
        own_ids: BTreeMap::new(),
        answered_by_table: 0,
        recipe: (settings.clone(), space.clone(), seed),
    }))
}

/// Strategy that evaluates a table of individuals, then runs a search.
struct TableFirst {
    table: usize,
    /// Search that runs after the table; before that, a placeholder that only reports the planned
    /// evaluations.
    inner: Box<dyn Strategy>,
    /// Settings, space and seed from which the inner search is rebuilt.
    recipe: (Settings, Space, u64),
    /// Map from the ids of proposals handed out to their ids in the inner search.
    own_ids: BTreeMap<u64, u64>,
    /// Number of the inner search's individuals whose results were taken from the table.
    answered_by_table: u64,
    outbox: Vec<Proposal>,
    intake: Intake,
}

impl TableFirst {
    fn next_id(&self) -> u64 {
        self.intake.archive().entries().len() as u64 + self.intake.awaited()
    }

    /// Returns whether every individual of the table has its result.
    fn is_table_evaluated(&self) -> bool {
        self.intake.archive().entries().len() >= self.table
    }

    /// Builds the inner search with the surviving individuals of the table as starting points.
    fn begin(&mut self) {
        let (settings, space, seed) = &self.recipe;
        let survived: Vec<Vec<f64>> = {
            let ranked = self.intake.archive().ranked().into_iter();
            ranked.map(|one| one.genes.clone()).collect()
        };
        let space = space.clone().with_starting_points(&survived);
        // settings that made one search make another over the same box
        if let Ok(inner) = build(settings, &space, *seed) {
            self.inner = inner;
        }
        self.forward_proposals();
    }

    /// Returns the table's result for these genes, if the table contains them.
    fn table_result(&self, genes: &[f64]) -> Option<EvaluationResult> {
        let table = self.intake.archive().entries().iter().take(self.table);
        let same = |entry: &&EvaluatedIndividual| {
            let mut pairs = entry.genes.iter().zip(genes);
            pairs.all(|(a, b)| (a - b).abs() <= SAME * a.abs().max(b.abs()))
        };
        table.into_iter().find(same).map(|entry| entry.result)
    }

    /// Forwards the proposals of the inner search, answering initial individuals that are in the table
    /// directly.
    fn forward_proposals(&mut self) {
        loop {
            let asked = self.inner.ask();
            if asked.is_empty() {
                return;
            }
            for proposal in asked {
                let initial = proposal.purpose == Purpose::Initial;
                if let Some(told) = self.table_result(&proposal.genes).filter(|_| initial) {
                    self.answered_by_table += 1;
                    self.inner.tell(proposal.id, told);
                    continue;
                }
                let id = self.next_id();
                self.own_ids.insert(id, proposal.id);
                self.intake.expect(id, proposal.genes.clone());
                self.outbox.push(Proposal { id, ..proposal });
            }
        }
    }
}

impl Strategy for TableFirst {
    fn ask(&mut self) -> Vec<Proposal> {
        std::mem::take(&mut self.outbox)
    }

    fn tell(&mut self, id: u64, result: EvaluationResult) {
        self.intake.keep(id, result);
        while let Some((first, told)) = self.intake.take() {
            if let Some(own) = self.own_ids.remove(&first) {
                self.inner.tell(own, told);
                self.forward_proposals();
            } else if self.is_table_evaluated() {
                self.begin();
            }
        }
    }

    fn tell_residual(&mut self, id: u64, residual: Residual) {
        if let Some(own) = self.own_ids.get(&id) {
            self.inner.tell_residual(*own, residual);
        }
    }

    fn finished(&self) -> Option<Finish> {
        self.inner.finished().filter(|_| self.is_table_evaluated())
    }

    fn progress(&self) -> Progress {
        let inner = self.inner.progress();
        let best = self.intake.archive().best();
        Progress {
            evaluations: self.intake.archive().entries().len() as u64,
            expected_evaluations: (self.table as u64 + inner.expected_evaluations)
                .saturating_sub(self.answered_by_table),
            best_fitness: best
                .filter(|best| best.result.survived())
                .map(|best| best.result.fitness),
            ..inner
        }
    }

    fn best(&self) -> Option<Best> {
        self.intake.archive().best().map(Best::from)
    }

    fn descent_ends(&self) -> &[DescentEnd] {
        self.inner.descent_ends()
    }

    fn archive(&self) -> &Archive {
        self.intake.archive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        random::{Phase, Streams},
        strategy::{
            catalogue::{CATALOGUE, preset},
            family,
            staged::{self, StagedSettings},
            tests::{run_on, run_with, settings},
        },
        test_function::SPHERE,
    };
    use protocol::case::{Scale, Unknown};

    fn at(space: &Space, coordinates: &[f64]) -> Vec<Vec<f64>> {
        let one = |x: &f64| space.values(&vec![*x; space.dimension()]);
        coordinates.iter().map(one).collect()
    }

    #[test]
    fn every_search_evaluates_the_table_first_and_ends_no_worse_whatever_the_order() {
        let space = SPHERE.space();
        let table = at(&space, &[0.4, -0.3, 0.25]);
        let least = table.iter().map(|genes| SPHERE.tell(&space, genes).fitness);
        let least = least.fold(f64::INFINITY, f64::min);
        for preset in CATALOGUE {
            let made = || build_after(&settings(preset, &space), &space, 5, &table).unwrap();
            let straight = run_on(made().as_mut(), &SPHERE, None);
            let stream = Streams::new(1, 99).at(0, Phase::Initial, 0);
            let shuffled = run_on(made().as_mut(), &SPHERE, Some(stream));
            assert_eq!(straight, shuffled, "{}", preset.name);
            for (genes, proposal) in table.iter().zip(&straight.asked) {
                assert_eq!(*genes, proposal.genes, "{}", preset.name);
            }
            for (id, proposal) in (0..).zip(&straight.asked) {
                assert_eq!(proposal.id, id, "{}", preset.name);
            }
            assert!(straight.best.fitness <= least, "{}", preset.name);
        }
    }

    #[test]
    fn a_population_has_the_table_in_its_first_places_and_does_not_ask_again() {
        let space = SPHERE.space();
        let table = at(&space, &[0.4, -0.3, 0.25]);
        let l_shade = settings(preset("l-shade").unwrap(), &space);
        let alone = build(&l_shade, &space, 5).unwrap().ask().len();
        let mut search = build_after(&l_shade, &space, 5, &table).unwrap();
        let expected = search.progress().expected_evaluations;
        for proposal in search.ask() {
            search.tell(proposal.id, SPHERE.tell(&space, &proposal.genes));
        }
        assert_eq!(search.ask().len(), alone - table.len());
        // what the table answers counts once
        assert_eq!(search.progress().expected_evaluations, expected - 3);
        let led = space.clone().with_starting_points(&table);
        let paper = settings(preset("paper").unwrap(), &space);
        let first = build(&paper, &led, 5);
        let first = first.unwrap().ask();
        for (genes, proposal) in table.iter().zip(first) {
            for (a, b) in space.point(genes).iter().zip(space.point(&proposal.genes)) {
                assert!((a - b).abs() < 0.05, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_local_search_begins_at_the_best_that_survived() {
        let space = SPHERE.space();
        let table = at(&space, &[0.9, -0.6, 0.8]);
        let cma_es = preset("cma-es").unwrap();
        let mut settings = settings(cma_es, &space);
        cma_es.set(&mut settings, "spread", "0.000001").unwrap();
        let mut search = build_after(&settings, &space, 5, &table).unwrap();
        for proposal in search.ask() {
            // the second looks best and failed
            let complete = proposal.id != 1;
            let fitness = [3.0, 1.0, 2.0][usize::try_from(proposal.id).unwrap()];
            search.tell(proposal.id, EvaluationResult { fitness, complete });
        }
        for proposal in search.ask() {
            for x in space.point(&proposal.genes) {
                assert!((x - 0.8).abs() < 1e-3, "{x}");
            }
        }
    }

    #[test]
    fn more_than_the_search_plans_is_refused_and_an_empty_table_changes_nothing() {
        let space = SPHERE.space();
        let random = preset("random").unwrap();
        let mut settings = settings(random, &space);
        random.set(&mut settings, "points", "2").unwrap();
        let refused = build_after(&settings, &space, 5, &at(&space, &[0.1, 0.2, 0.3]));
        let error = refused.err().unwrap().to_string();
        assert!(error.contains("is 3, but must be at most 2"), "{error}");
        let mut empty = build_after(&settings, &space, 5, &[]).unwrap();
        assert_eq!(empty.ask(), build(&settings, &space, 5).unwrap().ask());
    }

    /// Checks that a search after a table, with two nearly equal minima, reports the one that did not win, and that a minimum that
    /// is much worse, or differs only in what is not determined, is none.
    #[test]
    fn descents_that_end_in_another_family_are_rivals() {
        let unknown = |name: &str| Unknown::new(name, "N/m", Scale::Logarithmic, 1.0, [1e-3, 1e3]);
        let space = Space::new(&[unknown("k"), unknown("c")]).unwrap();
        for (tilt, expected) in [(0.1, 1), (1.0, 0)] {
            // minima near x = 1 and x = -1, the second of which is worse the larger the tilt
            let residual = |genes: &[f64]| {
                let x = space.point(genes);
                vec![x[0] * x[0] - 1.0, tilt * (x[0] - 1.5), 1e-3 * x[1], 1.0]
            };
            let tell = |genes: &[f64]| EvaluationResult {
                fitness: residual(genes).iter().map(|r| r * r).sum(),
                complete: true,
            };
            let mut quick = StagedSettings::quick(&space);
            quick.parts.truncate(2);
            if let Some(staged::StageSettings::LeastSquares(race)) = quick.parts.last_mut() {
                (race.heat, race.iterations) = (100, 50);
            }
            // a table of first individuals hides nothing of what the search finds
            let table = [space.values(&[0.1, 0.2])];
            let mut strategy = build_after(&Settings::of(&quick), &space, 1, &table).unwrap();
            let best = run_with(strategy.as_mut(), &tell, &residual, None).best;
            let best = (&best.genes[..], best.fitness);
            let found = family::rivals(&space, best, strategy.descent_ends(), |name| name == "k");
            assert_eq!(found.len(), expected, "{tilt}: {found:?}");
            for rival in found {
                assert_eq!(rival.differs, ["k"]);
                let x = space.point(&rival.end.genes);
                assert!((x[0] + 1.0).abs() < 0.2, "{x:?}");
            }
        }
    }
}
