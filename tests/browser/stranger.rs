//! Tests of what another user of the machine can read of a dashboard, and of readers that do not wait.
use super::{Site, folder::oscillator_site, socket_address};
use std::{
    fs,
    io::{Read as _, Write as _},
    net::TcpStream,
    os::unix::fs::PermissionsExt as _,
    time::Duration,
};
use tests::stranger::as_stranger;

/// Checks that another user of the machine gets no page, and cannot read the token. Regression: he read every run.
#[test]
fn a_stranger_sees_no_run() {
    let site = Site::new(None);
    fs::create_dir(site.path("runs")).unwrap();
    let (_server, url) = site.dashboard("runs");
    let (address, token) = (socket_address(&url), url.split_once("token=").unwrap().1);
    let kept = site.path("state/horsehead/dashboard-token");
    assert_eq!(fs::read_to_string(&kept).unwrap(), token);
    let (host, port) = address.split_once(':').unwrap();
    let script = format!(
        "cat {} && exit 1; exec 3<>/dev/tcp/{host}/{port}; \
         printf 'GET / HTTP/1.1\\r\\nHost: {address}\\r\\nConnection: close\\r\\n\\r\\n' >&3; cat <&3",
        kept.display()
    );
    // all that keeps him out is the mode of what he is not to read
    for open in [site.path(""), site.path("state")] {
        fs::set_permissions(open, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let Some(mut stranger) = as_stranger("bash") else {
        return;
    };
    let answer = stranger.args(["-c", &script]).output().unwrap();
    let answer = String::from_utf8_lossy(&answer.stdout).into_owned();
    assert!(answer.starts_with("HTTP/1.1 403"), "{answer}");
    assert!(answer.contains("the token is missing"), "{answer}");
    assert!(!answer.contains(token), "{answer}");
}

/// Checks that requests for individuals are limited in number, that those for the same individual are answered by one
/// simulation, and that those whose reader has left are dropped.
#[test]
fn individuals_are_simulated_once_and_only_for_readers_that_wait() {
    let site = oscillator_site();
    site.run(&["calibrate", "case", "--run", "runs/good"]);
    let (_server, url) = site.dashboard("runs/good");
    let (address, query) = (socket_address(&url), url.split_once('?').unwrap().1);
    let ask = |number: u64| {
        let mut stream = TcpStream::connect(address).unwrap();
        let request = format!(
            "GET /individual/{number}?{query} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n"
        );
        stream.write_all(request.as_bytes()).unwrap();
        stream
    };
    let answer = |mut stream: TcpStream| {
        let limit = Some(Duration::from_mins(1));
        stream.set_read_timeout(limit).unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        text
    };
    // the page is read before individuals are known
    tests::process::wait_until("the run is read", Duration::from_mins(1), || {
        answer(ask(150)).starts_with("HTTP/1.1 200")
    });
    for number in 1..100 {
        drop(ask(number));
    }
    // the place of those who have left is free as soon as it is noticed
    let same = || (0..20).map(|_| ask(120)).collect::<Vec<TcpStream>>();
    tests::process::wait_until("all are answered", Duration::from_mins(1), || {
        let mut answers = same().into_iter().map(answer);
        answers.all(|text| text.contains("Individual 120") && !text.contains("too many"))
    });
}
