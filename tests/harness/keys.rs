//! Key material for the test suites, and a raw Zenoh client that follows only the rules of the transport.
use link::keys::authority::{Authority, Validity};
use serde_json::json;
use std::path::Path;

/// Creates a certificate authority, a coordinator certificate for loopback and `hosts`, and two worker
/// certificates: `worker-01`, `worker-02`.
///
/// # Panics
/// If the folder cannot be written.
pub fn make(folder: &Path, hosts: &[&str]) -> Authority {
    let authority = Authority::create(folder).expect("a new folder");
    let mut names = vec!["localhost".to_owned(), "127.0.0.1".to_owned()];
    names.extend(hosts.iter().map(|host| (*host).to_owned()));
    let valid = Validity::days(1);
    authority
        .issue_coordinator(&names, valid)
        .expect("the coordinator's certificate");
    for name in ["worker-01", "worker-02"] {
        authority
            .issue_worker(name, valid)
            .expect("a worker's certificate");
    }
    authority
}

/// Opens a Zenoh session with the certificate of a worker's folder or with none. The session may publish
/// under any name.
///
/// # Errors
/// The message of the transport if it cannot connect within `timeout_ms`.
pub async fn raw_session(
    locator: &str,
    folder: &Path,
    with_certificate: bool,
    timeout_ms: u64,
) -> Result<zenoh::Session, String> {
    let mut tls = json!({
        "root_ca_certificate": folder.join(link::keys::CA), "verify_name_on_connect": true,
    });
    if with_certificate {
        let [certificate, key] = link::keys::WORKER;
        tls["enable_mtls"] = json!(true);
        tls["connect_certificate"] = json!(folder.join(certificate));
        tls["connect_private_key"] = json!(folder.join(key));
    }
    let config = json!({
        "mode": "client",
        "connect": { "endpoints": [locator], "timeout_ms": timeout_ms, "exit_on_failure": true },
        "listen": { "endpoints": [] },
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "transport": { "link": { "tx": { "lease": 3000, "keep_alive": 6 }, "tls": tls } },
    });
    let config = zenoh::Config::from_json5(&config.to_string());
    let config = config.map_err(|error| error.to_string())?;
    zenoh::open(config).await.map_err(|error| error.to_string())
}
