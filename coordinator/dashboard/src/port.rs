//! Listening socket of the dashboard; a port in use is reported with its owner and the next free port.
use std::{
    fs,
    net::{IpAddr, SocketAddr, TcpListener},
};
use support::Problem;

/// Port of the dashboard if none is chosen.
pub const DEFAULT_PORT: u16 = 7450;
/// Number of ports after the chosen one among which a free one is looked for.
const TRIED: u16 = 50;

/// Opens the listening socket at an address.
///
/// # Errors
/// If the address cannot be used; the remedy names the next free port where the port is in use.
pub fn listen(address: IpAddr, port: u16) -> anyhow::Result<TcpListener> {
    let wanted = SocketAddr::new(address, port);
    let error = match TcpListener::bind(wanted) {
        Ok(listener) => return Ok(listener),
        Err(error) => error,
    };
    if error.kind() != std::io::ErrorKind::AddrInUse {
        return Err(Problem {
            message: format!("cannot listen at {wanted}: {error}"),
            remedy:
                "choose an address of this machine with --address, and a port from 1024 with --port"
                    .to_owned(),
        }
        .into());
    }
    let mut others = (1..=TRIED).filter_map(|more| port.checked_add(more));
    let free = others.find(|port| TcpListener::bind(SocketAddr::new(address, *port)).is_ok());
    Err(Problem {
        message: match owner(port) {
            Some(owner) => format!("port {port} is in use by {owner}"),
            None => format!("port {port} is in use"),
        },
        remedy: match free {
            Some(free) => format!("choose another port, for example --port {free}"),
            None => "choose another port with --port".to_owned(),
        },
    }
    .into())
}

/// Opens the listening socket at an address, at the chosen port or the next free one.
///
/// # Errors
/// As [`listen`], if the chosen port and all that are tried after it are in use.
pub fn listen_near(address: IpAddr, port: u16) -> anyhow::Result<TcpListener> {
    let mut ports = (0..=TRIED).filter_map(|more| port.checked_add(more));
    let free = ports.find_map(|port| TcpListener::bind(SocketAddr::new(address, port)).ok());
    free.map_or_else(|| listen(address, port), Ok)
}

/// Returns the name and the number of the process that listens at a TCP port of this machine; `None` if it
/// belongs to another user or cannot be found.
fn owner(port: u16) -> Option<String> {
    let tables = ["/proc/net/tcp", "/proc/net/tcp6"];
    let mut tables = tables
        .iter()
        .filter_map(|table| fs::read_to_string(table).ok());
    let inode = tables.find_map(|table| listening_inode(&table, port))?;
    let socket = format!("socket:[{inode}]");
    for process in fs::read_dir("/proc").ok()?.flatten() {
        let number = process.file_name().to_string_lossy().into_owned();
        if number.parse::<u32>().is_err() {
            continue;
        }
        let Ok(open) = fs::read_dir(process.path().join("fd")) else {
            continue;
        };
        let mut targets = open
            .flatten()
            .filter_map(|file| fs::read_link(file.path()).ok());
        if targets.any(|target| target.as_os_str() == socket.as_str()) {
            let name = fs::read_to_string(process.path().join("comm")).unwrap_or_default();
            return Some(format!("{} (process {number})", name.trim()));
        }
    }
    None
}

/// Returns the inode of the socket that listens at a port, from the kernel's table of TCP sockets.
fn listening_inode(table: &str, port: u16) -> Option<String> {
    const LISTEN: &str = "0A";
    table.lines().skip(1).find_map(|line| {
        let fields: Vec<&str> = line.split_whitespace().collect();
        let (local, state, inode) = (fields.get(1)?, fields.get(3)?, fields.get(9)?);
        let (_, number) = local.rsplit_once(':')?;
        let same = u16::from_str_radix(number, 16).is_ok_and(|own| own == port);
        (same && *state == LISTEN).then(|| (*inode).to_owned())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::Ipv4Addr;

    #[test]
    fn a_port_in_use_is_reported_with_its_owner_and_another_port() {
        let local = IpAddr::V4(Ipv4Addr::LOCALHOST);
        let taken = TcpListener::bind((local, 0)).unwrap();
        let port = taken.local_addr().unwrap().port();
        let error = listen(local, port).unwrap_err();
        let problem = error.downcast_ref::<Problem>().unwrap();
        let process = format!("(process {})", std::process::id());
        assert!(problem.message.contains(&process), "{}", problem.message);
        let (_, other) = problem.remedy.split_once("--port ").unwrap();
        assert!(listen(local, other.parse().unwrap()).is_ok(), "{other}");
    }
}
