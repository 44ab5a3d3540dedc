//! Refusal of requests by others than the user: of other users of the machine, of other web sites through the user's
//! browser, and of requests that would change something.
//!
//! Every user of a machine reaches the ports on its loopback. The user's own requests carry a secret token, in the
//! printed address (`?token=`) and then in a cookie. A page of another site can send requests to any local address,
//! and can give a name of its own to that address (DNS rebinding). Both are told by the headers `Host`, `Origin` and
//! `Sec-Fetch-*`, and by the cookie, which browsers do not send with such requests.
use axum::{
    extract::{Request, State},
    http::{HeaderMap, HeaderValue, Method, StatusCode, Uri, header},
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
pub(crate) fn allowed_hosts(address: SocketAddr) -> Vec<String> {
    let port = address.port();
    let mut hosts = vec![address.to_string()];
    if address.ip().is_loopback() {
        hosts.push(format!("localhost:{port}"));
        hosts.push(format!("127.0.0.1:{port}"));
        hosts.push(format!("[::1]:{port}"));
    }
    hosts
}

/// What a server needs to know to tell its user's requests from others.
#[derive(Clone, Debug)]
pub(super) struct Access {
    hosts: Hosts,
    token: Arc<str>,
    /// Name of the cookie: browsers send the cookies of a host to all its ports.
    cookie: Arc<str>,
}

impl Access {
    pub(super) fn new(address: SocketAddr, token: &str) -> Self {
        Self {
            hosts: Hosts::of(address),
            token: token.into(),
            cookie: format!("horsehead-{}", address.port()).into(),
        }
    }

    /// Returns whether a request carries the token in its query.
    fn is_token_in_query(&self, uri: &Uri) -> bool {
        let pairs = uri.query().unwrap_or_default().split('&');
        let mut tokens = pairs.filter_map(|pair| pair.strip_prefix("token="));
        tokens.any(|token| self.is_token(token))
    }

    /// Returns whether a request carries the token in its cookie.
    fn is_token_in_cookie(&self, headers: &HeaderMap) -> bool {
        let cookies = headers.get_all(header::COOKIE).iter();
        let mut pairs = cookies
            .filter_map(|value| value.to_str().ok())
            .flat_map(|text| text.split(';'))
            .filter_map(|pair| pair.trim().split_once('='));
        pairs.any(|(name, value)| name == &*self.cookie && self.is_token(value))
    }

    /// Compares a text with the token in a time that does not depend on where they differ.
    fn is_token(&self, text: &str) -> bool {
        let pairs = text.bytes().zip(self.token.bytes());
        let differences = pairs.fold(0, |all, (a, b)| all | (a ^ b));
        text.len() == self.token.len() && differences == 0
    }

    /// Returns the header that gives a browser the token as a cookie.
    fn cookie(&self) -> Option<HeaderValue> {
        let (name, token) = (&self.cookie, &self.token);
        let text = format!("{name}={token}; Path=/; HttpOnly; SameSite=Strict");
        HeaderValue::from_str(&text).ok()
    }
}

impl Hosts {
    fn of(address: SocketAddr) -> Self {
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
    access: &Access,
    method: &Method,
    uri: &Uri,
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
    if !access.hosts.allow(host) {
        return Some((
            StatusCode::FORBIDDEN,
            "this name is none of the dashboard's addresses: open the address that `horsehead dashboard` printed",
        ));
    }
    let own = format!("http://{host}");
    let other_origin = text(header::ORIGIN).is_some_and(|origin| origin != own);
    let is = |name: &str, wanted: &[&str]| {
        let value = headers.get(name).map(|value| value.to_str().unwrap_or("?"));
        value.map(|value| wanted.contains(&value))
    };
    let is_foreign = is("sec-fetch-site", &["same-origin", "none"]) == Some(false);
    // a link on another page may be followed, but only to a whole page in a window of its own
    let is_page = uri.path().ends_with('/');
    let opens_page = is_page
        && is("sec-fetch-mode", &["navigate"]) == Some(true)
        && is("sec-fetch-dest", &["document"]) == Some(true);
    if other_origin || (is_foreign && !opens_page) {
        return Some((
            StatusCode::FORBIDDEN,
            "pages of other sites are not answered",
        ));
    }
    if !access.is_token_in_cookie(headers) && !access.is_token_in_query(uri) {
        return Some((
            StatusCode::FORBIDDEN,
            "the token is missing: open the address that `horsehead dashboard` printed, with all that follows the \
             question mark",
        ));
    }
    None
}

/// Answers a request only if it carries the token and comes from the dashboard's own pages or from no page, and adds
/// headers that confine the pages to this server.
pub(super) async fn guard(State(access): State<Access>, request: Request, next: Next) -> Response {
    let (uri, headers) = (request.uri(), request.headers());
    let refused = refusal(&access, request.method(), uri, headers);
    let gets_cookie = refused.is_none() && access.is_token_in_query(uri);
    let mut response = match refused {
        Some(refused) => refused.into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    if let Some(cookie) = gets_cookie.then(|| access.cookie()).flatten() {
        headers.insert(header::SET_COOKIE, cookie);
    }
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

    const TOKEN: &str = "0123456789abcdef";
    const COOKIE: (&str, &str) = ("cookie", "other=1; horsehead-7450=0123456789abcdef");

    fn refused(address: &str, uri: &str, headers: &[(&'static str, &str)]) -> bool {
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(*name, value.parse().unwrap());
        }
        let access = Access::new(address.parse().unwrap(), TOKEN);
        refusal(&access, &Method::GET, &uri.parse().unwrap(), &map).is_some()
    }

    #[test]
    fn own_pages_are_answered_and_other_sites_are_not() {
        let own = ("host", "127.0.0.1:7450");
        let at = "127.0.0.1:7450";
        assert!(!refused(at, "/", &[own, COOKIE]));
        assert!(!refused(at, "/", &[("host", "localhost:7450"), COOKIE]));
        let origin = ("origin", "http://127.0.0.1:7450");
        assert!(!refused(at, "/events", &[own, COOKIE, origin]));
        let site = |site| ("sec-fetch-site", site);
        assert!(!refused(
            at,
            "/individual/3",
            &[own, COOKIE, site("same-origin")]
        ));
        let opened = [
            ("sec-fetch-mode", "navigate"),
            ("sec-fetch-dest", "document"),
        ];
        let link = |from| [own, COOKIE, site(from), opened[0], opened[1]];
        for from in ["none", "same-site", "cross-site"] {
            assert!(!refused(at, "/runs/a/", &link(from)), "{from}");
        }
        assert!(refused(at, "/individual/3", &link("cross-site")));
        for wrong in [
            vec![],
            vec![("host", "example.org:7450")],
            vec![("host", "127.0.0.1:80")],
            vec![own, ("origin", "http://example.org")],
            vec![own, ("origin", "null")],
            vec![own, site("cross-site"), ("sec-fetch-mode", "cors")],
            vec![own, site("same-site"), ("sec-fetch-dest", "script")],
            vec![
                own,
                site("cross-site"),
                opened[0],
                ("sec-fetch-dest", "iframe"),
            ],
        ] {
            let wrong = [&wrong[..], &[COOKIE]].concat();
            assert!(refused(at, "/", &wrong), "{wrong:?}");
        }
    }

    #[test]
    fn the_token_is_asked_for_in_the_address_or_a_cookie() {
        let (at, own) = ("127.0.0.1:7450", ("host", "127.0.0.1:7450"));
        assert!(!refused(at, &format!("/?token={TOKEN}"), &[own]));
        assert!(!refused(
            at,
            &format!("/events?after=3&token={TOKEN}"),
            &[own]
        ));
        for (uri, cookie) in [
            ("/", ""),
            ("/?token=", ""),
            ("/?token=0123456789abcdee", ""),
            ("/?token=0123456789abcdef0", ""),
            ("/page.js", ""),
            ("/events", "horsehead-7451=0123456789abcdef"),
            ("/individual/3", "horsehead-7450=0123456789abcde"),
        ] {
            assert!(
                refused(at, uri, &[own, ("cookie", cookie)]),
                "{uri} {cookie}"
            );
        }
    }

    #[test]
    fn no_request_changes_anything() {
        let access = Access::new("127.0.0.1:7450".parse().unwrap(), TOKEN);
        let mut headers = HeaderMap::new();
        for (name, value) in [("host", "127.0.0.1:7450"), COOKIE] {
            headers.insert(name, value.parse().unwrap());
        }
        for method in [Method::POST, Method::PUT, Method::DELETE, Method::OPTIONS] {
            assert!(refusal(&access, &method, &Uri::from_static("/"), &headers).is_some());
        }
    }

    #[test]
    fn a_server_on_all_addresses_has_no_name() {
        let at = "0.0.0.0:7450";
        assert!(!refused(at, "/", &[("host", "10.1.2.3:7450"), COOKIE]));
        assert!(refused(
            at,
            "/",
            &[("host", "attacker.example:7450"), COOKIE]
        ));
    }
}
