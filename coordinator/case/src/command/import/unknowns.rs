//! Conversion of PEST parameters to unknowns, with their priors and difference steps.
use exchange::pest::{
    Control, IncrementKind, Parameter, ParameterGroup, PriorInformation, Transform,
};
use std::collections::BTreeMap;
use toml_edit::{Array, ArrayOfTables, InlineTable, Table, Value, value};

/// Number of standard deviations between the lower and the upper bound of a parameter, as PEST++ assumes.
const BOUNDS_SD: f64 = 4.0;

/// Returns whether a parameter is estimated, and neither fixed nor tied.
pub(super) const fn is_searched(transform: &Transform) -> bool {
    matches!(transform, Transform::None | Transform::Log)
}

/// Returns the `[[unknowns]]` tables of the imported case for the parameters of the control file.
pub(super) fn tables(control: &Control) -> ArrayOfTables {
    let parameters = control.parameters.iter();
    let named = Named {
        parameters: parameters.clone().map(|it| (&*it.name, it)).collect(),
        groups: control.groups.iter().map(|it| (&*it.name, it)).collect(),
        greatest: parameters.clone().fold(BTreeMap::new(), |mut all, it| {
            let size = all.entry(&*it.group).or_insert(0.0_f64);
            *size = size.max(it.initial.abs());
            all
        }),
    };
    parameters.map(|own| table(&named, own)).collect()
}

/// Parameters and groups of a control file by name.
struct Named<'a> {
    parameters: BTreeMap<&'a str, &'a Parameter>,
    groups: BTreeMap<&'a str, &'a ParameterGroup>,
    /// Greatest magnitude of the initial values of each group.
    greatest: BTreeMap<&'a str, f64>,
}

fn table(named: &Named<'_>, own: &Parameter) -> Table {
    let mut table = Table::new();
    table.insert("name", value(&own.name));
    table.insert("unit", value("1"));
    let logarithmic = is_logarithmic(named, own);
    table.insert(
        "scale",
        value(if logarithmic { "logarithmic" } else { "linear" }),
    );
    if let Transform::Tied(to) = &own.transform {
        let other = named.parameters.get(&**to);
        let ratio = other.map_or(1.0, |other| own.initial / other.initial);
        let tie: InlineTable = [("to", Value::from(to)), ("ratio", ratio.into())]
            .into_iter()
            .collect();
        table.insert("tie", value(tie));
        return table;
    }
    table.insert("start", value(own.initial));
    if own.transform == Transform::Fixed {
        table.insert("fixed", value(true));
        return table;
    }
    table.insert("lower", value(own.lower));
    table.insert("upper", value(own.upper));
    let deviation = if logarithmic {
        libm::log10(own.upper / own.lower) / BOUNDS_SD
    } else {
        // halves of the interval
        2.0 / BOUNDS_SD
    };
    let prior = [("value", own.initial), ("deviation", deviation)];
    let prior: InlineTable = prior
        .into_iter()
        .map(|(key, number)| (key, Value::from(number)))
        .collect();
    table.insert("prior", value(prior));
    let group = named.groups.get(&*own.group);
    let greatest = named.greatest.get(&*own.group).copied().unwrap_or_default();
    let difference = group.and_then(|group| difference(own, (group, greatest), logarithmic));
    if let Some(difference) = difference {
        table.insert("difference", value(difference));
    }
    table
}

/// Returns whether a parameter has a logarithmic scale; a tied parameter takes the scale of its parent.
fn is_logarithmic(named: &Named<'_>, own: &Parameter) -> bool {
    match &own.transform {
        Transform::Log => true,
        Transform::Tied(to) => {
            let other = named.parameters.get(&**to);
            other.is_some_and(|other| other.transform == Transform::Log && own.initial > 0.0)
        }
        Transform::None | Transform::Fixed => false,
    }
}

/// Returns the finite-difference step of a parameter at its initial value: relative to the value on a
/// logarithmic scale, otherwise in the parameter's unit. `greatest` is the greatest magnitude in the group.
fn difference(
    own: &Parameter,
    (group, greatest): (&ParameterGroup, f64),
    logarithmic: bool,
) -> Option<f64> {
    let size = own.initial.abs();
    let step = match group.increment_kind {
        IncrementKind::Absolute => group.increment,
        IncrementKind::Relative => group.increment * size,
        IncrementKind::RelativeToMax => group.increment * greatest,
    };
    let step = step.max(group.floor);
    let share = if logarithmic { step / size } else { step };
    let most = if logarithmic {
        9.0
    } else {
        0.5 * (own.upper - own.lower)
    };
    (share > 0.0 && share <= most).then_some(share)
}

/// Returns the factor and offset with which a parameter is written to the program's input files, as an entry
/// of the case file; `None` for factor 1 and offset 0.
pub(super) fn written(own: &Parameter) -> Option<(String, Value)> {
    let is_plain = own.scale.total_cmp(&1.0).is_eq() && own.offset.total_cmp(&0.0).is_eq();
    if is_plain {
        return None;
    }
    let parts = [("factor", own.scale), ("offset", own.offset)];
    let parts: InlineTable = parts
        .into_iter()
        .map(|(key, number)| (key, Value::from(number)))
        .collect();
    Some((own.name.clone(), parts.into()))
}

/// Converts an item of prior information to an equation, whose value is compared with an observation like any
/// other.
pub(super) fn equation(prior: &PriorInformation) -> InlineTable {
    let term = |term: &exchange::pest::PriorTerm| {
        let mut parts = InlineTable::new();
        parts.insert("parameter", Value::from(&term.parameter));
        parts.insert("factor", Value::from(term.factor));
        parts.insert("log", Value::from(term.log));
        parts
    };
    let terms: Array = prior.terms.iter().map(term).collect();
    let mut equation = InlineTable::new();
    equation.insert("name", Value::from(&prior.name));
    equation.insert("terms", Value::from(terms));
    equation
}
