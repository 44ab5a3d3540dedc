//! Parsing of `--derivatives`: names of the unknowns and effect parameters by which a simulation is
//! differentiated.
use protocol::{case::Case, job::Column};
use support::Problem;

const ALL: &str = "all";

/// Parses the names of unknowns and effect parameters to differentiate by, separated by commas; `all` stands
/// for the unknowns of the case and the parameters of its effects.
///
/// # Errors
/// If a name is neither an unknown nor could be a parameter of an effect, or occurs twice.
pub(crate) fn columns(case: &Case, typed: &str) -> Result<Vec<Column>, Problem> {
    let own = case.unknowns.iter().map(|unknown| unknown.name.clone());
    let parameters = case.effects.iter().flat_map(|effect| {
        let all = effect.parameters.iter();
        all.map(|(name, _)| format!("{}.{name}", effect.id))
    });
    let mut known: Vec<String> = own.collect();
    for name in parameters {
        // a parameter that is searched is an unknown already
        if !known.contains(&name) {
            known.push(name);
        }
    }
    if typed == ALL {
        return Ok(known.into_iter().map(Column::new).collect());
    }
    let mut names: Vec<&str> = Vec::new();
    for name in typed.split(',').map(str::trim) {
        let problem = if names.contains(&name) {
            "is given twice"
        } else if known.iter().any(|one| one == name) || name.contains('.') {
            names.push(name);
            continue;
        } else {
            "is not an unknown of the case"
        };
        return Err(Problem {
            message: format!("--derivatives: `{name}` {problem}"),
            remedy: format!(
                "give names separated by commas, or `{ALL}`: {}, or EFFECT.PARAMETER",
                known.join(", ")
            ),
        });
    }
    Ok(names.into_iter().map(Column::new).collect())
}
