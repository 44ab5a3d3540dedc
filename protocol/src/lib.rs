//! What may be said on the wire: plain data and its encoding.
//!
//! The arrows of the workspace end here: this crate knows nothing of sockets, files, clocks or
//! dynamics. At this edge every number carries its unit in its name.
pub mod announce;
pub mod case;
pub mod curve;
pub mod event;
pub mod external;
pub mod file;
pub mod id;
pub mod job;
pub mod key;
pub mod message;
pub mod name;
pub mod proof;
pub mod pumping_unit;
pub mod unit;
pub mod wire;
