//! Assignment of connection errors to the layer of the setup that failed, with a remedy for each.
use super::check::{Check, Layer};
use link::{ConnectFailure, LinkError};

/// Returns the check result of the layer that failed, derived from a connection error, with a remedy.
pub(super) fn classify(error: &LinkError) -> Check {
    let (layer, remedy) = match error {
        error if error.is_validity_error() => (
            Layer::Clock,
            "compare `date` on both machines and set the clock that is wrong; if both are right, make new \
             certificates with `horsehead keys`",
        ),
        LinkError::UnknownHost { .. } => (
            Layer::Name,
            "check the spelling, and `getent hosts NAME` on this machine; or dial the machine's address",
        ),
        LinkError::NoAnswer { how, .. } => match how {
            ConnectFailure::Closed { .. } => (
                Layer::Port,
                "start the coordinator with --listen, and connect to the port that it prints",
            ),
            ConnectFailure::NoSocket => (
                Layer::Port,
                "start the coordinator with --listen unix/PATH, and connect to the same path",
            ),
            ConnectFailure::Unreachable { .. } => (
                Layer::Route,
                "`ip route get ADDRESS` says how this machine would go there; check the cable, the VPN and that \
                 the other machine is up",
            ),
            ConnectFailure::Dropped { .. } | _ => (
                Layer::Firewall,
                "check that the coordinator runs there, and let its port through the firewalls between: UDP for \
                 quic/, TCP for tcp/",
            ),
        },
        LinkError::Socket { .. } => (
            Layer::Route,
            "name a path of at most 107 bytes in a folder of your own that only you can enter (chmod 700)",
        ),
        LinkError::NoKeys { .. } | LinkError::Keys(_) => (
            Layer::Certificate,
            "`horsehead keys new DIR --host NAME` makes certificates; a worker has the folder DIR/worker-01 of \
             its own, the coordinator all of DIR",
        ),
        LinkError::Distrusted { .. } | LinkError::Refused { .. } => (
            Layer::Certificate,
            "both ends need certificates of one `horsehead keys new`: copy the worker's folder again, and name \
             the dialled host in --host",
        ),
        LinkError::Locator { .. }
        | LinkError::Protocol { .. }
        | LinkError::Exposed { .. }
        | LinkError::Transport { .. }
        | LinkError::Piece { .. }
        | _ => (
            Layer::Version,
            "the address is answered by a program other than a coordinator of this version: check the port, and use the same \
             build of horsehead and horsehead-worker on every machine",
        ),
    };
    Check::bad(layer, error.to_string(), remedy)
}
