//! Result of checking one layer of the connection between worker and coordinator.
use serde::Serialize;

/// Layer of the setup (from case file to protocol version) that must be healthy for a worker to take part, in
/// the order of checking.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    /// Case file: readable.
    Case,
    /// Worker program: present.
    Program,
    /// Certificates: present, consistent with each other, and accepted by both ends.
    Certificate,
    /// Clock: consistent with the validity dates of the certificates.
    Clock,
    /// Host name: resolves to an address.
    Name,
    /// Route: the machine is reachable.
    Route,
    /// Port: a process listens on it.
    Port,
    /// Firewall: packets sent to the port are answered.
    Firewall,
    /// Version: both ends use the same protocol version.
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
    /// Checked layer.
    pub layer: Layer,
    /// Whether the layer is healthy.
    pub healthy: bool,
    /// Observation made by the check, as text for the user.
    pub found: String,
    /// Remedy for the failed layer, as text for the user; empty for a healthy layer.
    pub remedy: String,
}

impl Check {
    /// Creates the result of a healthy layer.
    pub fn good(layer: Layer, found: impl Into<String>) -> Self {
        Self {
            layer,
            healthy: true,
            found: found.into(),
            remedy: String::new(),
        }
    }

    /// Creates the result of a failed layer, with a remedy.
    pub fn bad(layer: Layer, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            layer,
            healthy: false,
            found: found.into(),
            remedy: remedy.into(),
        }
    }
}
