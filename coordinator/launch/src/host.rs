//! Hosts in the notation of the command line and of host files.
use std::{fmt, fs, path::Path, str::FromStr};
use support::Problem;

/// Host to launch workers on: the ssh target with optional port and slots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Host {
    /// `HOST` or `USER@HOST`; aliases of the user's ssh configuration are allowed.
    pub target: String,
    /// Port of the host's ssh server, if different from the ssh configuration.
    pub port: Option<u16>,
    /// Number of simultaneous simulations on the host, if different from the other hosts.
    pub slots: Option<u16>,
}

/// Writes the host in the notation that [`FromStr`] parses.
impl fmt::Display for Host {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.port {
            Some(port) if self.target.contains(':') => write!(to, "[{}]:{port}", self.target),
            Some(port) => write!(to, "{}:{port}", self.target),
            None => write!(to, "{}", self.target),
        }
    }
}

/// Parses `user@host:port`, an argument of `--ssh` or the first word of a line of `--hosts`.
impl FromStr for Host {
    type Err = Problem;

    fn from_str(text: &str) -> Result<Self, Problem> {
        let wrong = |why: &str| {
            Problem::new(
                format!("\"{text}\" is not a valid host: {why}"),
                "write HOST, USER@HOST or USER@HOST:PORT; IPv6 addresses as [fe80::1]:22",
            )
        };
        let (target, port) = match text.rsplit_once(':') {
            // an IPv6 address without brackets has more colons
            Some((target, port)) if !target.contains(':') || target.ends_with(']') => {
                let port = port.parse().map_err(|_| wrong("its port is no number"))?;
                (target, Some(port))
            }
            _ => (text, None),
        };
        let target = target.replace(['[', ']'], "");
        let strange = |c: char| c.is_whitespace() || c.is_control();
        if target.is_empty() || target.starts_with('-') || target.contains(strange) {
            return Err(wrong("it is empty, begins with a dash or holds a space"));
        }
        Ok(Self {
            target,
            port,
            slots: None,
        })
    }
}

/// Reads a host file: one host per line, followed by `slots=N` where it differs; `#` starts a comment.
///
/// # Errors
/// [`Problem`], naming the file, the line and the error.
pub fn read_hosts(file: &Path) -> Result<Vec<Host>, Problem> {
    let help = "one host a line, as `user@node7:22 slots=8`";
    let text = fs::read_to_string(file)
        .map_err(|error| Problem::new(format!("{}: {error}", file.display()), help))?;
    let mut hosts = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let at = format!("{}:{}", file.display(), number + 1);
        let mut words = line
            .split('#')
            .next()
            .unwrap_or_default()
            .split_whitespace();
        let Some(first) = words.next() else { continue };
        let mut host: Host = first
            .parse()
            .map_err(|error: Problem| Problem::new(format!("{at}: {error}"), error.remedy))?;
        for word in words {
            let slots = word.strip_prefix("slots=").and_then(|n| n.parse().ok());
            host.slots = Some(slots.filter(|n| (1..=4096).contains(n)).ok_or_else(|| {
                Problem::new(format!("{at}: \"{word}\" is not understood"), help)
            })?);
        }
        hosts.push(host);
    }
    Ok(hosts)
}
