//! Peers that connect and then say nothing, as many as the machine allows.
use super::{LIMIT, rate};
use coordinator::runtime::{Dispatch, DispatchOptions};
use std::{
    collections::BTreeMap,
    net::{TcpStream, UdpSocket},
    time::{Duration, Instant},
};
use tests::{
    expect_results,
    keys::make,
    options,
    process::{Process, free_locator, free_quic_locator, wait_until, worker_program},
};

/// A first datagram of a QUIC handshake, as a worker sends it.
fn first_datagram(tls: &std::path::Path) -> Vec<u8> {
    let ear = UdpSocket::bind("127.0.0.1:0").unwrap();
    ear.set_read_timeout(Some(LIMIT)).unwrap();
    let locator = format!("quic/{}", ear.local_addr().unwrap());
    let mut command = std::process::Command::new(worker_program());
    command
        .args(["--connect", &locator, "--slots", "1", "--tls"])
        .arg(tls);
    let _worker = Process::start(command);
    let mut buffer = [0; 2000];
    loop {
        // what is short only asks whether the port is open
        let length = ear.recv(&mut buffer).unwrap();
        if length > 1000 {
            return buffer[..length].to_vec();
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn handshakes_that_are_never_finished_keep_nobody_out() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    make(&keys, &[]);
    let tls = keys.join("worker-01");
    let locator = free_quic_locator();
    let dispatch = Dispatch::open(DispatchOptions {
        tls: Some(keys.clone()),
        ..options(&folder.path().join("run"), Some(&locator), 0)
    })
    .await
    .unwrap();
    let begun = first_datagram(&tls);
    let silent: Vec<UdpSocket> = (0..1)
        .map(|_| {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            socket.connect(locator.trim_start_matches("quic/")).unwrap();
            socket.send(&begun).unwrap();
            socket
        })
        .collect();
    std::thread::sleep(Duration::from_millis(300));
    let dialled = Instant::now();
    let mut command = std::process::Command::new(worker_program());
    command
        .args(["--connect", &locator, "--slots", "1", "--tls"])
        .arg(&tls);
    let worker = Process::start(command);
    wait_until("an honest worker joins", LIMIT, || {
        dispatch.snapshot().workers.len() == 1
    });
    eprintln!("joined {:?} after it was started", dialled.elapsed());
    dispatch.close().await.unwrap();
    drop((silent, worker));
}
