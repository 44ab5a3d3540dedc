//! Probe of a coordinator's address before the bus is opened, to learn why opening would fail.
//!
//! The bus itself reports every refusal as a time-out after ten seconds. The probe presents the same
//! certificates to the same address and distinguishes an unknown host, a closed port, and a certificate that
//! one of the two ends rejects.
use crate::{
    ConnectFailure, LinkError, OUT_OF_DATE,
    gate::terms::{ALPN_PROBE, CLOSE_OK, UNLISTED},
    keys::{Keys, provider},
    locator::{Locator, Protocol},
};
use quinn::{ClientConfig, ConnectionError, Endpoint, VarInt, crypto::rustls::QuicClientConfig};
use std::{
    io::ErrorKind,
    net::{Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs, UdpSocket},
    sync::Arc,
    time::Duration,
};
use tokio::{
    net::{TcpStream, UnixStream},
    time::timeout,
};

/// Maximum wait for an answer to the probe.
const PROBE_TIMEOUT: Duration = Duration::from_secs(3);
/// Maximum wait for an ICMP message by which a machine reports a closed UDP port.
const ICMP_TIMEOUT: Duration = Duration::from_millis(200);
/// Offset of TLS alert codes within QUIC's range of error codes.
const ALERTS: u64 = 0x100;
/// TLS alert `no_application_protocol`, sent by a listener that does not know the probe's protocol.
const NO_SUCH_PROTOCOL: u64 = 120;

/// Checks by a connection whether a coordinator listens at a TCP address or on a Unix socket.
pub(crate) async fn probe_plain(to: &Locator) -> Result<(), LinkError> {
    let silent = |how: ConnectFailure| LinkError::NoAnswer {
        locator: to.to_string(),
        how,
    };
    let (tried, protocol) = if to.protocol == Protocol::Unix {
        let connecting = UnixStream::connect(&to.host);
        let tried = timeout(PROBE_TIMEOUT, connecting).await;
        (tried.map(|ended| ended.map(drop)), "Unix socket")
    } else {
        let address = resolve(to).await?;
        let tried = timeout(PROBE_TIMEOUT, TcpStream::connect(address)).await;
        (tried.map(|ended| ended.map(drop)), "TCP")
    };
    match tried {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => {
            let is_refused = error.kind() == ErrorKind::ConnectionRefused;
            let is_missing = error.kind() == ErrorKind::NotFound;
            Err(silent(match to.protocol {
                Protocol::Unix if is_refused || is_missing => ConnectFailure::NoSocket,
                Protocol::Tcp if is_refused => ConnectFailure::Closed { protocol },
                Protocol::Unix | Protocol::Tcp | Protocol::Quic => ConnectFailure::Unreachable {
                    reason: error.to_string(),
                },
            }))
        }
        Err(_) => Err(silent(ConnectFailure::Dropped { protocol })),
    }
}

/// Performs a QUIC handshake with a coordinator and returns the cause if it fails.
pub(crate) async fn probe_quic(to: &Locator, keys: &Keys) -> Result<(), LinkError> {
    let address = resolve(to).await?;
    let transport = |reason: String| LinkError::Transport {
        doing: format!("connect to {to}"),
        reason,
    };
    let chain = keys.chain()?;
    let mut config = rustls::ClientConfig::builder_with_provider(provider())
        .with_protocol_versions(&[&rustls::version::TLS13])
        .and_then(|builder| {
            builder
                .with_root_certificates(chain.roots)
                .with_client_auth_cert(chain.certificates, chain.key)
        })
        .map_err(|error| transport(error.to_string()))?;
    config.alpn_protocols = vec![ALPN_PROBE.to_vec()];
    let config =
        QuicClientConfig::try_from(config).map_err(|error| transport(error.to_string()))?;
    let any: SocketAddr = match address {
        SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
        SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
    };
    let mut endpoint = Endpoint::client(any).map_err(|error| transport(error.to_string()))?;
    endpoint.set_default_client_config(ClientConfig::new(Arc::new(config)));
    let connecting = endpoint
        .connect(address, to.bare_host())
        .map_err(|error| transport(error.to_string()))?;
    // with TLS 1.3 a client is connected before its certificate is looked at: the answer comes after
    let shaken = async { Ok(connecting.await?.closed().await) };
    let silent = |how: ConnectFailure| LinkError::NoAnswer {
        locator: to.to_string(),
        how,
    };
    let ended = tokio::select! {
        ended = timeout(PROBE_TIMEOUT, shaken) => ended.unwrap_or(Err(ConnectionError::TimedOut)),
        how = detect_closed_port(address) => return Err(silent(how)),
    };
    let ended = ended.unwrap_or_else(|error| error);
    if ended == ConnectionError::TimedOut {
        return Err(silent(ConnectFailure::Dropped { protocol: "UDP" }));
    }
    explain(&ended, to, keys)
}

async fn resolve(to: &Locator) -> Result<SocketAddr, LinkError> {
    let host = to.bare_host().to_owned();
    let port = to.port;
    let unknown = |reason: String| LinkError::UnknownHost {
        locator: to.to_string(),
        reason,
    };
    let found = tokio::task::spawn_blocking(move || (host.as_str(), port).to_socket_addrs())
        .await
        .map_err(|error| unknown(error.to_string()))?;
    found
        .map_err(|error| unknown(error.to_string()))?
        .next()
        .ok_or_else(|| unknown("it has no address".to_owned()))
}

/// Completes only if the other machine or the network reports that the UDP port cannot be reached; pends
/// forever otherwise.
async fn detect_closed_port(address: SocketAddr) -> ConnectFailure {
    let asked = tokio::task::spawn_blocking(move || {
        let any: SocketAddr = match address {
            SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
            SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
        };
        let socket = UdpSocket::bind(any)?;
        socket.connect(address)?;
        socket.set_read_timeout(Some(ICMP_TIMEOUT))?;
        // no datagram of QUIC is so short: whoever listens drops it
        socket.send(&[0])?;
        socket.recv(&mut [0])
    });
    match asked
        .await
        .map(|received| received.map_err(|error| (error.kind(), error)))
    {
        Ok(Err((ErrorKind::ConnectionRefused, _))) => ConnectFailure::Closed { protocol: "UDP" },
        Ok(Err((ErrorKind::NetworkUnreachable | ErrorKind::HostUnreachable, error))) => {
            ConnectFailure::Unreachable {
                reason: error.to_string(),
            }
        }
        Ok(_) | Err(_) => std::future::pending().await,
    }
}

/// Translates the end of the probe connection into a result whose message names the remedy.
fn explain(error: &ConnectionError, to: &Locator, keys: &Keys) -> Result<(), LinkError> {
    let locator = to.to_string();
    let refused = |reason: &str| LinkError::Refused {
        locator: to.to_string(),
        owner: keys.owner().to_owned(),
        reason: reason.to_owned(),
    };
    if let ConnectionError::TransportError(found) = error {
        let reason = distrust(&found.reason, to, keys);
        return Err(LinkError::Distrusted { locator, reason });
    }
    if let ConnectionError::ConnectionClosed(frame) = error {
        let code = u64::from(frame.error_code);
        if code.checked_sub(ALERTS) == Some(NO_SUCH_PROTOCOL) {
            // a router of the bus without a gate: it will say for itself what it thinks of us
            return Ok(());
        }
        if let Some(reason) = alert(code) {
            return Err(refused(reason));
        }
    }
    if let ConnectionError::ApplicationClosed(answer) = error {
        if answer.error_code == VarInt::from_u32(CLOSE_OK) {
            return Ok(());
        }
        if answer.error_code == VarInt::from_u32(UNLISTED) {
            return Err(refused(
                "its list of workers does not hold that name: `horsehead keys add` puts it \
                 there, where a running coordinator looks every second",
            ));
        }
    }
    Err(LinkError::Transport {
        doing: format!("connect to {locator}"),
        reason: error.to_string(),
    })
}

/// Returns the reason why this end rejects the coordinator's certificate.
fn distrust(words: &str, to: &Locator, keys: &Keys) -> String {
    let has = |part: &str| words.contains(part);
    if has("UnknownIssuer") || has("BadSignature") {
        let ca = keys.ca();
        return format!(
            "its certificate was signed by another authority than {}",
            ca.display()
        );
    }
    if has("not valid for name") || has("NotValidForName") {
        return format!(
            "its certificate is not for \"{}\": dial a name or address that was given to \
             `horsehead keys new keys --host NAME` ({words})",
            to.host
        );
    }
    if has("xpired") {
        return format!("{OUT_OF_DATE} (or this machine's clock is wrong)");
    }
    words.to_owned()
}

/// Translates a TLS alert from the coordinator into the reason why it rejects this end's certificate.
const fn alert(code: u64) -> Option<&'static str> {
    match code.checked_sub(ALERTS) {
        Some(48) => Some("it was signed by another authority than the coordinator's"),
        Some(45) => Some("it is out of date there: compare the clocks of both machines"),
        Some(44) => Some("it was revoked"),
        Some(116) => Some("the coordinator received no certificate"),
        Some(42 | 43 | 46 | 49) => Some("it is no certificate for a worker"),
        Some(_) | None => None,
    }
}
