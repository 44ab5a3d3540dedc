//! Parsed certificate: names, validity period, and verification as the other end will perform it.
use super::error::KeyError;
use super::material::{Chain, KeyRole};
use rustls::{
    CertificateError, Error,
    client::{WebPkiServerVerifier, danger::ServerCertVerifier},
    crypto::{CryptoProvider, ring},
    pki_types::{CertificateDer, ServerName, UnixTime},
    server::WebPkiClientVerifier,
    sign::CertifiedKey,
};
use std::{
    net::IpAddr,
    path::{Path, PathBuf},
    sync::Arc,
};
use x509_parser::{
    certificate::X509Certificate, extensions::GeneralName, prelude::FromDer, time::ASN1Time,
};

pub(crate) fn provider() -> Arc<CryptoProvider> {
    Arc::new(ring::default_provider())
}

/// Fields of a certificate that the checks and messages need.
#[derive(Debug)]
pub(super) struct Certificate {
    path: PathBuf,
    /// Common name of the certificate; empty if it has none.
    pub(super) name: String,
    /// First host name or address in the certificate; empty if it has none.
    host: String,
    from: ASN1Time,
    until: ASN1Time,
}

impl Certificate {
    /// Parses the first certificate of a chain; `path` is its file, for error messages.
    pub(super) fn parse(path: &Path, chain: &[CertificateDer<'_>]) -> Result<Self, KeyError> {
        let not = || KeyError::NotPem {
            path: path.to_owned(),
            what: "certificate",
        };
        let der = chain.first().ok_or_else(not)?;
        let (_, read) = X509Certificate::from_der(der).map_err(|_| not())?;
        let names = read.subject_alternative_name().ok().flatten();
        let host = names.and_then(|names| names.value.general_names.iter().find_map(host_of));
        Ok(Self {
            path: path.to_owned(),
            name: certificate_name(der).unwrap_or_default(),
            host: host.unwrap_or_default(),
            from: read.validity().not_before,
            until: read.validity().not_after,
        })
    }

    /// Verifies certificate and key as the other end will, and returns a specific error, which the transport
    /// would not report.
    pub(super) fn check(&self, role: KeyRole, chain: &Chain, ca: &Path) -> Result<(), KeyError> {
        let path = || self.path.clone();
        let [end, rest @ ..] = chain.certificates.as_slice() else {
            return Ok(());
        };
        CertifiedKey::from_der(
            chain.certificates.clone(),
            chain.key.clone_key(),
            &provider(),
        )
        .and_then(|pair| pair.keys_match())
        .map_err(|_| KeyError::Mismatch { path: path() })?;
        let roots = Arc::new(chain.roots.clone());
        let unfit = |reason: String| KeyError::Unfit {
            path: path(),
            reason,
        };
        let verified = match role {
            KeyRole::Worker => {
                WebPkiClientVerifier::builder_with_provider(Arc::clone(&roots), provider())
                    .build()
                    .map_err(|error| unfit(error.to_string()))?
                    .verify_client_cert(end, rest, UnixTime::now())
                    .map(drop)
            }
            KeyRole::Coordinator => {
                let host = ServerName::try_from(self.host.as_str())
                    .map_err(|_| unfit("it names no host".to_owned()))?;
                WebPkiServerVerifier::builder_with_provider(Arc::clone(&roots), provider())
                    .build()
                    .map_err(|error| unfit(error.to_string()))?
                    .verify_server_cert(end, rest, &host, &[], UnixTime::now())
                    .map(drop)
            }
        };
        verified.map_err(|error| self.explain(&error, ca))
    }

    fn explain(&self, error: &Error, ca: &Path) -> KeyError {
        use CertificateError as C;
        let path = self.path.clone();
        let is = |kinds: &[C]| matches!(error, Error::InvalidCertificate(found) if kinds.contains(found));
        if is(&[C::UnknownIssuer, C::BadSignature]) {
            let ca = ca.to_owned();
            return KeyError::OtherAuthority { path, ca };
        }
        let now = ASN1Time::now();
        if now > self.until {
            let when = format!("is out of date since {}", self.until);
            return KeyError::Date { path, when };
        }
        if now < self.from {
            let when = format!("is valid only from {} on", self.from);
            return KeyError::Date { path, when };
        }
        let reason = error.to_string();
        KeyError::Unfit { path, reason }
    }
}

/// Returns the common name of a certificate, if it has one.
pub(crate) fn certificate_name(der: &CertificateDer<'_>) -> Option<String> {
    let (_, read) = X509Certificate::from_der(der).ok()?;
    let name = read.subject().iter_common_name().next()?;
    name.as_str().ok().map(str::to_owned)
}

fn host_of(name: &GeneralName<'_>) -> Option<String> {
    if let GeneralName::DNSName(name) = name {
        return Some((*name).to_owned());
    }
    let GeneralName::IPAddress(bytes) = name else {
        return None;
    };
    let address = match bytes.len() {
        4 => IpAddr::from(<[u8; 4]>::try_from(*bytes).ok()?),
        _ => IpAddr::from(<[u8; 16]>::try_from(*bytes).ok()?),
    };
    Some(address.to_string())
}
