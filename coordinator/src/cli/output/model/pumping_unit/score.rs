//! Output of channel scores for pumping units: gauges under their numbers, units in the field names.
use protocol::{case::Channel, job::ChannelScore, pumping_unit::Sensor};
use serde_json::{Map, Value, json};

/// Returns the JSON key of a channel's score, and additional fields if the channel is a gauge.
pub(super) fn scored(channel: &Channel, score: &ChannelScore) -> (String, Map<String, Value>) {
    let Some(gauge) = Sensor::gauge(&channel.name) else {
        return (channel.name.clone(), Map::new());
    };
    let own = [
        ("gauge", json!(gauge)),
        ("mse_mpa2", json!(score.mse)),
        ("mse_fixed_offset_mpa2", json!(score.mse_fixed_offset)),
        ("offset_mpa", json!(score.offset)),
    ];
    let own = own.map(|(key, value)| (key.to_owned(), value));
    (gauge.to_string(), Map::from_iter(own))
}
