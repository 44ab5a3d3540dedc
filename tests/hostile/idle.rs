//! Peers that connect and then say nothing, as many as the machine allows.
use super::{LIMIT, MEASURING, processor_us, rate};
use coordinator::runtime::{Dispatch, DispatchOptions};
use std::{
    collections::BTreeMap,
    net::{TcpStream, UdpSocket},
    process::Command,
    sync::Arc,
    time::{Duration, Instant},
};
use tests::{
    expect_results,
    keys::make,
    options,
    process::{Process, free_locator, free_quic_locator, wait_until, worker_program},
};

/// Handshakes that are begun and not finished.
const BEGUN: usize = 300;
/// Connections that say nothing, fewer where the machine allows no more.
const IDLE: usize = 5000;

/// First datagrams of as many different QUIC handshakes, as clients of the bus send them.
async fn first_datagrams(count: usize) -> Vec<Vec<u8>> {
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

/// Anybody on the network can begin handshakes and leave it at that, with no certificate at all.
#[tokio::test(flavor = "multi_thread")]
async fn handshakes_that_are_never_finished_keep_nobody_out() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    make(&keys, &[]);
    let locator = free_quic_locator();
    let dispatch = Dispatch::open(DispatchOptions {
        tls: Some(keys.clone()),
        ..options(&folder.path().join("run"), Some(&locator), 0)
    })
    .await
    .unwrap();
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
    wait_until("an honest worker joins", Duration::from_secs(5), || {
        dispatch.snapshot().workers.len() == 1
    });
    eprintln!(
        "an honest worker joined {:?} after its start, beside {BEGUN} begun handshakes",
        dialled.elapsed()
    );
    dispatch.close().await.unwrap();
    drop((silent, worker));
}

/// Connections of a local program that never say a word.
#[tokio::test(flavor = "multi_thread")]
async fn thousands_of_silent_connections_cost_little_and_no_result() {
    let _alone = MEASURING.lock().await;
    let folder = tempfile::tempdir().unwrap();
    let locator = free_locator();
    let mut dispatch = Dispatch::open(options(folder.path(), Some(&locator), 0))
        .await
        .unwrap();
    let honest = Process::worker(&locator, &["--slots", "2"]);
    wait_until("the honest worker joins", LIMIT, || {
        dispatch.snapshot().workers.len() == 1
    });
    let mut results = BTreeMap::new();
    let time = Duration::from_secs(4);
    let cost = |spent_us: u64, jobs: usize| spent_us as f64 / jobs as f64;
    let at_first = processor_us();
    let before = rate(&mut dispatch, &mut results, time).await;
    let cost_before = cost(processor_us() - at_first, results.len());
    let address: std::net::SocketAddr = locator.trim_start_matches("tcp/").parse().unwrap();
    let begun = Instant::now();
    let mut idle = Vec::new();
    while idle.len() < IDLE && begun.elapsed() < Duration::from_secs(10) {
        match TcpStream::connect_timeout(&address, Duration::from_secs(1)) {
            Ok(connection) => idle.push(connection),
            // as many as the machine allows
            Err(_) => break,
        }
    }
    let opened = begun.elapsed();
    let (at_first, done) = (processor_us(), results.len());
    let meanwhile = rate(&mut dispatch, &mut results, time).await;
    let cost_meanwhile = cost(processor_us() - at_first, results.len() - done);
    // and somebody else still gets in
    let late = Instant::now();
    let second = Process::worker(&locator, &["--slots", "2"]);
    wait_until("another honest worker joins", LIMIT, || {
        dispatch.snapshot().workers.len() == 2
    });
    eprintln!(
        "jobs a second: {before:.0} before, {meanwhile:.0} beside {} silent connections (opened in \
         {opened:?}); processor time of the coordinator for each {cost_before:.0} us before, \
         {cost_meanwhile:.0} us meanwhile; another worker joined after {:?}",
        idle.len(),
        late.elapsed()
    );
    let jobs = results.len() as u64;
    expect_results(&results, jobs);
    let last = dispatch.close().await.unwrap().last;
    assert_eq!((last.lost, last.failed, last.done as u64), (0, 0, jobs));
    assert!(idle.len() > 500, "only {} connections", idle.len());
    drop((idle, honest, second));
}
