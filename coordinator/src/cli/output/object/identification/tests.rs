//! Tests of the JSON object printed by `horsehead identify CASE --output json`: field names and values.
use super::*;
use case::{Overrides, load};
use discrepancy::identify::{
    Band, BandCurve, DeterminedUnknown, DirectionPart, IdentificationResult, IntervalEnd,
};
use protocol::case::Case;
use record::noise::NoiseSource;
use report::document::TerminalStyle;
use report::{Origin, identification::report};
use std::path::Path;

/// Returns an identifiability analysis of four unknowns: bounded on both sides, only below, only above, and
/// not at all.
fn identified(case: &Case) -> IdentificationResult {
    let own = |name: &str, interval: [Option<f64>; 2]| UnknownEstimate {
        name: name.to_owned(),
        unit: "N/m".to_owned(),
        value: 2e8,
        interval,
        ends: interval.map(|end| {
            if end.is_some() {
                IntervalEnd::Rises
            } else {
                IntervalEnd::Bound
            }
        }),
        seen: Determination::of(interval[0].is_some(), interval[1].is_some()),
        correlated: vec![("kc".to_owned(), -0.9)],
        profile: vec![[1e8, 4.0], [2e8, 0.0]],
    };
    let curve = |points: usize| BandCurve {
        likeliest: vec![1.0; points],
        low: vec![0.5; points],
        high: vec![1.5; points],
    };
    let channels = case.channels_of(0);
    let channels = channels.map(|(_, channel)| curve(channel.abscissa.points.len()));
    IdentificationResult {
        genes: case.start(),
        unknowns: vec![
            own("kb1", [Some(1e8), Some(3e8)]),
            own("kb23", [Some(1e8), None]),
            own("kb4", [None, Some(3e8)]),
            own("kb56", [None, None]),
        ],
        directions: vec![Direction {
            sd_decades: f64::INFINITY,
            parts: vec![DirectionPart {
                name: "kb56".to_owned(),
                part: 1.0,
            }],
            words: "kb56: not determined by this record".to_owned(),
        }],
        nuisances: Vec::new(),
        bands: vec![Band {
            condition: 0,
            channels: channels.collect(),
        }],
        further: vec![FurtherMeasurement {
            measurement: "4 times as many cycles".to_owned(),
            pins: vec![DeterminedUnknown {
                name: "kb1".to_owned(),
                sd_now: 0.2,
                sd_then: 0.1,
            }],
        }],
        has_intervals: true,
        left: 2.0,
        is_noise: false,
        noise: NoiseSource::Stated,
        notes: Vec::new(),
    }
}

/// Checks the fields of the JSON object (gauges by number over the crank angle, an open interval end as null,
/// an interval open on both sides as a single null) and that the text report states the same results.
#[test]
fn fields_are_a_contract() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let case = load(&folder, &Overrides::default()).unwrap();
    let identified = identified(&case);
    let subject = IdentificationInput {
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
    let said = serde_json::to_value(object(&subject, 0)).unwrap();
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
    let page = report::text(&report(&subject), TerminalStyle::default());
    for words in [
        "sees 1 of 4 unknowns",
        "at least",
        "at most",
        "not determined by this record",
        "1.41 times the noise",
        "4 times as many cycles",
    ] {
        assert!(page.contains(words), "{words}: {page}");
    }
}
