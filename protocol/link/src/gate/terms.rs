//! Constants on which the gate (authenticating proxy) and its peers agree: protocol names, close codes and
//! limits.
use std::time::Duration;

/// ALPN protocol of a probe connection, by which a worker asks only whether it would be admitted.
pub(crate) const ALPN_PROBE: &[u8] = b"horsehead-knock";
/// ALPN protocol of the router, with one stream per priority.
pub(crate) const ALPN_ZENOH: &[u8] = b"zenoh-ms";
/// Close code for an admitted probe and for connections that end regularly.
pub(crate) const CLOSE_OK: u32 = 0;
/// Close code for a peer whose name is not on the list of workers.
pub(crate) const UNLISTED: u32 = 1;
/// Close code for a peer whose certificate has reached its maximum number of connections.
pub(crate) const CLOSE_TOO_MANY_CONNECTIONS: u32 = 2;
/// Maximum duration of a TLS handshake at the gate.
pub(crate) const HANDSHAKE: Duration = Duration::from_secs(3);
/// Maximum number of connections, and of workers, per certificate, because all certificates share the
/// router's sessions.
pub(crate) const CONNECTIONS: usize = 1024;
