//! What a gate and those who come to it have agreed on.
use std::time::Duration;

/// What a worker shows that only asks whether it may come in.
pub(crate) const KNOCK: &[u8] = b"horsehead-knock";
/// Protocol of the router: a stream for each priority.
pub(crate) const BUS: &[u8] = b"zenoh-ms";
/// Answer to a knock, and last word of a connection that ends in good order.
pub(crate) const WELCOME: u32 = 0;
/// Answer to whoever may not come in: its name is not on the list.
pub(crate) const UNLISTED: u32 = 1;
/// Answer to whoever may not come in: its certificate has all the connections that one may have.
pub(crate) const CROWDED: u32 = 2;
/// How long shaking hands may take.
pub(crate) const HANDSHAKE: Duration = Duration::from_secs(3);
/// Connections, and workers, of one certificate: the router's sessions are for all.
pub(crate) const CONNECTIONS: usize = 1024;
