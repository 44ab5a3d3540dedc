//! Figures as SVG, in one plain style for screen and print.
//!
//! From the lowest layer upwards: `canvas` writes SVG, `scale` computes an axis, `panel` is a pair of axes,
//! `strip` and `rows` are layouts shared by several figures; every other file draws one figure. Text stays
//! text. Depends on the report's data, not on HTML.
mod angle_map;
mod axis;
mod before_after;
pub mod canvas;
mod channels;
mod gap_comparison;
mod joint;
mod latent_force;
mod main_effect;
mod order_map;
mod overlay;
pub mod panel;
mod parallel;
pub mod points;
pub mod rows;
pub mod scale;
mod speed_up;
pub mod strip;
mod timeline;

pub(super) use angle_map::angle_map;
pub use axis::ChartAxis;
pub(super) use before_after::{BeforeAfter, before_after};
pub use channels::{channels, strips};
pub(super) use gap_comparison::{GapComparison, closing};
pub(super) use joint::joints;
pub(super) use latent_force::latent_forces;
pub(super) use main_effect::main_effects;
pub(super) use order_map::order_map;
pub(super) use overlay::fitted;
pub use overlay::{overlay, overlays};
pub(super) use parallel::parallel;
pub(super) use speed_up::speed_up;
pub(super) use timeline::timeline;
