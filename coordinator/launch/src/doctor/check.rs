//! One layer that was looked at.
use serde::Serialize;

/// What must hold for a worker to take part, in the order in which it is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    /// The case can be read.
    Case,
    /// The program of workers is there.
    Program,
    /// Certificates are there, fit each other, and either end takes the other's.
    Certificate,
    /// The clock agrees with the certificates.
    Clock,
    /// The host's name has an address.
    Name,
    /// There is a way to the machine.
    Route,
    /// Somebody listens on the port.
    Port,
    /// What is sent there comes back.
    Firewall,
    /// Both ends speak the same version.
    Version,
}

impl Layer {
    /// As it is written.
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

/// What was found of a layer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Check {
    /// Which.
    pub layer: Layer,
    /// Whether it holds.
    pub healthy: bool,
    /// What was seen.
    pub found: String,
    /// What to do; empty where it holds.
    pub remedy: String,
}

impl Check {
    /// It holds.
    pub fn good(layer: Layer, found: impl Into<String>) -> Self {
        Self {
            layer,
            healthy: true,
            found: found.into(),
            remedy: String::new(),
        }
    }

    /// It does not.
    pub fn bad(layer: Layer, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            layer,
            healthy: false,
            found: found.into(),
            remedy: remedy.into(),
        }
    }
}
