//! Tests with peers that send invalid bytes or partial frames to the coordinator's sockets while a run is
//! going on.
use super::{LIMIT, MEASURING, idle::first_datagrams};
use protocol::{
    id::{RunId, draw},
    message::{FromWorker, Heartbeat},
    wire::{self, FrameKind},
};
use std::{
    fs,
    io::{Read, Write},
    net::{SocketAddr, TcpStream, UdpSocket},
    path::Path,
    process::Command,
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::Duration,
};
use tests::{
    keys::make,
    process::{Process, free_quic_locator, free_tcp_locator, worker_program},
};

/// Returns `length` pseudo-random bytes, different for each `n`.
fn noise(n: u64, length: usize) -> Vec<u8> {
    let words = (0..length.div_ceil(8) as u128).map(|at| draw(&n.to_string(), at).to_le_bytes());
    let mut bytes: Vec<u8> = words.flatten().collect();
    bytes.truncate(length);
    bytes
}

/// Returns the `n`-th invalid message for the TCP socket, whose frames consist of a length of two bytes and a
/// batch.
fn rubbish(n: u64) -> Vec<u8> {
    let framed = |length: u16, body: &[u8]| [&length.to_le_bytes(), body].concat();
    let some = usize::try_from(draw("length", n.into()) % 3000).unwrap();
    match n % 6 {
        0 => noise(n, some),
        1 => b"GET / HTTP/1.1\r\nHost: head\r\n\r\n".to_vec(),
        // half a frame, and one that begins as an opening does
        2 => framed(u16::MAX, &noise(n, 10)),
        3 => {
            let mut body = noise(n, some.max(1));
            body[0] = 1;
            framed(u16::try_from(body.len()).unwrap(), &body)
        }
        4 => {
            let beat = FromWorker::Beat(Heartbeat::default());
            wire::encode_frame(FrameKind::FromWorker, RunId(n), &beat).unwrap()
        }
        _ => framed(0, &[]),
    }
}

/// Opens connections to a TCP socket of the coordinator and sends invalid bytes until `stop` is set; returns
/// the number of connections.
fn throw_at(address: SocketAddr, lane: u64, stop: &AtomicBool) -> u64 {
    let mut thrown = 0;
    while !stop.load(Ordering::Relaxed) {
        let timeout = Duration::from_secs(1);
        let Ok(mut connection) = TcpStream::connect_timeout(&address, timeout) else {
            // it listens no longer
            thread::sleep(Duration::from_millis(5));
            continue;
        };
        thrown += 1;
        // the other end may close at any time
        drop(connection.write_all(&rubbish(6 * thrown / 5 + lane)));
        if thrown % 4 == 0 {
            // some wait for an answer, and leave in the middle of it
            drop(connection.set_read_timeout(Some(Duration::from_millis(20))));
            drop(connection.read(&mut [0; 16]));
        }
        thread::sleep(Duration::from_millis(2));
    }
    thrown
}

/// Waits for a coordinator to exit successfully without a panic in its log, and returns the last line of its
/// output.
fn ends_well(coordinator: &mut Process, log: &Path) -> String {
    let mut said = String::new();
    coordinator.output().read_to_string(&mut said).unwrap();
    let log = fs::read_to_string(log).unwrap();
    assert_eq!(coordinator.wait(LIMIT), Some(0), "{log}");
    assert!(!log.contains("panicked"), "{log}");
    said.lines().last().unwrap_or_default().to_owned()
}

#[test]
fn rubbish_on_the_tcp_socket_costs_no_result() {
    let _others = MEASURING.blocking_read();
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log");
    let locator = free_tcp_locator();
    let mut command = Command::new(env!("CARGO_BIN_EXE_test-coordinator"));
    command.arg(folder.path().join("run"));
    command.args([&locator, "800", "10", "0"]);
    let mut coordinator = Process::logged(command, &log);
    let worker = Process::worker(&locator, &["--slots", "2"]);
    let address = locator.trim_start_matches("tcp/").parse().unwrap();
    let stop = AtomicBool::new(false);
    let (last, thrown) = thread::scope(|scope| {
        let throwers = [0, 1].map(|lane| {
            let stop = &stop;
            scope.spawn(move || throw_at(address, lane, stop))
        });
        let last = ends_well(&mut coordinator, &log);
        stop.store(true, Ordering::Relaxed);
        let thrown: u64 = throwers.map(|it| it.join().unwrap()).iter().sum();
        (last, thrown)
    });
    eprintln!("{thrown} connections with rubbish");
    assert_eq!(last, "done repeated 0 replayed 0 lost 0");
    assert!(thrown > 100, "{thrown}");
    drop(worker);
}

/// Checks that invalid datagrams at the UDP socket, including damaged and truncated QUIC handshakes, cost no
/// result. Datagrams need no certificate to reach the coordinator.
#[tokio::test(flavor = "multi_thread")]
async fn rubbish_on_the_udp_socket_costs_no_result() {
    let _others = MEASURING.read().await;
    let folder = tempfile::tempdir().unwrap();
    let (keys, log) = (folder.path().join("keys"), folder.path().join("log"));
    make(&keys, &[]);
    let locator = free_quic_locator();
    let mut command = Command::new(env!("CARGO_BIN_EXE_test-network-coordinator"));
    command.arg(folder.path().join("run")).arg(&locator);
    command.arg(&keys).args(["600", "10"]);
    let mut coordinator = Process::logged(command, &log);
    let mut command = Command::new(worker_program());
    command.args(["--connect", &locator, "--slots", "2", "--tls"]);
    command.arg(keys.join("worker-01"));
    let worker = Process::start(command);
    let beginnings = first_datagrams(20).await;
    let address = locator.trim_start_matches("quic/").to_owned();
    let stop = AtomicBool::new(false);
    let (last, thrown) = thread::scope(|scope| {
        let thrower = scope.spawn(|| {
            let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
            let mut thrown = 0;
            while !stop.load(Ordering::Relaxed) {
                let n = usize::try_from(thrown).unwrap();
                let mut datagram = beginnings[n % beginnings.len()].clone();
                match thrown % 4 {
                    0 => datagram = noise(thrown, n % 1400),
                    1 => datagram.truncate(n % datagram.len()),
                    2 => {
                        let at = n * 31 % datagram.len();
                        datagram[at] ^= 0x55;
                    }
                    // a handshake that is begun again and again
                    _ => {}
                }
                // refused while nobody listens
                drop(socket.send_to(&datagram, &address));
                thrown += 1;
                thread::sleep(Duration::from_millis(1));
            }
            thrown
        });
        let last = ends_well(&mut coordinator, &log);
        stop.store(true, Ordering::Relaxed);
        (last, thrower.join().unwrap())
    });
    eprintln!("{thrown} datagrams of rubbish");
    assert!(last.starts_with("end "), "{last}");
    let (_, counts) = last.split_once(" done ").unwrap();
    assert_eq!(counts, "600 lost 0 repeated 0 duplicates 0");
    assert!(thrown > 1000, "{thrown}");
    drop(worker);
}
