//! JSON lines of `horsehead evaluate`: parses requests, checks them against the search space, and formats
//! results. Independent of how individuals are scored.
use crate::cli::output::object::scored::ScoredOutput;
use case::document::nearest;
use protocol::job::Verdict;
use search::space::Space;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use study::{EvaluationRequest, Scored};

/// Input line of `horsehead evaluate`: an individual to score.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RequestLine {
    id: Value,
    genes: BTreeMap<String, f64>,
    #[serde(default)]
    residual: bool,
}

/// Output line of `horsehead evaluate`.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Line<'a> {
    /// Result of a scored individual.
    Scored {
        id: &'a Value,
        #[serde(flatten)]
        scored: ScoredOutput,
        #[serde(skip_serializing_if = "Option::is_none")]
        residual: Option<&'a [f64]>,
    },
    /// Result of an individual that was scored.
    Refused {
        id: &'a Value,
        line: usize,
        error: &'a str,
        help: &'a str,
    },
}

/// Id of a request and whether it asked for the residual; kept until its result is written.
pub(super) struct Tag {
    pub(super) id: Value,
    residual: bool,
}

/// Error for a rejected input line, with its remedy.
#[derive(Debug)]
pub(super) struct Refused {
    pub(super) id: Value,
    pub(super) error: String,
    pub(super) help: String,
}

/// Parses an input line of `horsehead evaluate` and checks its individual against the search space.
///
/// # Errors
/// If the line is not an object of the expected form, or an unknown is missing, unrecognised, not finite or
/// out of bounds.
pub(super) fn read(line: &str, space: &Space) -> Result<EvaluationRequest<Tag>, Refused> {
    let asked: RequestLine = serde_json::from_str(line).map_err(|error| {
        let value: Option<Value> = serde_json::from_str(line).ok();
        Refused {
            id: value.map_or(Value::Null, |mut value| value["id"].take()),
            error: format!("the line cannot be read: {error}"),
            help: "a line is one object, as {\"id\": 1, \"genes\": {\"stiffness\": 7e8, ..}}"
                .to_owned(),
        }
    })?;
    let refuse = |error: String, help: String| Refused {
        id: asked.id.clone(),
        error,
        help,
    };
    let names = space.axes().iter().map(|axis| axis.unknown.name.as_str());
    if let Some(name) = asked
        .genes
        .keys()
        .find(|name| space.position(name).is_none())
    {
        let near = nearest(name, names.clone());
        let help = near.map_or_else(
            || format!("the case searches {}", names.collect::<Vec<_>>().join(", ")),
            |near| format!("did you mean `{near}`?"),
        );
        return Err(refuse(
            format!("the case searches no unknown `{name}`"),
            help,
        ));
    }
    let mut own = Vec::with_capacity(space.dimension());
    for axis in space.axes() {
        let unknown = &axis.unknown;
        let name = &unknown.name;
        let value = asked.genes.get(name).copied().ok_or_else(|| {
            let help = "give every unknown that the case searches a value".to_owned();
            refuse(format!("`{name}` has no value"), help)
        })?;
        if !(unknown.lower..=unknown.upper).contains(&value) {
            let (lower, upper) = (unknown.lower, unknown.upper);
            return Err(refuse(
                format!("{name} = {value:e} lies outside its bounds"),
                format!("choose it from {lower:e} to {upper:e} {}", unknown.unit),
            ));
        }
        own.push(value);
    }
    Ok(EvaluationRequest {
        genes: space.expand(&own),
        with_residual: asked.residual,
        tag: Tag {
            residual: asked.residual,
            id: asked.id,
        },
    })
}

impl<'a> Line<'a> {
    /// Builds the output line for a scored individual; the residual is included if it was requested and the
    /// simulation was complete.
    pub(super) fn scored(tag: &'a Tag, scored: &'a Scored) -> Self {
        let residual = scored.as_ref().ok().filter(|own| {
            let complete = own.verdict == Verdict::Complete;
            tag.residual && complete
        });
        Self::Scored {
            id: &tag.id,
            scored: scored.into(),
            residual: residual.map(|own| &own.residual[..]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::case::{Scale, Unknown};

    fn space() -> Space {
        let stiff = Unknown::new("stiffness", "N/m", Scale::Logarithmic, 1e8, [1e4, 1e12]);
        let place = Unknown::new("place", "m", Scale::Linear, 0.0, [-1.0, 1.0]);
        Space::new(&[stiff, place]).unwrap()
    }

    #[test]
    fn a_line_is_taken_whole_or_refused_by_name() {
        let good = r#"{"id": "a7", "genes": {"stiffness": 2e8, "place": -0.5}, "residual": true}"#;
        let request = read(good, &space()).unwrap();
        assert_eq!(request.genes, [2e8, -0.5]);
        assert!(request.with_residual && request.tag.id == "a7");
        for (line, id, said) in [
            (
                r#"{"id": 1, "genes": {"stiffness": 2e8}}"#,
                "1",
                "`place` has no value",
            ),
            (
                r#"{"id": 2, "genes": {"stiff": 2e8, "place": 0}}"#,
                "2",
                "no unknown `stiff`",
            ),
            (
                r#"{"id": 3, "genes": {"stiffness": 1, "place": 0}}"#,
                "3",
                "stiffness = 1e0 lies outside",
            ),
            (r#"{"id": 4, "gene": {}}"#, "4", "unknown field `gene`"),
            (
                r#"{"id": 5, "genes": {"stiffness": NaN}}"#,
                "null",
                "cannot be read",
            ),
            ("nonsense", "null", "cannot be read"),
        ] {
            let refused = read(line, &space()).err().unwrap();
            assert!(refused.error.contains(said), "{}", refused.error);
            assert_eq!(refused.id.to_string(), id, "{line}");
            assert!(!refused.help.is_empty());
        }
    }
}
