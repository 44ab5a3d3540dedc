//! What each name changes: how much of every channel, and what has no derivative.
use crate::data::SingleRun;
use crate::document::{Row, Table};
use crate::number::{figure, unit};
use protocol::case::Channel;
use protocol::job::{Derivative, Per};

/// Of every name and channel the root mean square and the largest change; none where nothing was asked for.
pub fn derivatives(run: &SingleRun) -> Option<Table> {
    let channels = run.case.channels_of(run.condition);
    let channels: Vec<&Channel> = channels.map(|(_, channel)| channel).collect();
    let mut rows = Vec::new();
    for (at, name) in run.derived.iter().enumerate() {
        let said = |words: &str| Row::new(name.clone(), [words, "", "", ""].map(str::to_owned));
        match run.curves.columns.get(at) {
            Some(Derivative::Curves { per, curves }) => {
                let each = channels.iter().zip(curves);
                let each = each.filter(|(_, values)| !values.is_empty());
                rows.extend(each.map(|(channel, values)| row(name, channel, per, values)));
            }
            Some(Derivative::Nothing { .. }) => rows.push(said("changes nothing")),
            Some(Derivative::Missing { reason }) => rows.push(said(reason)),
            None => rows.push(said("none: the simulation did not complete")),
        }
    }
    let head = ["", "channel", "unit", "root mean square", "largest"];
    let table = Table::new("Derivatives of the curves", head, rows);
    let table = table.noted([
        "Exact for the curves as they were computed. Per decade of an unknown on a logarithmic scale, per \
         its unit elsewhere.",
    ]);
    table.unless_empty()
}

fn row(name: &str, channel: &Channel, per: &Per, values: &[f32]) -> Row {
    let values = values.iter().map(|y| f64::from(*y));
    let square: f64 = values.clone().map(|y| y * y).sum();
    let rms = (square / values.len().max(1) as f64).sqrt();
    let largest = values.clone().fold(0.0, |most: f64, y| most.max(y.abs()));
    let unit = format!("{} per {per}", unit(&channel.unit));
    let cells = [channel.title.clone(), unit, figure(rms), figure(largest)];
    Row::new(name, cells)
}
