//! What may explain a disagreement: every effect of the library is tested, the likeliest are refitted,
//! forces without a cause challenge them, and the best is believed or not. Where in the machine it lies
//! it does not know.
pub(crate) mod challenge;
pub(crate) mod decide;
pub mod low_orders;
pub mod refit;
pub(crate) mod round;
pub mod signature;
pub mod suspect;
pub(crate) mod together;
pub(crate) mod valley_search;
