//! Refusal of requests that other web sites make through the user's browser, and of requests that would change
//! something.
//!
//! A page of another site can send requests to any local address, and can give a name of its own to that
//! address (DNS rebinding). Both are told by the headers `Host`, `Origin` and `Sec-Fetch-Site`.
use axum::{
    extract::{Request, State},
    http::{HeaderMap, HeaderValue, Method, StatusCode, header},
    middleware::Next,
    response::{IntoResponse, Response},
};
use std::{
    net::{IpAddr, SocketAddr},
    sync::Arc,
};

/// Values of the header `Host` under which a server at an address may be reached.
#[derive(Clone, Debug)]
pub(super) struct Hosts(Arc<[String]>);

/// Returns the values of the header `Host` under which a server at an address may be reached: its address, and
/// on loopback the name `localhost` too.
pub fn allowed_hosts(address: SocketAddr) -> Vec<String> {
    let port = address.port();
    let mut hosts = vec![address.to_string()];
    if address.ip().is_loopback() {
        hosts.push(format!("localhost:{port}"));
        hosts.push(format!("127.0.0.1:{port}"));
        hosts.push(format!("[::1]:{port}"));
    }
    hosts
}

impl Hosts {
    pub(super) fn of(address: SocketAddr) -> Self {
        // a server on all addresses cannot know its own: any number is allowed, and no name
        let listed = if address.ip().is_unspecified() {
            Vec::new()
        } else {
            allowed_hosts(address)
        };
        Self(listed.into())
    }

    fn allow(&self, host: &str) -> bool {
        if self.0.is_empty() {
            let number = |text: &str| text.parse::<IpAddr>().is_ok();
            return host.parse::<SocketAddr>().is_ok() || number(host);
        }
        self.0.iter().any(|own| own == host)
    }
}

/// Returns why a request is refused; `None` if it is answered.
fn refusal(
    hosts: &Hosts,
    method: &Method,
    headers: &HeaderMap,
) -> Option<(StatusCode, &'static str)> {
    let text =
        |name: header::HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or("?"));
    if method != Method::GET && method != Method::HEAD {
        return Some((
            StatusCode::METHOD_NOT_ALLOWED,
            "the dashboard only shows runs: it answers GET alone",
        ));
    }
    let host = text(header::HOST).unwrap_or_default();
    if !hosts.allow(host) {
        return Some((
            StatusCode::FORBIDDEN,
            "this name is none of the dashboard's addresses: open the address that `horsehead dashboard` printed",
        ));
    }
    let own = format!("http://{host}");
    let other_origin = text(header::ORIGIN).is_some_and(|origin| origin != own);
    let cross_site = headers
        .get("sec-fetch-site")
        .is_some_and(|site| site == "cross-site" || site == "same-site");
    // a link on another page may be followed, but only to a whole page
    let navigates = headers
        .get("sec-fetch-mode")
        .is_some_and(|mode| mode == "navigate");
    if other_origin || (cross_site && !navigates) {
        return Some((
            StatusCode::FORBIDDEN,
            "pages of other sites are not answered",
        ));
    }
    None
}

/// Answers a request only if it comes from the dashboard's own pages or from no page, and adds headers that
/// confine the pages to this server.
pub(super) async fn guard(State(hosts): State<Hosts>, request: Request, next: Next) -> Response {
    let refused = refusal(&hosts, request.method(), request.headers());
    let mut response = match refused {
        Some(refused) => refused.into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (
            header::CONTENT_SECURITY_POLICY,
            "default-src 'none'; script-src 'self'; style-src 'unsafe-inline'; connect-src 'self'; \
             img-src data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
        ),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    headers.insert(
        "cross-origin-resource-policy",
        HeaderValue::from_static("same-origin"),
    );
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(address: &str, method: &Method, headers: &[(&'static str, &str)]) -> bool {
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.insert(*name, value.parse().unwrap());
        }
        refusal(&Hosts::of(address.parse().unwrap()), method, &map).is_some()
    }

    #[test]
    fn own_pages_are_answered_and_other_sites_are_not() {
        let own = ("host", "127.0.0.1:7450");
        let at = "127.0.0.1:7450";
        assert!(!refused(at, &Method::GET, &[own]));
        assert!(!refused(at, &Method::GET, &[("host", "localhost:7450")]));
        let origin = ("origin", "http://127.0.0.1:7450");
        assert!(!refused(at, &Method::GET, &[own, origin]));
        let link = [
            own,
            ("sec-fetch-site", "cross-site"),
            ("sec-fetch-mode", "navigate"),
        ];
        assert!(!refused(at, &Method::GET, &link));
        for wrong in [
            vec![],
            vec![("host", "example.org:7450")],
            vec![("host", "127.0.0.1:80")],
            vec![own, ("origin", "http://example.org")],
            vec![own, ("origin", "null")],
            vec![
                own,
                ("sec-fetch-site", "cross-site"),
                ("sec-fetch-mode", "cors"),
            ],
        ] {
            assert!(refused(at, &Method::GET, &wrong), "{wrong:?}");
        }
        for method in [Method::POST, Method::PUT, Method::DELETE, Method::OPTIONS] {
            assert!(refused(at, &method, &[own]));
        }
    }

    #[test]
    fn a_server_on_all_addresses_has_no_name() {
        let at = "0.0.0.0:7450";
        assert!(!refused(at, &Method::GET, &[("host", "10.1.2.3:7450")]));
        assert!(refused(
            at,
            &Method::GET,
            &[("host", "attacker.example:7450")]
        ));
    }
}
