//! Wire protocol: plain message types and their encoding.
//!
//! No crate of the workspace is below this one, and it knows nothing of sockets, files, clocks or dynamics.
//! Every number at this interface carries its unit in its name.
pub mod announce;
pub mod case;
pub mod curve;
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
