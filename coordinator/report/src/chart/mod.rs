//! Figures as SVG: what is drawn, on one quiet style for screen and print.
//!
//! From below upwards: `canvas` writes SVG, `scale` is an axis as arithmetic, `panel` a pair of axes,
//! `strip` and `rows` are layouts that several figures share; every other file draws one figure. Text
//! is text. Knows the report's data; knows nothing of HTML.
mod angle_map;
mod axis;
pub mod canvas;
mod channels;
mod closing;
mod joint;
mod latent_force;
mod main_effect;
mod order_map;
mod overlay;
pub mod panel;
pub mod points;
pub mod rows;
pub mod scale;
mod speed_up;
pub mod strip;

pub(super) use angle_map::angle_map;
pub use axis::Axis;
pub use channels::{channels, strips};
pub(super) use closing::{Closing, closing};
pub(super) use joint::joints;
pub(super) use latent_force::latent_forces;
pub(super) use main_effect::main_effects;
pub(super) use order_map::order_map;
pub use overlay::{overlay, overlays};
pub(super) use speed_up::speed_up;
