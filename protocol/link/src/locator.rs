//! Locators of the form `PROTOCOL/HOST:PORT` or `unix/PATH`, and the check of which ones a coordinator may listen on.
use crate::LinkError;
use rustix::process::geteuid;
use std::{
    fs::{self, DirBuilder},
    io,
    net::{TcpListener, UdpSocket},
    os::unix::{
        fs::{DirBuilderExt as _, MetadataExt as _},
        net::UnixStream,
    },
    path::{Path, absolute},
};

/// Longest path of a Unix socket that the system takes (bytes).
pub const LONGEST_SOCKET_PATH: usize = 107;

/// Parsed locator, i.e. address of a coordinator on the bus.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Locator {
    /// Transport protocol of the address.
    pub protocol: Protocol,
    /// Host name or address, where an IPv6 address keeps its brackets; for a Unix socket its absolute path.
    pub host: String,
    /// Port; 0 in a listening address stands for any free port. Always 0 for a Unix socket.
    pub port: u16,
}

/// Transport protocol of the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Protocol {
    /// Unix socket in a folder that other users of the machine cannot enter; for workers on the same machine.
    Unix,
    /// TCP, without encryption or authentication; every user of every machine that reaches the port can take part.
    Tcp,
    /// QUIC, encrypted and mutually authenticated.
    Quic,
}

impl Protocol {
    /// Returns the name of the protocol as used in locators.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unix => "unix",
            Self::Tcp => "tcp",
            Self::Quic => "quic",
        }
    }

    /// Returns the name by which Zenoh knows the protocol.
    pub(crate) const fn zenoh_name(self) -> &'static str {
        match self {
            Self::Unix => "unixsock-stream",
            Self::Tcp | Self::Quic => self.name(),
        }
    }
}

impl Locator {
    /// Parses a locator of the form `PROTOCOL/HOST:PORT` or `unix/PATH`; a relative path is made absolute.
    ///
    /// # Errors
    /// [`LinkError::Locator`], [`LinkError::Protocol`] or [`LinkError::Socket`].
    pub fn parse(locator: &str) -> Result<Self, LinkError> {
        let wrong = || LinkError::Locator {
            locator: locator.to_owned(),
        };
        let (protocol, address) = locator.split_once('/').ok_or_else(wrong)?;
        let protocol = match protocol {
            "unix" => {
                let path = absolute(address).map_err(|_| wrong())?;
                return Self::socket(&path);
            }
            "tcp" => Protocol::Tcp,
            "quic" => Protocol::Quic,
            other => {
                return Err(LinkError::Protocol {
                    locator: locator.to_owned(),
                    protocol: other.to_owned(),
                });
            }
        };
        let (host, port) = address.rsplit_once(':').ok_or_else(wrong)?;
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

    /// Returns the locator of a Unix socket at an absolute path.
    ///
    /// # Errors
    /// [`LinkError::Socket`] if the path is too long or contains characters with a meaning in locators.
    pub fn socket(path: &Path) -> Result<Self, LinkError> {
        let wrong = |reason: &str| LinkError::Socket {
            path: path.to_owned(),
            reason: reason.to_owned(),
        };
        let text = path.to_str().ok_or_else(|| wrong("it is not UTF-8"))?;
        if text.len() > LONGEST_SOCKET_PATH {
            let (length, most) = (text.len(), LONGEST_SOCKET_PATH);
            return Err(wrong(&format!(
                "it has {length} bytes, at most {most} are possible"
            )));
        }
        if text.contains(['?', '#', ';']) || text.ends_with('/') || path.file_name().is_none() {
            return Err(wrong("it must name a file and not contain `?`, `#` or `;`"));
        }
        Ok(Self {
            protocol: Protocol::Unix,
            host: text.to_owned(),
            port: 0,
        })
    }

    /// Returns the host without the brackets of an IPv6 address.
    pub fn bare_host(&self) -> &str {
        self.host.trim_start_matches('[').trim_end_matches(']')
    }

    /// Returns the address in the notation of Zenoh.
    pub(crate) fn endpoint(&self) -> String {
        match self.protocol {
            Protocol::Unix => format!("{}/{}", self.protocol.zenoh_name(), self.host),
            Protocol::Tcp | Protocol::Quic => self.to_string(),
        }
    }

    /// Checks whether a coordinator may listen on the address. The folder of a Unix socket is created, for this user
    /// alone, if it does not exist.
    ///
    /// # Errors
    /// [`LinkError::Exposed`] for TCP addresses, unless `insecure`; [`LinkError::Socket`] if other users can enter the
    /// folder of a Unix socket.
    pub fn permit(&self, insecure: bool) -> Result<(), LinkError> {
        match self.protocol {
            Protocol::Unix => self.close_folder(),
            Protocol::Tcp if !insecure => Err(LinkError::Exposed {
                locator: self.to_string(),
            }),
            Protocol::Tcp | Protocol::Quic => Ok(()),
        }
    }

    /// Checks that no other user can enter the folder of a Unix socket, and creates it if it does not exist.
    fn close_folder(&self) -> Result<(), LinkError> {
        let path = Path::new(&self.host);
        let folder = path.parent().unwrap_or(path);
        let wrong = |reason: String| LinkError::Socket {
            path: path.to_owned(),
            reason,
        };
        let mut make = DirBuilder::new();
        match make.mode(0o700).create(folder) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                return Err(wrong(error.to_string()));
            }
            Ok(()) | Err(_) => {}
        }
        let found = fs::metadata(folder).map_err(|error| wrong(error.to_string()))?;
        if found.uid() == geteuid().as_raw() && found.mode() & 0o777 == 0o700 {
            return Ok(());
        }
        let folder = folder.display();
        Err(wrong(format!(
            "other users can enter {folder}: choose a folder of your own with mode 0700, or one that does not exist"
        )))
    }

    /// Checks that nobody listens on the address, by listening on it for a moment or dialling it.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn try_listen(&self) -> io::Result<()> {
        let at = (self.bare_host(), self.port);
        match self.protocol {
            Protocol::Tcp => TcpListener::bind(at).map(drop),
            Protocol::Quic => UdpSocket::bind(at).map(drop),
            // a socket that nobody listens on is left by a process that was killed, and is replaced
            Protocol::Unix => match UnixStream::connect(&self.host) {
                Ok(_) => Err(io::ErrorKind::AddrInUse.into()),
                Err(_) => Ok(()),
            },
        }
    }

    /// Returns the address with port 0 replaced by a free port.
    ///
    /// # Errors
    /// [`LinkError::Transport`] if the machine has no free port.
    pub fn with_free_port(mut self) -> Result<Self, LinkError> {
        if self.port == 0 && self.protocol != Protocol::Unix {
            let any = (self.bare_host(), 0);
            let found = if self.protocol == Protocol::Tcp {
                TcpListener::bind(any).and_then(|socket| socket.local_addr())
            } else {
                UdpSocket::bind(any).and_then(|socket| socket.local_addr())
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
}

impl std::fmt::Display for Locator {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.protocol {
            Protocol::Unix => write!(to, "unix/{}", self.host),
            Protocol::Tcp | Protocol::Quic => {
                write!(to, "{}/{}:{}", self.protocol.name(), self.host, self.port)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_tcp_is_refused_unless_said_otherwise() {
        for (locator, permitted) in [
            ("tcp/127.0.0.1:7447", false),
            ("tcp/[::1]:7447", false),
            ("tcp/0.0.0.0:7447", false),
            ("tcp/head:7447", false),
            ("quic/0.0.0.0:7447", true),
        ] {
            let parsed = Locator::parse(locator).unwrap();
            assert_eq!(parsed.to_string(), locator);
            assert_eq!(parsed.permit(false).is_ok(), permitted, "{locator}");
            assert_eq!(parsed.permit(true), Ok(()), "{locator}");
        }
    }

    /// Checks that a Unix socket lies in a folder that no other user can enter, which is made if it does not exist.
    #[test]
    fn a_socket_needs_a_folder_that_is_closed_to_others() {
        let folder = tempfile::tempdir().unwrap();
        let new = folder.path().join("new/bus");
        let parsed = Locator::parse(&format!("unix/{}", new.display())).unwrap();
        assert_eq!(Locator::parse(&parsed.to_string()), Ok(parsed.clone()));
        assert_eq!(parsed.permit(false), Ok(()));
        let new = new.parent().unwrap();
        assert_eq!(fs::metadata(new).unwrap().mode() & 0o777, 0o700);
        let open = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        fs::set_permissions(new, open).unwrap();
        let refused = parsed.permit(true).unwrap_err().to_string();
        assert!(refused.contains("other users can enter"), "{refused}");
        let relative = Locator::parse("unix/sockets/bus").unwrap();
        assert!(Path::new(&relative.host).is_absolute(), "{relative}");
        for wrong in [
            "unix/",
            "unix/a?b",
            "unix/a/",
            &format!("unix//{}", "a".repeat(107)),
        ] {
            let refused = Locator::parse(wrong).unwrap_err();
            assert!(
                matches!(
                    refused,
                    LinkError::Socket { .. } | LinkError::Locator { .. }
                ),
                "{wrong}"
            );
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
        assert!(refused.to_string().contains("use unix/PATH"), "{refused}");
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
