//! Tables and JSON object of `horsehead life`.
use super::{
    options::LifePlan,
    spots::{AssessedVariant, HotSpot, Life},
};
use crate::cli::argument::hours::Operation;
use fatigue::{Criterion, MeanStress};
use protocol::case::Case;
use report::document::{Row, Table};
use serde::Serialize;
use serde_json::{Value, json};

/// Output object of `horsehead life`.
#[derive(Debug, Serialize)]
pub(super) struct LifeOutput<'a> {
    case: &'a str,
    curve: &'a str,
    source: &'a str,
    /// Survival probability of the curve, null where its source states none.
    survival: Option<f64>,
    mean_stress: Value,
    stress: &'static str,
    factor: f64,
    target_years: f64,
    yield_mpa: f64,
    conditions: Vec<Value>,
    /// Hot spots of the last variant.
    hot_spots: Vec<Value>,
    /// Gauges 1 to 4 of the last variant.
    gauges: Vec<Value>,
    variants: Vec<Value>,
    wall_s: f64,
}

/// Builds the output object.
pub(super) fn object<'a>(
    case: &'a Case,
    plan: &'a LifePlan,
    assessed: &[AssessedVariant],
    wall_s: f64,
) -> LifeOutput<'a> {
    let condition = |own: &Operation| {
        json!({
            "name": own.name,
            "hours_per_day": own.hours_per_day,
            "revolutions_per_day": own.revolutions_per_day,
        })
    };
    let variants: Vec<Value> = assessed.iter().map(|own| variant(plan, own)).collect();
    let last = assessed.last();
    let spots = last.map_or(&[][..], |own| &own.hot_spots);
    let gauges = last.map_or(&[][..], |own| &own.gauges);
    LifeOutput {
        case: &case.name,
        curve: &plan.assessment.curve.name,
        source: &plan.assessment.curve.source,
        survival: plan.assessment.curve.survival,
        mean_stress: mean_stress(plan.assessment.mean_stress),
        stress: match plan.criterion {
            Criterion::NormalStress => "normal",
            Criterion::SignedVonMises => "von_mises",
        },
        factor: plan.assessment.factor,
        target_years: plan.target_years,
        yield_mpa: plan.yield_mpa,
        conditions: plan.operations.iter().map(condition).collect(),
        hot_spots: spots.iter().map(|own| spot(plan, own)).collect(),
        gauges: gauges.iter().map(|own| life(plan, own)).collect(),
        variants,
        wall_s,
    }
}

fn mean_stress(rule: MeanStress) -> Value {
    match rule {
        MeanStress::Ignored => json!({"rule": "none"}),
        MeanStress::Goodman { strength } => json!({"rule": "goodman", "strength_mpa": strength}),
        MeanStress::Gerber { strength } => json!({"rule": "gerber", "strength_mpa": strength}),
        MeanStress::Walker { exponent } => json!({"rule": "walker", "exponent": exponent}),
    }
}

fn variant(plan: &LifePlan, own: &AssessedVariant) -> Value {
    json!({
        "name": own.name,
        "hot_spots": own.hot_spots.iter().map(|own| spot(plan, own)).collect::<Vec<_>>(),
        "gauges": own.gauges.iter().map(|own| life(plan, own)).collect::<Vec<_>>(),
    })
}

fn spot(plan: &LifePlan, own: &HotSpot) -> Value {
    let [x, y, z] = own.place_m;
    let mut said = json!({
        "x_m": x,
        "y_m": y,
        "z_m": z,
        "near": own.bearing.map(|own| format!("pin {}", own.pin)),
        "angle_deg": own.bearing.map(|own| own.angle_deg),
        "distance_m": own.bearing.map(|own| own.distance_m),
        "inner_edge": own.inner_edge,
        "von_mises_mpa": own.von_mises_mpa,
    });
    if let (Some(said), Value::Object(more)) = (said.as_object_mut(), life(plan, &own.life)) {
        said.extend(more);
    }
    said
}

fn life(plan: &LifePlan, own: &Life) -> Value {
    // a life without end is no number of JSON
    let finite = |years: f64| years.is_finite().then_some(years);
    let conditions = plan.operations.iter().zip(&own.damage_per_revolution);
    let conditions = conditions.zip(&own.shares).map(|((operation, damage), share)| {
        json!({"condition": operation.name, "damage_per_revolution": damage, "share": share})
    });
    json!({
        "life_years": {
            "value": finite(own.years),
            "ci95": own.ci95(),
            "drawn": own.log_interval.map(|own| own.drawn),
            "drawn_inside": own.log_interval.map(|own| own.inside),
            "over_fits": own.over_fits.map(|ends| ends.map(finite)),
        },
        "damage": conditions.collect::<Vec<_>>(),
        "load_factor": own.load_factor,
        "range_mpa": own.range_mpa,
    })
}

/// States the shortest life, where it is, and its interval.
pub(super) fn lead(plan: &LifePlan, assessed: &[AssessedVariant]) -> String {
    let Some(last) = assessed.last() else {
        return "Nothing is assessed.".to_owned();
    };
    let curve = &plan.assessment.curve.name;
    let gauges = (1..).zip(&last.gauges);
    let worst = gauges.min_by(|a, b| a.1.years.total_cmp(&b.1.years));
    let (place, life) = match (last.hot_spots.first(), worst) {
        (Some(spot), _) => {
            let place = spot.bearing.map_or_else(String::new, |own| {
                format!(
                    " beside pin {}, {:.0} deg from x, {:.0} mm from its hole,",
                    own.pin,
                    own.angle_deg,
                    1e3 * own.distance_m
                )
            });
            let edge = if spot.inner_edge {
                " at an inner edge,"
            } else {
                ""
            };
            (place + edge, &spot.life)
        }
        (None, Some((number, life))) => (format!(" of the gauges at {number},"), life),
        (None, None) => return "Nothing is assessed.".to_owned(),
    };
    let ends = |[low, high]: [f64; 2]| format!("{} to {}", years(low), years(high));
    let spread = match (life.ci95(), life.over_fits) {
        (Some(own), _) => format!(" (95 %: {})", ends(own)),
        (None, Some(own)) => format!(" (over the fits of the search: {})", ends(own)),
        (None, None) => String::new(),
    };
    if life.years.is_finite() {
        format!(
            "With the {} parameters the head cracks first{place} after {} years{spread}, by {curve}.",
            last.name,
            years(life.years),
        )
    } else {
        format!(
            "With the {} parameters no stress of the head does damage, by {curve}.",
            last.name
        )
    }
}

/// Writes every place of every variant as CSV: one line for each hot spot and gauge.
///
/// # Errors
/// None that memory does not have.
pub(super) fn csv(assessed: &[AssessedVariant]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "parameters",
        "place",
        "near",
        "angle_deg",
        "distance_m",
        "x_m",
        "y_m",
        "z_m",
        "range_mpa",
        "life_years",
        "life_low",
        "life_high",
        "load_factor",
        "inner_edge",
    ])?;
    let optional = |value: Option<f64>| value.map_or_else(String::new, |x| x.to_string());
    let of_life = |own: &Life| {
        let [low, high] = own.ci95().map_or([None; 2], |ends| ends.map(Some));
        let life = own.years.is_finite().then_some(own.years);
        [
            own.range_mpa.to_string(),
            optional(life),
            optional(low),
            optional(high),
            optional(own.load_factor),
        ]
    };
    for variant in assessed {
        for (number, own) in (1..).zip(&variant.hot_spots) {
            let bearing = own.bearing.as_ref();
            let mut cells = vec![
                variant.name.clone(),
                format!("hot spot {number}"),
                bearing.map_or_else(String::new, |own| format!("pin {}", own.pin)),
                optional(bearing.map(|own| own.angle_deg)),
                optional(bearing.map(|own| own.distance_m)),
            ];
            cells.extend(own.place_m.map(|x| x.to_string()));
            cells.extend(of_life(&own.life));
            cells.push(own.inner_edge.to_string());
            writer.write_record(cells)?;
        }
        for (number, own) in (1..).zip(&variant.gauges) {
            let mut cells = vec![variant.name.clone(), format!("gauge {number}")];
            cells.resize(8, String::new());
            cells.extend(of_life(own));
            cells.push(String::new());
            writer.write_record(cells)?;
        }
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// Builds the tables: the hot spots of the last variant, the gauges, and the shortest lives of all variants.
pub(super) fn tables(plan: &LifePlan, assessed: &[AssessedVariant]) -> Vec<Table> {
    let mut tables = Vec::new();
    let Some(last) = assessed.last() else {
        return tables;
    };
    let head = [
        "hot spot",
        "near",
        "angle deg",
        "from the hole mm",
        "z mm",
        "edge",
        "range MPa",
        "life years",
        "spread",
        "load factor",
    ];
    let ranged = |own: &Life| {
        let ends = |[low, high]: [f64; 2]| format!("{} to {}", years(low), years(high));
        let interval = own.ci95().map(|own| format!("95 %: {}", ends(own)));
        let over_fits = || own.over_fits.map(|own| format!("fits: {}", ends(own)));
        interval.or_else(over_fits).unwrap_or_default()
    };
    let factor = |own: &Life| {
        own.load_factor
            .map_or_else(String::new, |x| format!("{x:.2}"))
    };
    let spots = (1_usize..).zip(&last.hot_spots).map(|(number, own)| {
        let millimetres = |x: f64| format!("{:.0}", 1e3 * x);
        let of_pin = |text: &dyn Fn(&super::place::Bearing) -> String| {
            own.bearing.as_ref().map_or_else(String::new, text)
        };
        Row::new(
            number.to_string(),
            [
                of_pin(&|own| format!("pin {}", own.pin)),
                of_pin(&|own| format!("{:.0}", own.angle_deg)),
                of_pin(&|own| millimetres(own.distance_m)),
                millimetres(own.place_m[2]),
                if own.inner_edge { "inner" } else { "" }.to_owned(),
                format!("{:.1}", own.life.range_mpa),
                years(own.life.years),
                ranged(&own.life),
                factor(&own.life),
            ],
        )
    });
    let title = format!(
        "Life of the back head with the {} parameters, {}",
        last.name, plan.assessment.curve.name
    );
    tables.extend(Table::new(title, head, spots.collect()).non_empty());
    let head = ["", "range MPa", "life years", "spread", "load factor"];
    let gauges = (1..).zip(&last.gauges).map(|(number, own)| {
        let cells = [
            format!("{:.1}", own.range_mpa),
            years(own.years),
            ranged(own),
            factor(own),
        ];
        Row::new(format!("gauge {number}"), cells)
    });
    tables.push(Table::new("Life at the gauges", head, gauges.collect()));
    if assessed.len() > 1 {
        tables.push(by_parameters(assessed));
    }
    tables
}

/// Builds the table of the shortest life of each variant: on the surface, else at the gauges.
fn by_parameters(assessed: &[AssessedVariant]) -> Table {
    let rows = assessed.iter().map(|own| {
        let gauges = (1..).zip(&own.gauges);
        let gauge = gauges.min_by(|a, b| a.1.years.total_cmp(&b.1.years));
        let shortest = own.hot_spots.first().map(|spot| {
            let place = spot.bearing.map_or_else(String::new, |own| {
                format!("pin {}, {:.0} deg", own.pin, own.angle_deg)
            });
            (place, &spot.life)
        });
        let shortest = shortest.or(gauge.map(|(number, life)| (format!("gauge {number}"), life)));
        let cells = shortest.map_or([const { String::new() }; 3], |(place, life)| {
            [place, format!("{:.1}", life.range_mpa), years(life.years)]
        });
        Row::new(own.name.clone(), cells)
    });
    let head = ["", "worst place", "range MPa", "life years"];
    Table::new("Shortest life by parameters", head, rows.collect())
}

/// Returns a life in words.
fn years(years: f64) -> String {
    if years >= 1e4 {
        return if years.is_finite() {
            format!("{years:.1e}")
        } else {
            "no damage".to_owned()
        };
    }
    let digits = usize::from(years < 10.0);
    format!("{years:.digits$}")
}
