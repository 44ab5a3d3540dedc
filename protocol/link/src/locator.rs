//! Locators of the form `PROTOCOL/HOST:PORT`, and the check of which ones a coordinator may listen on.
use crate::LinkError;
use std::net::{IpAddr, TcpListener, UdpSocket};

/// Parsed locator, i.e. address of a coordinator on the bus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Locator {
    /// Transport protocol of the address: `tcp` or `quic`.
    pub protocol: Protocol,
    /// Host name or address; an IPv6 address keeps its brackets.
    pub host: String,
    /// Port; 0 in a listening address stands for any free port.
    pub port: u16,
}

/// Transport protocol of the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    /// TCP, unencrypted; meant for connections within one machine.
    Tcp,
    /// QUIC, encrypted and mutually authenticated.
    Quic,
}

impl Protocol {
    /// Returns the name of the protocol as used in locators.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tcp => "tcp",
            Self::Quic => "quic",
        }
    }
}

impl Locator {
    /// Parses a locator of the form `PROTOCOL/HOST:PORT`.
    ///
    /// # Errors
    /// [`LinkError::Locator`] or [`LinkError::Protocol`].
    pub fn parse(locator: &str) -> Result<Self, LinkError> {
        let wrong = || LinkError::Locator {
            locator: locator.to_owned(),
        };
        let (protocol, address) = locator.split_once('/').ok_or_else(wrong)?;
        let (host, port) = address.rsplit_once(':').ok_or_else(wrong)?;
        let protocol = match protocol {
            "tcp" => Protocol::Tcp,
            "quic" => Protocol::Quic,
            other => {
                return Err(LinkError::Protocol {
                    locator: locator.to_owned(),
                    protocol: other.to_owned(),
                });
            }
        };
        if host.is_empty() || (host.contains(':') && !host.starts_with('[')) {
            return Err(wrong());
        }
        let port = port.parse().map_err(|_| wrong())?;
        Ok(Self {
            protocol,
            host: host.to_owned(),
            port,
        })
    }

    /// Returns the host without the brackets of an IPv6 address.
    pub fn bare_host(&self) -> &str {
        self.host.trim_start_matches('[').trim_end_matches(']')
    }

    /// Returns whether the address is reachable from this machine only.
    pub fn is_loopback(&self) -> bool {
        let bare = self.bare_host();
        bare == "localhost" || bare.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback())
    }

    /// Checks whether a coordinator may listen on the address.
    ///
    /// # Errors
    /// [`LinkError::Exposed`] for unencrypted addresses that other machines can reach, unless `insecure`.
    pub fn permit(&self, insecure: bool) -> Result<(), LinkError> {
        match self.protocol {
            Protocol::Quic => Ok(()),
            Protocol::Tcp if insecure || self.is_loopback() => Ok(()),
            Protocol::Tcp => Err(LinkError::Exposed {
                locator: self.to_string(),
            }),
        }
    }

    /// Returns the address with port 0 replaced by a free port.
    ///
    /// # Errors
    /// [`LinkError::Transport`] if the machine has no free port.
    pub fn with_free_port(mut self) -> Result<Self, LinkError> {
        if self.port == 0 {
            let any = (self.bare_host(), 0);
            let found = match self.protocol {
                Protocol::Tcp => TcpListener::bind(any).and_then(|socket| socket.local_addr()),
                Protocol::Quic => UdpSocket::bind(any).and_then(|socket| socket.local_addr()),
            };
            self.port = found
                .map_err(|error| LinkError::Transport {
                    doing: format!("find a free port on {}", self.host),
                    reason: error.to_string(),
                })?
                .port();
        }
        Ok(self)
    }

    /// Returns the address by which a worker on the same machine connects to a coordinator that listens on
    /// this address.
    #[must_use]
    pub fn from_here(&self) -> Self {
        let host = match self.host.as_str() {
            "0.0.0.0" => "127.0.0.1",
            "[::]" => "[::1]",
            other => other,
        };
        Self {
            host: host.to_owned(),
            ..self.clone()
        }
    }
}

impl std::fmt::Display for Locator {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(to, "{}/{}:{}", self.protocol.name(), self.host, self.port)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_tcp_is_for_loopback_unless_said_otherwise() {
        for (locator, permitted) in [
            ("tcp/127.0.0.1:7447", true),
            ("tcp/127.8.0.1:0", true),
            ("tcp/localhost:1", true),
            ("tcp/[::1]:7447", true),
            ("tcp/0.0.0.0:7447", false),
            ("tcp/[::]:7447", false),
            ("tcp/head:7447", false),
            ("tcp/192.168.1.4:7447", false),
            ("quic/0.0.0.0:7447", true),
        ] {
            let parsed = Locator::parse(locator).unwrap();
            assert_eq!(parsed.to_string(), locator);
            assert_eq!(parsed.permit(false).is_ok(), permitted, "{locator}");
            assert_eq!(parsed.permit(true), Ok(()), "{locator}");
        }
    }

    #[test]
    fn what_cannot_be_used_is_refused_with_what_can() {
        for wrong in [
            "",
            "7447",
            "tcp/",
            "tcp/host",
            "tcp/:1",
            "tcp/::1:7447",
            "tcp/h:70000",
        ] {
            assert!(
                matches!(Locator::parse(wrong), Err(LinkError::Locator { .. })),
                "{wrong}"
            );
        }
        let refused = Locator::parse("tls/host:7447").unwrap_err();
        assert!(
            refused.to_string().contains("use tcp (loopback) or quic"),
            "{refused}"
        );
    }

    #[test]
    fn a_free_port_is_free() {
        let found = Locator::parse("tcp/127.0.0.1:0")
            .unwrap()
            .with_free_port()
            .unwrap();
        assert_ne!(found.port, 0);
        drop(TcpListener::bind(("127.0.0.1", found.port)).unwrap());
    }
}
