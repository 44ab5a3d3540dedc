//! Trait for the parts of the JSON output that depend on the kind of model; its default methods suit every
//! kind.
use super::digest::Digest;
use case::kind::OtherModel;
use discrepancy::identify::Band;
use protocol::{
    case::{Case, Channel},
    job::{ChannelScore, Curves, Per},
    wire::WireError,
};
use serde_json::{Map, Value, json};

/// JSON output of curves, bands and scores of a kind of model.
pub(crate) trait ModelOutput: Sync {
    /// Computes the hash of all bits of a simulation result, without wall time, as 64 hexadecimal digits.
    ///
    /// # Errors
    /// If the result cannot be decoded as one of this kind of model.
    fn digest(&self, drawn: &Curves) -> Result<String, WireError> {
        let mut digest = Digest::of(drawn.verdict);
        for curve in &drawn.channels {
            digest.curve(curve);
        }
        digest.bytes(&drawn.details);
        Ok(digest.end(drawn.verdict, &drawn.counters))
    }

    /// Returns the curves of a simulation as shown by `simulate --output json`.
    ///
    /// # Errors
    /// If the result cannot be decoded as one of this kind of model.
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

    /// Returns the derivatives of all channel curves with respect to one unknown or effect parameter, as
    /// shown by `simulate --derivatives --output json`; `per` is the unit of change of this parameter.
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

    /// Returns the prediction bands of a condition as shown by `identify --output json`. Unit and abscissa of
    /// the first channel are given once for all channels, and again for each channel where they differ.
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

    /// Returns the JSON key under which a channel's score is shown, and further fields of that score.
    fn scored(&self, channel: &Channel, _: &ChannelScore) -> (String, Map<String, Value>) {
        (channel.name.clone(), Map::new())
    }
}

impl ModelOutput for OtherModel {}
