//! Diagnosis from the coordinator's side: whether it can listen at an address.
use super::{
    check::{Check, Layer},
    classify::classify,
};
use link::{
    LinkError,
    keys::{KeyRole, Keys},
    locator::{Locator, Protocol},
};
use std::{io::ErrorKind, net::ToSocketAddrs as _, path::Path};

/// Checks the layers needed for a coordinator to listen at an address, in order, up to the first that fails.
pub fn listen(at: &Locator, tls: Option<&Path>) -> Vec<Check> {
    let mut checks = Vec::new();
    match (at.protocol, tls) {
        (Protocol::Unix | Protocol::Tcp, _) => {}
        (Protocol::Quic, None) => {
            let locator = at.to_string();
            return vec![classify(&LinkError::NoKeys { locator })];
        }
        (Protocol::Quic, Some(folder)) => match Keys::read(folder, KeyRole::Coordinator) {
            Ok(keys) => {
                let names = keys.workers().len();
                let found = format!("{}: {names} workers may join", folder.display());
                checks.push(Check::good(Layer::Certificate, found));
                checks.push(Check::good(Layer::Clock, "within the certificates' dates"));
            }
            Err(error) => return vec![classify(&error.into())],
        },
    }
    if let Err(error) = at.permit(true) {
        checks.push(classify(&error));
        return checks;
    }
    let host = (at.bare_host(), at.port);
    let addresses = match at.protocol {
        Protocol::Unix => Ok(at.host.clone()),
        Protocol::Tcp | Protocol::Quic => host
            .to_socket_addrs()
            .map(|found| format!("{:?}", found.collect::<Vec<_>>())),
    };
    match addresses.map_err(|error| error.to_string()) {
        Ok(found) => checks.push(Check::good(Layer::Name, found)),
        Err(reason) => {
            let locator = at.to_string();
            checks.push(classify(&LinkError::UnknownHost { locator, reason }));
            return checks;
        }
    }
    checks.push(match at.try_listen() {
        Ok(()) => Check::good(Layer::Port, "free to listen on"),
        Err(error) if error.kind() == ErrorKind::AddrNotAvailable => Check::bad(
            Layer::Route,
            format!("{at}: {error}"),
            "no interface of this machine has that address: listen on 0.0.0.0, or on one that `ip address` shows",
        ),
        Err(error) => Check::bad(
            Layer::Port,
            format!("{at}: {error}"),
            "a coordinator may run there already (`ss -tulpn` names who listens): choose another port, above 1023",
        ),
    });
    checks
}
