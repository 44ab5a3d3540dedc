//! Connection from the gate to the router over loopback, with certificates that exist only in the memory of
//! this process.
use super::terms::{ALPN_ZENOH, HANDSHAKE};
use crate::{
    LinkError,
    keys::{
        authority::{Validity, for_memory},
        provider,
    },
};
use base64::{Engine, engine::general_purpose::STANDARD};
use quinn::{
    ClientConfig, Connection, Endpoint, TransportConfig, crypto::rustls::QuicClientConfig,
};
use rustls::{
    RootCertStore,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject},
};
use serde_json::{Value, json};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
    net::{Ipv4Addr, SocketAddr},
    sync::Arc,
};
use tokio::time::timeout;

/// Validity of the in-memory certificates between gate and router (days), longer than any run.
const DAYS: u32 = 365;

/// In-memory certificate authority for the loopback connections from the gate to the router: client
/// configurations for all worker names, and the router's TLS section.
pub(crate) struct RouterConnector {
    router: SocketAddr,
    endpoint: Endpoint,
    configs: BTreeMap<String, ClientConfig>,
    section: Value,
}

impl fmt::Debug for RouterConnector {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        // the section holds a key
        to.debug_struct("Inner")
            .field("router", &self.router)
            .finish_non_exhaustive()
    }
}

impl RouterConnector {
    /// Creates the in-memory certificates: one for the router at a loopback port, and one in each worker's
    /// name.
    pub(crate) fn make(router: SocketAddr, owners: &BTreeSet<String>) -> Result<Self, LinkError> {
        let authority = for_memory()?;
        let valid = Validity::days(DAYS);
        let hosts = [Ipv4Addr::LOCALHOST.to_string()];
        let (certificate, key) = authority.pair_for_coordinator(&hosts, valid)?;
        let section = json!({
            "root_ca_certificate_base64": STANDARD.encode(authority.pem()),
            "listen_certificate_base64": STANDARD.encode(certificate),
            "listen_private_key_base64": STANDARD.encode(key),
            "enable_mtls": true,
        });
        let mut roots = RootCertStore::empty();
        let ca = CertificateDer::from_pem_slice(authority.pem().as_bytes());
        roots
            .add(ca.map_err(|error| unusable(&error))?)
            .map_err(|error| unusable(&error))?;
        let mut configs = BTreeMap::new();
        for owner in owners {
            let (certificate, key) = authority.pair_for_worker(owner, valid)?;
            let config = client_config(roots.clone(), &certificate, &key)?;
            configs.insert(owner.clone(), config);
        }
        let any = (Ipv4Addr::LOCALHOST, 0).into();
        let endpoint = Endpoint::client(any).map_err(|error| unusable(&error))?;
        Ok(Self {
            router,
            endpoint,
            configs,
            section,
        })
    }

    /// Returns whether a worker's name has an in-memory certificate, and therefore access rules at the
    /// router.
    pub(super) fn knows(&self, owner: &str) -> bool {
        self.configs.contains_key(owner)
    }

    /// Returns the TLS section of the router's configuration, which contains a private key.
    pub(crate) const fn listening(&self) -> &Value {
        &self.section
    }

    /// Connects to the router under the name of a worker.
    pub(super) async fn connect(
        &self,
        owner: &str,
        streams: TransportConfig,
    ) -> Result<Connection, LinkError> {
        let config = self.configs.get(owner);
        let mut config = config
            .cloned()
            .ok_or_else(|| unusable(&"the name is not on the list"))?;
        config.transport_config(Arc::new(streams));
        let host = Ipv4Addr::LOCALHOST.to_string();
        let connecting = self
            .endpoint
            .connect_with(config, self.router, &host)
            .map_err(|error| unusable(&error))?;
        timeout(HANDSHAKE, connecting)
            .await
            .map_err(|error| unusable(&error))?
            .map_err(|error| unusable(&error))
    }
}

fn client_config(
    roots: RootCertStore,
    certificate: &str,
    key: &str,
) -> Result<ClientConfig, LinkError> {
    let certificate =
        CertificateDer::from_pem_slice(certificate.as_bytes()).map_err(|error| unusable(&error))?;
    let key = PrivateKeyDer::from_pem_slice(key.as_bytes()).map_err(|error| unusable(&error))?;
    let mut config = rustls::ClientConfig::builder_with_provider(provider())
        .with_protocol_versions(&[&rustls::version::TLS13])
        .and_then(|builder| {
            builder
                .with_root_certificates(roots)
                .with_client_auth_cert(vec![certificate], key)
        })
        .map_err(|error| unusable(&error))?;
    config.alpn_protocols = vec![ALPN_ZENOH.to_vec()];
    let config = QuicClientConfig::try_from(config).map_err(|error| unusable(&error))?;
    Ok(ClientConfig::new(Arc::new(config)))
}

fn unusable(reason: &dyn fmt::Display) -> LinkError {
    LinkError::Transport {
        doing: "connect the gate to the bus".to_owned(),
        reason: reason.to_string(),
    }
}
