//! Figures as SVG: what is drawn, on one quiet style for screen and print.
//!
//! From below upwards: `canvas` writes SVG, `scale` is an axis as arithmetic, `panel` a pair of axes,
//! `strip` and `rows` are layouts that several figures share; every other file draws one figure. Text
//! is text. Knows the report's data; knows nothing of HTML.
mod angle_map;
mod canvas;
mod card;
mod closing;
mod contact;
mod convergence;
mod gene;
mod head_modes;
mod joint;
mod latent_force;
mod order_map;
mod overlay;
mod panel;
mod points;
mod revolution;
mod rows;
mod scale;
mod strip;
mod worker;

pub(super) use angle_map::angle_map;
pub(super) use card::card;
pub(super) use closing::{Closing, closing};
pub(super) use contact::contact;
pub(super) use convergence::convergence;
pub use gene::genes;
pub use head_modes::{HeadPicture, head_modes};
pub(super) use joint::joints;
pub(super) use latent_force::latent_forces;
pub(super) use order_map::order_map;
pub use overlay::{overlay, overlays};
pub(super) use revolution::{gauges, motion, player, tension, torque};
pub(super) use worker::workers;
