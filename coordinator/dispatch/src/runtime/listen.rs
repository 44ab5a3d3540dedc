//! Listening addresses of a run, their key material, and checks before the run starts.
use super::{error::DispatchError, options::DispatchOptions};
use link::{
    LinkError,
    keys::{KeyRole, Keys},
    locator::{Locator, Protocol},
};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::net::{TcpListener, UdpSocket};

/// Number of open files to request; more is useless, since the link limits its connections.
const FILES: u64 = 16 << 10;

/// Raises this process's limit of open files: the usual limit of about a thousand could be used up by a few
/// silent peers.
pub(super) fn allow_connections() {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    let wanted = maximum.map_or(FILES, |maximum| maximum.min(FILES));
    if current.is_none_or(|current| current >= wanted) {
        return;
    }
    let limit = Rlimit {
        current: Some(wanted),
        maximum,
    };
    if let Err(error) = setrlimit(Resource::Nofile, limit) {
        tracing::debug!(%error, "the limit of open files cannot be raised");
    }
}

/// Checks that listening on an address is permitted (encrypted, or insecure listening allowed) and possible,
/// before anything is created or started.
pub(super) fn admissible(locator: &Locator, insecure: bool) -> Result<(), DispatchError> {
    locator.permit(insecure)?;
    let at = (locator.bare_host(), locator.port);
    let tried = match locator.protocol {
        Protocol::Tcp => TcpListener::bind(at).map(drop),
        Protocol::Quic => UdpSocket::bind(at).map(drop),
    };
    tried.map_err(|source| DispatchError::Listen {
        locator: locator.to_string(),
        source,
    })
}

/// Reads and checks the key material if an address needs it.
pub(super) fn keys(
    options: &DispatchOptions,
    listen: &[Locator],
) -> Result<Option<Keys>, DispatchError> {
    let Some(secured) = listen.iter().find(|at| at.protocol == Protocol::Quic) else {
        return Ok(None);
    };
    let folder = options.tls.as_ref().ok_or_else(|| LinkError::NoKeys {
        locator: secured.to_string(),
    })?;
    let keys = Keys::read(folder, KeyRole::Coordinator).map_err(LinkError::from)?;
    Ok(Some(keys))
}

/// Returns the addresses to listen on, and the index of the address that local workers use.
pub(super) fn addresses(
    options: &DispatchOptions,
) -> Result<(Vec<Locator>, Option<usize>), DispatchError> {
    let loopback = || Locator::parse("tcp/127.0.0.1:0");
    let listen = options.listen.as_deref().map(Locator::parse).transpose()?;
    match (listen, options.local_workers) {
        (None, 0) => Err(DispatchError::NoWorkers),
        (None, _) => Ok((vec![loopback()?], Some(0))),
        (Some(asked), 0) => Ok((vec![asked], None)),
        (Some(asked), _) if asked.protocol == Protocol::Tcp => Ok((vec![asked], Some(0))),
        // local workers need no certificates
        (Some(asked), _) => Ok((vec![asked, loopback()?], Some(1))),
    }
}
