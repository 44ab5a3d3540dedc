//! Report content specific to the pumping unit: the machine in motion, its ropes, dynamometer card, energy,
//! and the modes of its back head.
//!
//! Uses the report's axes and tables, and does not depend on the position within a report.
mod animation;
mod card;
mod check;
mod contact;
mod crank_balance;
pub mod csv;
mod drawing;
mod head;
mod head_life;
mod head_modes;
mod import;
mod name;
mod revolution;
mod single;
pub mod vtu;

pub use crank_balance::{BalanceMap, CrankBalancePicture, CrankTorque, crank_balance};
pub use head::{head_gauges, head_modes as head_mode_table, head_pair, head_statics};
pub use head_life::{HeadLifePicture, SECTOR_DEG, head_life};
pub use head_modes::{HeadPicture, write_head_modes};
pub use import::{imported_card, turns};
pub use name::{integrator_name, mode_family};
pub use single::{balance, simulation};
