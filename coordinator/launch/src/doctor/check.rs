//! Result of checking one layer of the connection between worker and coordinator.
use serde::Serialize;

/// Layer of the setup (from case file to protocol version) that must be healthy for a worker to take part, in
/// the order of checking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    /// Case file, which must be readable.
    Case,
    /// Worker program, which must be present on this machine.
    Program,
    /// Certificates, which must be present, consistent with each other, and accepted by both ends of the
    /// connection.
    Certificate,
    /// System clock, which must be consistent with the validity dates of the certificates.
    Clock,
    /// Host name of the coordinator, which must resolve to an address.
    Name,
    /// Network route, over which the coordinator's machine must be reachable.
    Route,
    /// Network port of the coordinator, on which a process must listen.
    Port,
    /// Firewall, which must let packets to the port be answered.
    Firewall,
    /// Wire protocol version, which must be equal at both ends of the connection.
    Version,
}

impl Layer {
    /// Returns the layer's name as shown in the output.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Case => "case",
            Self::Program => "program",
            Self::Certificate => "certificate",
            Self::Clock => "clock",
            Self::Name => "name",
            Self::Route => "route",
            Self::Port => "port",
            Self::Firewall => "firewall",
            Self::Version => "version",
        }
    }
}

/// Result of checking one layer of the setup or the connection.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Check {
    /// Layer of the setup or the connection that was checked.
    pub layer: Layer,
    /// Whether the checked layer of the setup or connection works.
    pub healthy: bool,
    /// Observation made by the check, as text for the user.
    pub found: String,
    /// Remedy for the failed layer, as text for the user; empty for a healthy layer.
    pub remedy: String,
}

impl Check {
    /// Creates the check result of a healthy layer of the setup, with the observation made.
    pub fn good(layer: Layer, found: impl Into<String>) -> Self {
        Self {
            layer,
            healthy: true,
            found: found.into(),
            remedy: String::new(),
        }
    }

    /// Creates the check result of a failed layer of the setup, with the observation made and a remedy.
    pub fn bad(layer: Layer, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            layer,
            healthy: false,
            found: found.into(),
            remedy: remedy.into(),
        }
    }
}
