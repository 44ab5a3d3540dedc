//! Tests with peers that connect and then send nothing, as many as the machine allows.
use super::{LIMIT, MEASURING, processor_us, rate};
use dispatch::runtime::Dispatch;
use std::{
    collections::BTreeMap,
    io::{ErrorKind, Read},
    net::{TcpStream, UdpSocket},
    process::Command,
    sync::Arc,
    time::{Duration, Instant},
};
use tests::{
    expect_results,
    keys::{make, raw_session},
    options,
    process::{Process, free_quic_locator, free_tcp_locator, wait_until, worker_program},
};

/// Number of QUIC handshakes that the test begins and does not finish.
const BEGUN: usize = 300;
/// Longest time in which a worker must join despite unfinished handshakes; a coordinator that handled
/// handshakes one at a time would need longer.
const KEPT_OUT: Duration = Duration::from_secs(20);

/// Returns the number of silent connections to open (`HORSEHEAD_TEST_SILENT`, default 2000); fewer are opened
/// where the machine allows no more.
fn idle() -> usize {
    let asked = std::env::var("HORSEHEAD_TEST_SILENT").ok();
    asked.map_or(2000, |count| count.parse().unwrap())
}

/// Returns the first datagrams of `count` different QUIC handshakes, as Zenoh clients send them.
pub(super) async fn first_datagrams(count: usize) -> Vec<Vec<u8>> {
    let mut tls = rustls::ClientConfig::builder_with_provider(Arc::new(
        rustls::crypto::ring::default_provider(),
    ))
    .with_protocol_versions(&[&rustls::version::TLS13])
    .unwrap()
    .with_root_certificates(rustls::RootCertStore::empty())
    .with_no_client_auth();
    tls.alpn_protocols = vec![b"zenoh-ms".to_vec()];
    let tls = quinn::crypto::rustls::QuicClientConfig::try_from(tls).unwrap();
    let mut client = quinn::Endpoint::client((std::net::Ipv4Addr::LOCALHOST, 0).into()).unwrap();
    client.set_default_client_config(quinn::ClientConfig::new(Arc::new(tls)));
    let ear = tokio::net::UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let mut datagrams = Vec::new();
    for _ in 0..count {
        let connecting = client
            .connect(ear.local_addr().unwrap(), "localhost")
            .unwrap();
        let mut buffer = [0; 2000];
        let length = ear.recv(&mut buffer).await.unwrap();
        datagrams.push(buffer[..length].to_vec());
        drop(connecting);
    }
    datagrams
}

/// Checks that unfinished handshakes, which need no certificate, do not prevent a worker from joining.
#[tokio::test(flavor = "multi_thread")]
async fn handshakes_that_are_never_finished_keep_nobody_out() {
    let _others = MEASURING.read().await;
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    make(&keys, &[]);
    let locator = free_quic_locator();
    let mut options = options(&folder.path().join("run"), Some(&locator), 0);
    options.access.tls = Some(keys.clone());
    let dispatch = Dispatch::open(options).await.unwrap();
    let program = worker_program();
    let datagrams = first_datagrams(BEGUN).await;
    let silent: Vec<UdpSocket> = datagrams
        .iter()
        .map(|datagram| {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            socket.connect(locator.trim_start_matches("quic/")).unwrap();
            socket.send(datagram).unwrap();
            socket
        })
        .collect();
    // the coordinator has answered the first: it waits for what never comes
    silent[0].set_read_timeout(Some(LIMIT)).unwrap();
    silent[0].recv(&mut [0; 2000]).unwrap();
    let dialled = Instant::now();
    let mut command = Command::new(program);
    command.args(["--connect", &locator, "--slots", "1", "--tls"]);
    command.arg(keys.join("worker-01"));
    let worker = Process::start(command);
    wait_until("an honest worker joins", KEPT_OUT, || {
        dispatch.snapshot().workers.len() == 1
    });
    eprintln!(
        "an honest worker joined {:?} after its start, beside {BEGUN} begun handshakes",
        dialled.elapsed()
    );
    dispatch.close().await.unwrap();
    drop((silent, worker));
}

/// Waits until the peer has closed all connections.
fn wait_until_closed(connections: Vec<TcpStream>) {
    for mut connection in connections {
        connection.set_read_timeout(Some(LIMIT)).unwrap();
        // an end, or a reset where there was no room for it
        match connection.read(&mut [0]) {
            Ok(0) => {}
            Err(error) if error.kind() == ErrorKind::ConnectionReset => {}
            other => panic!("a silent connection is still open: {other:?}"),
        }
    }
}

/// Checks that silent local connections, which the coordinator closes after four seconds, cost less processor
/// time each than one result does, lose no result, and do not prevent a worker from joining.
#[tokio::test(flavor = "multi_thread")]
async fn thousands_of_silent_connections_cost_little_and_no_result() {
    let _alone = MEASURING.write().await;
    let folder = tempfile::tempdir().unwrap();
    let locator = free_tcp_locator();
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let honest = Process::worker(&locator, &["--slots", "2"]);
    wait_until("the honest worker joins", LIMIT, || {
        dispatch.snapshot().workers.len() == 1
    });
    let ourselves = rustix::process::getpid();
    let mut results = BTreeMap::new();
    let time = Duration::from_secs(2);
    let at_first = processor_us(ourselves);
    let before = rate(&mut dispatch, &mut results, time).await;
    let result_us = (processor_us(ourselves) - at_first) as f64 / results.len() as f64;
    let at_first = processor_us(ourselves);
    tokio::time::sleep(time).await;
    let calm_us_per_s = (processor_us(ourselves) - at_first) as f64 / time.as_secs_f64();

    let address: std::net::SocketAddr = locator.trim_start_matches("tcp/").parse().unwrap();
    let (wanted, begun, at_first) = (idle(), Instant::now(), processor_us(ourselves));
    let mut idle = Vec::new();
    while idle.len() < wanted && begun.elapsed() < Duration::from_secs(20) {
        match TcpStream::connect_timeout(&address, Duration::from_secs(1)) {
            Ok(connection) => idle.push(connection),
            // as many as the machine allows
            Err(_) => break,
        }
    }
    let (opened, count) = (begun.elapsed(), idle.len());
    // somebody else gets in beside them
    let late = Instant::now();
    let second = Process::worker(&locator, &["--slots", "2"]);
    wait_until("another honest worker joins", LIMIT, || {
        dispatch.snapshot().workers.len() == 2
    });
    let joined = late.elapsed();
    tokio::task::spawn_blocking(|| wait_until_closed(idle))
        .await
        .unwrap();
    let took = begun.elapsed();
    let spent_us = (processor_us(ourselves) - at_first) as f64;
    // dialling them is in it, too: both ends are this process
    let silent_us = (spent_us - calm_us_per_s * took.as_secs_f64()) / count as f64;
    let after = rate(&mut dispatch, &mut results, time).await;
    eprintln!(
        "{before:.0} jobs a second at {result_us:.0} us of the coordinator's processor; {count} silent \
         connections, opened in {opened:.1?} and closed after {took:.1?}: {silent_us:.0} us each, both \
         ends; another worker joined {joined:.1?} after its start; {after:.0} jobs a second afterwards"
    );
    let jobs = results.len() as u64;
    expect_results(&results, jobs);
    let last = dispatch.close().await.unwrap().last;
    assert_eq!((last.lost, last.failed, last.done as u64), (0, 0, jobs));
    assert!(count > 500, "only {count} connections");
    assert!(
        silent_us < result_us,
        "{silent_us} us each, a result {result_us} us"
    );
    drop((honest, second));
}

/// Checks that more silent connections than the limit of open files of the process do not prevent a worker
/// from joining.
#[test]
fn silent_connections_beyond_the_files_of_a_shell_keep_nobody_out() {
    let _others = MEASURING.blocking_read();
    let folder = tempfile::tempdir().unwrap();
    let locator = free_tcp_locator();
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -Sn 200 && exec \"$0\" \"$@\""]);
    command.arg(env!("CARGO_BIN_EXE_test-coordinator"));
    command.arg(folder.path()).args([&locator, "8", "1", "0"]);
    let mut coordinator = Process::start(command);
    let address = locator.trim_start_matches("tcp/");
    // the coordinator tries the address before its router listens there: a connection may be refused between
    let mut silent = Vec::new();
    wait_until("400 connections are open", LIMIT, || {
        silent.extend(TcpStream::connect(address));
        silent.len() == 400
    });
    let worker = Process::worker(&locator, &["--slots", "1"]);
    let mut said = String::new();
    coordinator.output().read_to_string(&mut said).unwrap();
    assert!(said.contains("done repeated 0 replayed 0 lost 0"), "{said}");
    assert_eq!(coordinator.wait(LIMIT), Some(0));
    drop((silent, worker));
}

/// Measures the processor time that real Zenoh sessions, which neither announce themselves nor send anything,
/// cost an otherwise idle coordinator.
///
/// ```text
/// cargo test --workspace --test hostile -- --ignored --nocapture idle_sessions
/// ```
#[tokio::test(flavor = "multi_thread")]
#[ignore = "a measurement"]
async fn idle_sessions_cost_their_keep_alives() {
    const SESSIONS: usize = 400;
    const TIME: Duration = Duration::from_secs(10);
    let _alone = MEASURING.write().await;
    let folder = tempfile::tempdir().unwrap();
    let locator = free_tcp_locator();
    let mut command = Command::new(env!("CARGO_BIN_EXE_test-coordinator"));
    // one job and nobody to do it
    command.arg(folder.path()).args([&locator, "1", "0", "0"]);
    let coordinator = Process::start(command);
    let per_s = async || {
        let at_first = processor_us(coordinator.pid());
        tokio::time::sleep(TIME).await;
        (processor_us(coordinator.pid()) - at_first) as f64 / TIME.as_secs_f64()
    };
    let nowhere = std::path::Path::new("");
    let mut sessions = vec![raw_session(&locator, nowhere, false, 10_000).await.unwrap()];
    let alone = per_s().await;
    while sessions.len() < SESSIONS {
        sessions.push(raw_session(&locator, nowhere, false, 10_000).await.unwrap());
    }
    let beside = per_s().await;
    let each = (beside - alone) / (SESSIONS - 1) as f64;
    eprintln!("an idle session costs the coordinator {each:.0} us of processor time a second");
}
