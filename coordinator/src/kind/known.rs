//! Objects that commands print for a kind of model; the general form, for every kind, is the default of each.
use crate::digest::Digest;
use discrepancy::identify::Band;
use protocol::{
    case::{Case, Channel},
    job::{ChannelScore, Curves, Per},
    wire::WireError,
};
use serde_json::{Map, Value, json};

/// A kind of model as the coordinator knows it.
pub(crate) trait Kind: Sync {
    /// As cases name it.
    fn name(&self) -> &'static str;

    /// Hash of all result bits: 64 hexadecimal digits. Wall time is left out.
    ///
    /// # Errors
    /// If the answer says nothing of this kind.
    fn digest(&self, drawn: &Curves) -> Result<String, WireError> {
        let mut digest = Digest::of(drawn.verdict);
        for curve in &drawn.channels {
            digest.curve(curve);
        }
        digest.bytes(&drawn.details);
        Ok(digest.end(drawn.verdict, &drawn.counters))
    }

    /// What `simulate --output json` says of the curves.
    ///
    /// # Errors
    /// If the answer says nothing of this kind.
    fn drawn(
        &self,
        case: &Case,
        condition: usize,
        drawn: &Curves,
    ) -> Result<Map<String, Value>, WireError> {
        let channels = case.channels_of(condition).zip(&drawn.channels);
        let curves = channels.map(|((_, channel), values)| {
            let abscissa = &channel.abscissa;
            // a run that failed has no values behind that
            let points = abscissa.points.iter().take(values.len());
            let points: Vec<f64> = points.copied().collect();
            let curve = json!({
                "unit": channel.unit,
                "abscissa": {"name": abscissa.name, "unit": abscissa.unit, "points": points},
                "values": values,
            });
            (channel.name.clone(), curve)
        });
        let curves = Value::Object(curves.collect());
        Ok(Map::from_iter([("curves".to_owned(), curves)]))
    }

    /// What `simulate --derivatives --output json` says of a derivative per `per`, channel by channel.
    fn derivative(
        &self,
        case: &Case,
        condition: usize,
        per: &Per,
        curves: &[Vec<f32>],
    ) -> Map<String, Value> {
        let channels = case.channels_of(condition).zip(curves);
        // a channel that is not differentiated has no values
        let channels = channels.filter(|(_, values)| !values.is_empty());
        let curves = channels.map(|((_, channel), values)| {
            let unit = format!("{} per {per}", channel.unit);
            let curve = json!({ "unit": unit, "values": values });
            (channel.name.clone(), curve)
        });
        let curves = Value::Object(curves.collect());
        Map::from_iter([("curves".to_owned(), curves)])
    }

    /// What `identify --output json` says of the bands of a condition: the first channel's unit and abscissa
    /// for all, and a channel's own where they differ.
    fn predicted(&self, case: &Case, band: &Band) -> Map<String, Value> {
        let mut said = Map::new();
        let mut channels = case
            .channels_of(band.condition)
            .zip(&band.channels)
            .peekable();
        let Some(first) = channels.peek().map(|((_, channel), _)| (*channel).clone()) else {
            return said;
        };
        let points = |channel: &Channel, values: &[f64]| {
            let points = channel.abscissa.points.iter().take(values.len());
            json!(points.copied().collect::<Vec<f64>>())
        };
        for ((_, channel), curve) in channels {
            let mut own = json!({"low": curve.low, "high": curve.high});
            if said.is_empty() {
                let name = channel.abscissa.name.clone();
                said.insert(name, points(channel, &curve.low));
                said.insert("unit".to_owned(), json!(channel.unit));
            }
            if channel.unit != first.unit {
                own["unit"] = json!(channel.unit);
            }
            if channel.abscissa != first.abscissa {
                let name = channel.abscissa.name.as_str();
                own["abscissa"] = json!({"name": name, "points": points(channel, &curve.low)});
            }
            said.insert(channel.name.clone(), own);
        }
        said
    }

    /// Key of a channel's agreement in objects, and what stands there beside it.
    fn scored(&self, channel: &Channel, _: &ChannelScore) -> (String, Map<String, Value>) {
        (channel.name.clone(), Map::new())
    }
}

/// A kind of which no more is known.
pub(super) struct AnyKind;

impl Kind for AnyKind {
    fn name(&self) -> &'static str {
        ""
    }
}
