//! Sections of the report of an orthogonal-array test.
use super::subject::SweepInput;
use crate::chart::main_effects;
use crate::document::{Block, Row, Section, Table};
use crate::number::{MISSING, count, fixed, significant};
use crate::section::origin;
use crate::words::{join_words, objective_heading};
use protocol::case::Case;
use study::orthogonal::{Analysis, Factor, TestResult, TrialRun, VarianceSource};

/// Significance level: a factor with a larger p-value is not significant.
const LIKELY: f64 = 0.05;

/// Builds all sections of an orthogonal-array test report, in page order.
pub(super) fn all(subject: &SweepInput<'_>) -> Vec<Section> {
    vec![
        summary(subject.tested),
        effects(subject.tested),
        all_runs(subject),
        origin::section(vec![Block::Facts(origin::facts(
            &subject.origin,
            subject.case,
        ))]),
    ]
}

fn summary(tested: &TestResult) -> Section {
    let mut blocks = Vec::new();
    if let Some((analysis, confirmed)) = tested.analysis.as_ref().zip(tested.confirmation.as_ref())
    {
        blocks.push(Block::Lead(format!(
            "Best levels: {}.",
            level_names(&tested.factors, &confirmed.levels)
        )));
        blocks.push(Block::Text(format!(
            "Together they were expected to reach an objective of 10^{}; with seeds of their own they reached \
             10^{}.",
            fixed(confirmed.predicted, 3),
            confirmed
                .obtained()
                .map_or_else(|| MISSING.to_owned(), |obtained| fixed(obtained, 3))
        )));
        blocks.push(Block::Text(significance(tested, analysis)));
    } else {
        blocks.push(Block::Lead(
            "Some runs found no complete simulation: there is nothing to compare.".to_owned(),
        ));
    }
    if tested.budgets_differ() {
        let warning = "Budgets differ: not every run took as many evaluations as the others, so a level may be \
            better only because it was given more.";
        blocks.push(Block::Warning(vec![warning.to_owned()]));
    }
    Section {
        id: "outcome",
        title: "Outcome",
        blocks,
    }
}

/// States which factors are significant.
fn significance(tested: &TestResult, analysis: &Analysis) -> String {
    let Some(anova) = &analysis.anova else {
        return "The design is saturated: no degree of freedom is left for the error, so nothing can be told from \
                chance. More seeds, or fewer factors, leave some."
            .to_owned();
    };
    let telling = anova.terms.iter().filter_map(|term| match term.source {
        VarianceSource::Factor(number) if term.p.is_some_and(|p| p < LIKELY) => {
            Some(tested.factors[number].name.clone())
        }
        VarianceSource::Factor(_) | VarianceSource::Block | VarianceSource::Error => None,
    });
    let telling: Vec<String> = telling.collect();
    if telling.is_empty() {
        "No factor is significant: chance alone makes ranges as large (p of every factor is 0.05 or more).".to_owned()
    } else {
        format!(
            "Significant (p below 0.05): {}.",
            join_words(&telling, "and")
        )
    }
}

fn effects(tested: &TestResult) -> Section {
    let mut blocks = Vec::new();
    if let Some(analysis) = &tested.analysis {
        blocks.push(Block::Table(ranges(tested, analysis)));
        blocks.extend(variance(tested, analysis).map(Block::Table));
        blocks.push(Block::Figure(main_effects(tested, analysis)));
    }
    Section {
        id: "effects",
        title: "What the factors do",
        blocks,
    }
}

fn ranges(tested: &TestResult, analysis: &Analysis) -> Table {
    let all = tested.factors.iter().zip(&analysis.ranges);
    let rows = all.flat_map(|(factor, own)| {
        let title = format!("{}: range {}", factor.name, fixed(own.range, 4));
        let levels = factor.levels.iter().zip(&own.means).enumerate();
        let level = |(index, (level, mean)): (usize, (&String, &f64))| {
            let best = if index == own.best { "best" } else { "" };
            Row::new(
                level,
                [
                    fixed(*mean, 4),
                    significant(10_f64.powf(*mean)),
                    best.to_owned(),
                ],
            )
        };
        std::iter::once(Row::group(title)).chain(levels.map(level))
    });
    Table::new(
        "Range analysis",
        ["level", "mean response", "as an objective", ""],
        rows.collect(),
    )
    .with_notes(["The response is log10 of the best objective of a search at its budget; the smaller the better."])
}

fn variance(tested: &TestResult, analysis: &Analysis) -> Option<Table> {
    let anova = analysis.anova.as_ref()?;
    let rows = anova.terms.iter().map(|term| {
        let name = match term.source {
            VarianceSource::Factor(number) => tested.factors[number].name.as_str(),
            VarianceSource::Block => "seed (blocks)",
            VarianceSource::Error => "error",
        };
        let known = |value: Option<f64>| value.map_or_else(|| MISSING.to_owned(), significant);
        let cells = [
            significant(term.squares),
            term.freedom.to_string(),
            significant(term.mean_square()),
            known(term.f),
            known(term.p),
        ];
        Row::new(name, cells)
    });
    let table = Table::new(
        "Analysis of variance",
        [
            "source",
            "sum of squares",
            "degrees of freedom",
            "mean square",
            "F",
            "p",
        ],
        rows.collect(),
    );
    Some(table.with_notes([
        "Blocks are taken out of the error. p is how often chance alone makes F as large.",
    ]))
}

/// Builds the table of all runs with their factor levels.
pub(crate) fn runs(case: &Case, factors: &[Factor], tried: &[TrialRun]) -> Table {
    let heading = format!("best {}", objective_heading(case));
    let row = |run: &TrialRun| {
        Row::new(
            level_names(factors, &run.levels),
            [
                run.seed.to_string(),
                significant(run.objective.unwrap_or(f64::NAN)),
                count(run.evaluations),
            ],
        )
    };
    let rows = tried.iter().map(row).collect();
    Table::new(
        "Every run",
        ["levels", "seed", &heading, "evaluations"],
        rows,
    )
}

fn all_runs(subject: &SweepInput<'_>) -> Section {
    let TestResult {
        factors,
        runs: tried,
        ..
    } = subject.tested;
    let mut table = runs(subject.case, factors, tried);
    if let Some(confirmed) = &subject.tested.confirmation {
        table.rows.push(Row::group("confirmation"));
        table
            .rows
            .extend(runs(subject.case, factors, &confirmed.runs).rows);
    }
    Section {
        id: "runs",
        title: "Runs",
        blocks: vec![Block::Table(table)],
    }
}

/// Lists each factor of the test with its level given by `levels`, as text.
pub(crate) fn level_names(factors: &[Factor], levels: &[usize]) -> String {
    let one =
        |(factor, level): (&Factor, &usize)| format!("{} {}", factor.name, factor.levels[*level]);
    let words: Vec<String> = factors.iter().zip(levels).map(one).collect();
    words.join(", ")
}
