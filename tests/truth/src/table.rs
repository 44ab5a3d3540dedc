//! Markdown tables of the score metrics and of the individual trials.
use crate::interval::clopper_pearson;
use crate::plan::Stratum;
use crate::scoring::{Outcome, Trial};
use std::fmt::{Result, Write as _};

/// Formats `hits / trials` as a percentage with its Clopper-Pearson 95 % confidence interval.
fn share(hits: usize, trials: usize) -> String {
    if trials == 0 {
        return "-".to_owned();
    }
    let [lower, upper] = clopper_pearson(hits, trials).map(|x| 100.0 * x);
    let percent = 100.0 * hits as f64 / trials as f64;
    format!("{hits}/{trials} = {percent:.0} % [{lower:.0}-{upper:.0}]")
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Formats the diagnosis metrics by stratum, followed by the list of all trials (diagnosed sets).
///
/// # Errors
/// Never in practice, since the text is written to memory.
pub fn table(trials: &[Trial], unjudged: usize) -> std::result::Result<String, std::fmt::Error> {
    let mut table = Table {
        trials,
        text: String::new(),
    };
    table.line("metric", "target", "found [95 %]")?;
    table.line("---", "---", "---")?;
    table.singles()?;
    table.names()?;
    table.in_part()?;
    table.others()?;
    table.sizes()?;
    let judged = trials.len();
    writeln!(
        table.text,
        "\n{judged} sets judged, {unjudged} without a verdict.\n"
    )?;
    table.list()?;
    Ok(table.text)
}

struct Table<'a> {
    trials: &'a [Trial],
    text: String,
}

impl<'a> Table<'a> {
    fn line(&mut self, metric: &str, target: &str, value: &str) -> Result {
        writeln!(self.text, "| {metric} | {target} | {value} |")
    }

    /// Writes a line of the metric table: the share of the trials in `among` for which `test` holds.
    fn share(
        &mut self,
        metric: &str,
        target: &str,
        among: &[&Trial],
        test: impl Fn(&Trial) -> bool,
    ) -> Result {
        let hits = among.iter().filter(|trial| test(trial)).count();
        let value = share(hits, among.len());
        self.line(metric, target, &value)
    }

    fn of(&self, stratum: Stratum) -> Vec<&'a Trial> {
        let all = self.trials.iter();
        all.filter(|trial| trial.answer.stratum == stratum)
            .collect()
    }

    fn singles(&mut self) -> Result {
        let single = self.of(Stratum::Single);
        // every single is counted once, and all of them are the denominator
        for (outcome, words) in Outcome::ALL {
            self.share(&format!("single: {words}"), "", &single, |trial| {
                trial.outcome() == outcome
            })?;
        }
        let all = self.trials;
        let large = |trial: &&Trial| {
            trial
                .size_over_detection_limit(all)
                .is_some_and(|times| times >= 3.0)
        };
        let large: Vec<&Trial> = single.iter().copied().filter(large).collect();
        self.share(
            "single, at least 3 x the limit of an empty set: first name right",
            ">= 85 %",
            &large,
            Trial::first_is_right,
        )?;
        self.share(
            "at least 3 x the limit: ambiguity set contains the hidden effect",
            ">= 95 %",
            &large,
            Trial::first_set_contains_truth,
        )?;
        let small = (single.len() - large.len()).to_string();
        self.line("single, below that or without such a limit", "", &small)?;
        let named = |trial: &&Trial| trial.verdict.has_names();
        let named: Vec<&Trial> = single.into_iter().filter(named).collect();
        self.share(
            "single, named: ambiguity set contains the hidden effect",
            ">= 95 %",
            &named,
            Trial::first_set_contains_truth,
        )?;
        let size = |trial: &&Trial| {
            let first = trial.verdict.added().next()?;
            Some(trial.verdict.ambiguity_set(first).len() as f64)
        };
        let sets: Vec<f64> = named.iter().filter_map(size).collect();
        self.line("mean size of the ambiguity set", "<= 2", &mean(&sets))
    }

    fn names(&mut self) -> Result {
        let wrong = self.trials.iter().map(Trial::false_names).sum();
        let all = self.trials.iter().map(|t| t.verdict.added().count()).sum();
        self.line("false names of all names", "<= 10 %", &share(wrong, all))
    }

    /// Writes how many names are said in part, and how many of the false ones.
    fn in_part(&mut self) -> Result {
        let named = |trial: &&Trial| trial.verdict.has_names();
        let named: Vec<&Trial> = self.trials.iter().filter(named).collect();
        let in_part = |trial: &Trial| trial.verdict.in_part;
        self.share("named: said in part", "", &named, in_part)?;
        let is_false = |trial: &&Trial| trial.false_names() > 0;
        let wrong: Vec<&Trial> = named.into_iter().filter(is_false).collect();
        self.share("a false name: said in part", "", &wrong, in_part)
    }

    fn others(&mut self) -> Result {
        let claims = |trial: &Trial| trial.verdict.claims();
        let zero = self.of(Stratum::Zero);
        self.share("zero: any claim", "<= 5 %", &zero, claims)?;
        self.share(
            "zero: no effect named",
            ">= 95 %",
            &zero,
            Trial::names_no_effect,
        )?;
        let double = self.of(Stratum::Double);
        let exact = |trial: &Trial| trial.right() == 2 && trial.verdict.added().count() == 2;
        self.share("double: exactly both", ">= 60 %", &double, exact)?;
        self.share("double: at least one", ">= 85 %", &double, |t| {
            t.right() > 0
        })?;
        let detected = |trial: &&Trial| trial.verdict.verdict != "nothing_detected";
        let outside: Vec<&Trial> = self.of(Stratum::Outside);
        let outside: Vec<&Trial> = outside.into_iter().filter(detected).collect();
        self.share("outside, detected: unlisted", ">= 90 %", &outside, |t| {
            t.verdict.verdict == "unlisted"
        })?;
        let outside = self.of(Stratum::Outside);
        self.share(
            "outside: no effect named",
            ">= 90 %",
            &outside,
            Trial::names_no_effect,
        )?;
        let cards = self.of(Stratum::Card);
        self.share(
            "card cut: no other effect named",
            ">= 90 %",
            &cards,
            |trial| trial.false_names() == 0,
        )?;
        let below = self.of(Stratum::Below);
        self.share("below the limit: any claim", "<= 5 %", &below, claims)
    }

    fn sizes(&mut self) -> Result {
        let sizes: Vec<(f64, bool)> = self.trials.iter().flat_map(Trial::size_errors).collect();
        let error = median(sizes.iter().map(|(error, _)| 100.0 * error).collect());
        let error = error.map_or("-".to_owned(), |error| format!("{error:.1} %"));
        self.line("size of a right name: median error", "<= 10 %", &error)?;
        let covered = sizes.iter().filter(|(_, covered)| *covered).count();
        let covered = share(covered, sizes.len());
        self.line(
            "size of a right name: inside its 95 % interval",
            "90 to 98 %",
            &covered,
        )?;
        let each = self.trials.iter().map(Trial::nuisances_held);
        let [held, all] = each.fold([0, 0], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
        self.line(
            "95 % intervals of instruments hold",
            "90 to 98 %",
            &share(held, all),
        )?;
        let right = self.trials.iter().filter(|trial| trial.first_is_right());
        let closed = median(
            right
                .filter_map(|trial| trial.verdict.gap_closed_in_other_condition())
                .collect(),
        );
        let closed = closed.map_or("-".to_owned(), |share| format!("{:.0} %", 100.0 * share));
        self.line(
            "other condition: gap closed, median, right name",
            ">= 80 %",
            &closed,
        )
    }

    /// Writes a table of all trials, each with its hidden effects and its verdict.
    fn list(&mut self) -> Result {
        self.text.push_str(
            "| set | stratum | channels | noise | hidden | times limit | verdict | named (set) | mark |\n\
             |---|---|---|---|---|---|---|---|---|\n",
        );
        let mut sorted: Vec<&Trial> = self.trials.iter().collect();
        let first = |trial: &Trial| trial.answer.effects.first().map(|effect| effect.id.clone());
        sorted.sort_by_key(|trial| (trial.answer.stratum, first(trial)));
        for trial in sorted {
            let effects = trial.answer.effects.iter();
            let hidden: Vec<String> = effects
                .map(|e| format!("{} {:.3e} {}", e.id, e.value, e.unit))
                .collect();
            let over = trial.size_over_detection_limit(self.trials);
            writeln!(
                self.text,
                "| {} | {} | {} | {} | {} | {} | {} | {} | {} |",
                trial.name,
                trial.answer.stratum.name(),
                trial.answer.channels,
                trial.answer.noise,
                hidden.join(" + "),
                over.map_or("-".to_owned(), |times| format!("{times:.1}")),
                trial.verdict.verdict,
                names(trial),
                trial.label(),
            )?;
        }
        Ok(())
    }
}

/// Formats the effects that a trial's verdict names, each with its ambiguity set.
fn names(trial: &Trial) -> String {
    let one = |id: &str| {
        let set = trial.verdict.ambiguity_set(id);
        let others: Vec<&str> = set.into_iter().filter(|other| *other != id).collect();
        if others.is_empty() {
            id.to_owned()
        } else {
            format!("{id} ({})", others.join(", "))
        }
    };
    trial
        .verdict
        .added()
        .map(one)
        .collect::<Vec<_>>()
        .join(" + ")
}

fn mean(values: &[f64]) -> String {
    if values.is_empty() {
        return "-".to_owned();
    }
    format!("{:.2}", values.iter().sum::<f64>() / values.len() as f64)
}
