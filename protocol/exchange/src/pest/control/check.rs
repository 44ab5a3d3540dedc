//! Consistency checks of a control file; violations that PEST++ tolerates become notes.
use super::model::{Control, Parameter, Transform};
use crate::Problem;
use std::collections::BTreeSet;

/// Substitute lower bound, as a fraction of the initial value, for a logarithmic parameter whose lower bound
/// is not positive and so has no logarithm.
const BELOW: f64 = 1e-10;

/// Fault of a control file: the text found, and a description of what is allowed.
type Fault = (String, &'static str);

pub(super) fn check(file: &str, control: &mut Control) -> Result<(), Problem> {
    let whole = names(control)
        .and_then(|()| groups_and_ties(control))
        .and_then(|()| equations(control));
    let each = whole.and_then(|()| {
        let notes = control.parameters.iter_mut().map(parameter);
        notes.collect::<Result<Vec<Option<String>>, Fault>>()
    });
    let notes = each.map_err(|(found, allowed)| Problem {
        file: file.to_owned(),
        line: None,
        found,
        allowed: allowed.to_owned(),
        remedy: "correct the control file".to_owned(),
    })?;
    control.notes.extend(notes.into_iter().flatten());
    Ok(())
}

/// Checks that there are parameters, observations, a command and an output file, and that all names are
/// unique.
fn names(control: &Control) -> Result<(), Fault> {
    let (parameters, observations) = (&control.parameters, &control.observations);
    if parameters.is_empty() || observations.is_empty() {
        let (here, there) = (parameters.len(), observations.len());
        let found = format!("{here} parameters and {there} observations");
        return Err((found, "at least one of each"));
    }
    if control.commands.is_empty() || control.outputs.is_empty() {
        let found = "no command line, or no output file".to_owned();
        return Err((found, "at least one command line and one output file"));
    }
    let names: Vec<&str> = parameters.iter().map(|it| &*it.name).collect();
    // prior information is compared like observations, and shares their names
    let priors = control.prior.iter().map(|it| &*it.name);
    let observed = observations.iter().map(|it| &*it.name);
    let observed: Vec<&str> = observed.chain(priors).collect();
    let grouped: Vec<&str> = control.groups.iter().map(|it| &*it.name).collect();
    unique(&grouped, "a name that no other parameter group has")?;
    unique(&names, "a name that no other parameter has")?;
    unique(
        &observed,
        "a name that no other observation or prior information has",
    )
}

fn unique(names: &[&str], allowed: &'static str) -> Result<(), Fault> {
    let mut seen = BTreeSet::new();
    let twice = names.iter().find(|name| !seen.insert(**name));
    twice.map_or(Ok(()), |name| Err((format!("`{name}` twice"), allowed)))
}

/// Checks that every parameter group exists and that every tied parameter refers to one that varies.
fn groups_and_ties(control: &Control) -> Result<(), Fault> {
    let groups: BTreeSet<&String> = control.groups.iter().map(|it| &it.name).collect();
    let known = |name: &String| name == "none" || groups.contains(name);
    let varying = control.parameters.iter().filter(|it| it.varies());
    let varying: BTreeSet<&String> = varying.map(|it| &it.name).collect();
    for parameter in &control.parameters {
        let (name, group) = (&parameter.name, &parameter.group);
        if parameter.varies() && !control.groups.is_empty() && !known(group) {
            let found = format!("group `{group}` of {name}");
            return Err((found, "one of the parameter groups"));
        }
        if let Transform::Tied(to) = &parameter.transform
            && !varying.contains(to)
        {
            let found = format!("{name} tied to `{to}`");
            return Err((found, "tied to a parameter that varies"));
        }
    }
    Ok(())
}

/// Checks that prior information refers to existing parameters and that no weight is negative.
fn equations(control: &Control) -> Result<(), Fault> {
    let known: BTreeSet<&String> = control.parameters.iter().map(|it| &it.name).collect();
    for prior in &control.prior {
        for term in &prior.terms {
            if !known.contains(&term.parameter) {
                let found = format!("`{}` in prior information {}", term.parameter, prior.name);
                return Err((found, "a parameter"));
            }
        }
    }
    let weights = control.observations.iter().map(|it| (&it.name, it.weight));
    let weights = weights.chain(control.prior.iter().map(|it| (&it.name, it.weight)));
    for (name, weight) in weights {
        if weight < 0.0 {
            return Err((format!("weight {weight} of {name}"), "0 or more"));
        }
    }
    Ok(())
}

impl Parameter {
    /// Returns whether the parameter itself is estimated, i.e. neither fixed nor tied.
    const fn varies(&self) -> bool {
        matches!(self.transform, Transform::None | Transform::Log)
    }
}

/// Checks the value and bounds of a parameter; returns a note where a violation is tolerated.
fn parameter(own: &mut Parameter) -> Result<Option<String>, Fault> {
    let (name, initial) = (own.name.clone(), own.initial);
    let mut note = None;
    if own.transform == Transform::Log {
        if initial <= 0.0 || own.upper <= 0.0 {
            let found = format!("{name}, logarithmic, at {initial} up to {}", own.upper);
            return Err((found, "positive"));
        }
        if own.lower <= 0.0 {
            own.lower = BELOW * initial;
            note = Some(format!(
                "{name} is logarithmic with a lower bound of 0 or less, which has no logarithm: it \
                 becomes {:e}",
                own.lower
            ));
        }
    }
    let (lower, upper) = (own.lower, own.upper);
    let inside = (lower..=upper).contains(&initial);
    if own.varies() && !(lower.is_finite() && upper.is_finite()) {
        let found = format!("{name} without PARLBND or PARUBND");
        return Err((found, "both bounds of a parameter that is estimated"));
    }
    if own.varies() && !inside {
        let found = format!("{name} = {initial} outside {lower} to {upper}");
        return Err((found, "within its bounds"));
    }
    if own.varies() && lower >= upper {
        return Err((
            format!("{name} from {lower} to {upper}"),
            "a lower bound below the upper bound",
        ));
    }
    if own.transform == Transform::Fixed && !inside {
        note = Some(format!(
            "{name} is fixed at {initial}, outside its bounds {lower} to {upper}: the bounds are ignored"
        ));
    }
    Ok(note)
}
