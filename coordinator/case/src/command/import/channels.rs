//! Conversion of PEST observations to channels: one channel for each observation group, with the observation
//! number as abscissa. Observations of zero weight form predicted channels without a measured record.
use exchange::pest::{Control, LimitSide};
use std::collections::{BTreeMap, BTreeSet};
use toml_edit::{Array, ArrayOfTables, InlineTable, Table, Value, value};

/// Name of the CSV file to which an import writes the observations of a control file, unless its folder has one.
const OBSERVATIONS: &str = "observations.csv";

/// Returns the name of the CSV file with the observations, which none of the copied files has.
pub(super) fn file_name(copied: &[String]) -> String {
    let names = (1..).map(|number| match number {
        1 => OBSERVATIONS.to_owned(),
        _ => format!("observations_{number}.csv"),
    });
    let mut free = names.filter(|name| !copied.contains(name));
    free.next().unwrap_or_default()
}

/// Name of the channel that an import creates for prior information.
const PRIOR: &str = "prior_information";

/// PEST observations that an import converts to one channel.
#[derive(Debug)]
pub(super) struct Group<'a> {
    /// Name of the channel.
    pub(super) name: String,
    /// Name of the observation group.
    title: &'a str,
    /// Whether the group's observations have positive weights, so that they form a measured record.
    pub(super) is_measured: bool,
    pub(super) rows: Vec<Row<'a>>,
}

/// PEST observation: name, value and weight.
#[derive(Debug)]
pub(super) struct Row<'a> {
    name: &'a str,
    value: f64,
    weight: f64,
}

/// Groups the observations and the prior information by channel, in order of first appearance.
pub(super) fn groups(control: &Control) -> Vec<Group<'_>> {
    let mut all: Vec<Group<'_>> = Vec::new();
    let mut known: BTreeMap<(&str, bool, bool), usize> = BTreeMap::new();
    let observations = control.observations.iter();
    let observations = observations.map(|it| (&*it.group, false, &*it.name, it.value, it.weight));
    let prior = control.prior.iter().map(|it| {
        // prior information of one group is a limit, of all others one channel
        let is_limit = LimitSide::of_group(&it.group).is_some();
        let group = if is_limit { &*it.group } else { PRIOR };
        (group, true, &*it.name, it.value, it.weight)
    });
    for (group, is_prior, name, value, weight) in observations.chain(prior) {
        let row = Row {
            name,
            value,
            weight,
        };
        let is_measured = weight > 0.0;
        let at = *known
            .entry((group, is_prior, is_measured))
            .or_insert(all.len());
        match all.get_mut(at) {
            Some(own) => own.rows.push(row),
            None => all.push(Group {
                name: sanitized(group),
                title: group,
                is_measured,
                rows: vec![row],
            }),
        }
    }
    // a group of which a part counts is two channels
    for group in all.iter_mut().filter(|it| !it.is_measured) {
        if [false, true]
            .iter()
            .any(|prior| known.contains_key(&(group.title, *prior, true)))
        {
            group.name.push_str("_predicted");
        }
    }
    let mut taken: BTreeSet<String> = BTreeSet::new();
    for group in &mut all {
        let plain = group.name.clone();
        for number in 2.. {
            if taken.insert(group.name.clone()) {
                break;
            }
            group.name = format!("{plain}_{number}");
        }
    }
    all
}

/// Replaces every character other than ASCII letters, digits, `_` and `-` by `_`.
fn sanitized(name: &str) -> String {
    let letter = |letter: char| {
        let is_plain = letter.is_ascii_alphanumeric() || matches!(letter, '_' | '-');
        if is_plain { letter } else { '_' }
    };
    name.chars().map(letter).collect()
}

/// Returns a CSV text with the observations of all groups.
pub(super) fn table(groups: &[Group<'_>]) -> String {
    let mut text = "channel,number,observation,value,weight\n".to_owned();
    for group in groups {
        for (at, row) in group.rows.iter().enumerate() {
            let Row {
                name,
                value,
                weight,
            } = row;
            let number = at + 1;
            let name = if name.contains([',', '"']) {
                format!("\"{}\"", name.replace('"', "\"\""))
            } else {
                (*name).to_owned()
            };
            let cells = format!("{},{number},{name},{value},{weight}\n", group.name);
            text.push_str(&cells);
        }
    }
    text
}

/// Returns the `[[channels]]` tables of the imported case, one for each group of observations.
pub(super) fn tables(groups: &[Group<'_>], condition: &str, file: &str) -> ArrayOfTables {
    groups
        .iter()
        .map(|group| channel(group, condition, file))
        .collect()
}

fn channel(group: &Group<'_>, condition: &str, file: &str) -> Table {
    let mut table = Table::new();
    table.insert("name", value(&group.name));
    if group.name != group.title {
        table.insert("title", value(group.title));
    }
    table.insert("unit", value("1"));
    table.insert("condition", value(condition));
    let mut abscissa = InlineTable::new();
    abscissa.insert("name", "number".into());
    abscissa.insert("unit", "1".into());
    if group.is_measured {
        // weights are taken for inverse standard deviations
        table.insert("noise", value(1.0));
        if let Some(side) = LimitSide::of_group(group.title) {
            let limit = match side {
                LimitSide::AtMost => "at_most",
                LimitSide::AtLeast => "at_least",
            };
            table.insert("limit", value(limit));
        }
        let rows = [("column", "channel"), ("is", &group.name)];
        let rows: InlineTable = rows.into_iter().collect();
        let texts = [
            ("file", file),
            ("at", "number"),
            ("column", "value"),
            ("weight", "weight"),
        ];
        let mut record: InlineTable = texts.into_iter().collect();
        record.insert("rows", rows.into());
        table.insert("record", value(record));
    } else {
        let count = i64::try_from(group.rows.len()).unwrap_or(i64::MAX);
        let mut points = InlineTable::new();
        points.insert("first", 1.0.into());
        points.insert("step", 1.0.into());
        points.insert("count", count.into());
        abscissa.insert("points", points.into());
    }
    table.insert("abscissa", value(abscissa));
    let names: Array = group.rows.iter().map(|row| Value::from(row.name)).collect();
    let source: InlineTable = [("named", names)].into_iter().collect();
    table.insert("source", value(source));
    table
}

/// Returns the `[objective]` table, equivalent to PEST's objective: the sum of the squared weighted
/// residuals.
pub(super) fn objective(groups: &[Group<'_>], condition: &str) -> Table {
    let measured = groups.iter().filter(|group| group.is_measured);
    let term = |group: &Group<'_>| {
        let mut term = InlineTable::new();
        term.insert("channel", Value::from(&group.name));
        term.insert("weight", Value::from(group.rows.len() as f64));
        term
    };
    let mut table = Table::new();
    table.insert("condition", value(condition));
    table.insert("terms", value(measured.map(term).collect::<Array>()));
    table.insert("offset", value("fixed"));
    table
}
