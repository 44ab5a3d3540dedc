//! Of `horsehead identify`.
use crate::{kind, report::identification::Subject, study::StageCost};
use discrepancy::{
    diagnose::NeverExact,
    identify::{Direction, Further, Seen, UnknownEstimate},
    laboratory::Stage,
};
use serde::Serialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// What a record sees.
#[derive(Debug, Serialize)]
pub(crate) struct IdentifyOutput {
    run: String,
    case: String,
    /// By name.
    unknowns: BTreeMap<String, UnknownOutput>,
    /// From the best seen to the blind ones.
    directions: Vec<Direction>,
    /// By condition.
    prediction: BTreeMap<String, Map<String, Value>>,
    nuisances: Vec<NeverExact>,
    /// What further measurements would pin down.
    further: Vec<Further>,
    /// How many times the noise the fit leaves.
    times_noise: f64,
    /// Whether that is more than noise: then intervals are widened, and a diagnosis comes first.
    diagnose_first: bool,
    assumed_noise: bool,
    notes: Vec<String>,
    /// Simulations, by how they were asked for.
    simulations: u64,
    wall_s: f64,
}

/// An unknown with what the record says of it.
#[derive(Debug, Serialize)]
struct UnknownOutput {
    value: f64,
    unit: String,
    /// Null for an open end; null as a whole where both are open.
    ci95: Option<[Option<f64>; 2]>,
    seen: Seen,
    correlated_with: Vec<CorrelationOutput>,
    /// How each side ends: `rises`, `bound`, `fails`, `given_up`.
    ends: [discrepancy::identify::End; 2],
    /// Values with the rise of -2 ln L, all else refitted.
    profile: Vec<[f64; 2]>,
}

#[derive(Debug, Serialize)]
struct CorrelationOutput {
    name: String,
    correlation: f64,
}

fn unknown(own: &UnknownEstimate) -> UnknownOutput {
    let correlated = own.correlated.iter();
    UnknownOutput {
        value: own.value,
        unit: own.unit.clone(),
        ci95: (own.seen != Seen::NotSeen).then_some(own.interval),
        seen: own.seen,
        correlated_with: correlated
            .map(|(name, correlation)| CorrelationOutput {
                name: name.clone(),
                correlation: *correlation,
            })
            .collect(),
        ends: own.ends,
        profile: own.profile.clone(),
    }
}

/// The object.
pub(crate) fn object(subject: &Subject<'_>, accounts: &[(Stage, StageCost)]) -> IdentifyOutput {
    let (case, identified) = (subject.case, subject.identified);
    let unknowns = identified.unknowns.iter();
    let bands = identified.bands.iter();
    let notes = subject.notes.iter().chain(&identified.notes);
    IdentifyOutput {
        run: subject.origin.run.clone(),
        case: case.name.clone(),
        unknowns: unknowns
            .map(|own| (own.name.clone(), unknown(own)))
            .collect(),
        directions: identified.directions.clone(),
        prediction: bands
            .map(|band| {
                let name = case.conditions[band.condition].name.clone();
                (name, kind::of(case).predicted(case, band))
            })
            .collect(),
        nuisances: identified.nuisances.clone(),
        further: identified.further.clone(),
        times_noise: identified.left,
        diagnose_first: !identified.is_noise,
        assumed_noise: !identified.noise.is_seen(),
        notes: notes.cloned().collect(),
        simulations: accounts.iter().map(|(_, cost)| cost.experiments).sum(),
        wall_s: subject.wall_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        case::{Overrides, load},
        report::{Origin, identification::report},
    };
    use discrepancy::{
        identify::{Band, Curve, End, Identified, Part, Pin},
        record::noise::Known,
    };
    use protocol::case::Case;
    use std::path::Path;

    /// Four unknowns, one seen in each way.
    fn identified(case: &Case) -> Identified {
        let own = |name: &str, interval: [Option<f64>; 2]| UnknownEstimate {
            name: name.to_owned(),
            unit: "N/m".to_owned(),
            value: 2e8,
            interval,
            ends: interval.map(|end| {
                if end.is_some() {
                    End::Rises
                } else {
                    End::Bound
                }
            }),
            seen: Seen::of(interval[0].is_some(), interval[1].is_some()),
            correlated: vec![("kc".to_owned(), -0.9)],
            profile: vec![[1e8, 4.0], [2e8, 0.0]],
        };
        let curve = |points: usize| Curve {
            likeliest: vec![1.0; points],
            low: vec![0.5; points],
            high: vec![1.5; points],
        };
        let channels = case.channels_of(0);
        let channels = channels.map(|(_, channel)| curve(channel.abscissa.points.len()));
        Identified {
            genes: case.start(),
            unknowns: vec![
                own("kb1", [Some(1e8), Some(3e8)]),
                own("kb23", [Some(1e8), None]),
                own("kb4", [None, Some(3e8)]),
                own("kb56", [None, None]),
            ],
            directions: vec![Direction {
                sd_decades: f64::INFINITY,
                parts: vec![Part {
                    name: "kb56".to_owned(),
                    part: 1.0,
                }],
                words: "kb56: not seen by this record".to_owned(),
            }],
            nuisances: Vec::new(),
            bands: vec![Band {
                condition: 0,
                channels: channels.collect(),
            }],
            further: vec![Further {
                measurement: "4 times as many cycles".to_owned(),
                pins: vec![Pin {
                    name: "kb1".to_owned(),
                    sd_now: 0.2,
                    sd_then: 0.1,
                }],
            }],
            left: 2.0,
            is_noise: false,
            noise: Known::Stated,
            notes: Vec::new(),
        }
    }

    /// Gauges by number over the crank's angle, open ends as null, what both sides leave open as one null; and
    /// the page says the same in words.
    #[test]
    fn fields_are_a_contract() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
        let case = load(&folder, &Overrides::default()).unwrap();
        let identified = identified(&case);
        let subject = Subject {
            case: &case,
            identified: &identified,
            origin: Origin {
                program: String::new(),
                command: String::new(),
                run: "runs/x".to_owned(),
                case_hash: String::new(),
                measured_name: String::new(),
                preset: None,
                seed: Some(1),
                digest: String::new(),
                synthetic: true,
            },
            notes: &[],
            wall_s: 1.0,
        };
        let said = serde_json::to_value(object(&subject, &[])).unwrap();
        let unknowns = &said["unknowns"];
        assert_eq!(unknowns["kb1"]["ci95"], serde_json::json!([1e8, 3e8]));
        assert_eq!(unknowns["kb23"]["ci95"], serde_json::json!([1e8, null]));
        assert_eq!(unknowns["kb4"]["ci95"], serde_json::json!([null, 3e8]));
        assert_eq!(unknowns["kb56"]["ci95"], Value::Null);
        let seen = ["kb1", "kb23", "kb4", "kb56"].map(|name| unknowns[name]["seen"].clone());
        assert_eq!(seen, ["both", "lower_bound", "upper_bound", "not_seen"]);
        let correlated = serde_json::json!([{"name": "kc", "correlation": -0.9}]);
        assert_eq!(unknowns["kb1"]["correlated_with"], correlated);
        assert_eq!(unknowns["kb1"]["unit"], "N/m");
        assert_eq!(said["directions"][0]["sd_decades"], Value::Null);
        let prediction = &said["prediction"]["5rpm"];
        assert_eq!(prediction["unit"], "MPa");
        for key in ["1", "2", "3", "4"] {
            let ends = ["low", "high"].map(|end| prediction[key][end][0].clone());
            assert_eq!(ends, [0.5, 1.5], "{prediction}");
        }
        let degrees = prediction["crank_deg"].as_array().unwrap();
        assert_eq!(
            degrees.len(),
            prediction["1"]["low"].as_array().unwrap().len()
        );
        assert_eq!(said["diagnose_first"], true);
        assert_eq!(said["assumed_noise"], true);
        let page = crate::report::text(&report(&subject), false);
        for words in [
            "sees 1 of 4 unknowns",
            "at least",
            "at most",
            "not seen by this record",
            "2.00 times the noise",
            "4 times as many cycles",
        ] {
            assert!(page.contains(words), "{words}: {page}");
        }
    }
}
