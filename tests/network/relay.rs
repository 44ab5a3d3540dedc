//! Relay program that simulates an unreliable network: forwards datagrams, but loses, duplicates, delays and
//! reorders them.
//!
//! `test-relay LISTEN TARGET SEED LOSS DUPLICATION DELAY_MS`: loss and duplication are shares from 0 to 1 and
//! apply in both directions. (The kernel's netem does the same, but is not in every kernel.) Each datagram
//! gets its own random delay, so that datagrams overtake each other. Every hundred datagrams a line reports
//! how many were lost and duplicated.
use protocol::id::draw;
use std::{
    collections::BTreeMap,
    env,
    error::Error,
    io::{self, Write},
    net::SocketAddr,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};
use tokio::net::UdpSocket;

/// Number of datagrams after which the relay prints a line.
const REPORT_INTERVAL: u64 = 100;
/// Longest possible datagram (bytes).
const LONGEST: usize = 65_535;

/// Probabilities of loss and duplication, largest delay, and counters of the relay.
#[derive(Clone, Debug)]
struct Impairment {
    seed: String,
    drawn: Arc<AtomicU64>,
    loss: f64,
    duplication: f64,
    delay: Duration,
    lost: Arc<AtomicU64>,
    doubled: Arc<AtomicU64>,
}

impl Impairment {
    /// Draws a uniform number in [0, 1).
    fn draw(&self) -> f64 {
        let count = self.drawn.fetch_add(1, Ordering::Relaxed);
        (draw(&self.seed, count.into()) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Draws the delay of each copy of a datagram; no copy if the datagram is lost, two if it is duplicated.
    fn copy_delays(&self) -> Vec<Duration> {
        if self.draw() < self.loss {
            self.lost.fetch_add(1, Ordering::Relaxed);
            return Vec::new();
        }
        let doubled = u64::from(self.draw() < self.duplication);
        self.doubled.fetch_add(doubled, Ordering::Relaxed);
        (0..=doubled)
            .map(|_| self.delay.mul_f64(self.draw()))
            .collect()
    }
}

/// Forwards the copies of one datagram after their random delays.
fn pass(weather: &Impairment, socket: &Arc<UdpSocket>, to: SocketAddr, datagram: &[u8]) {
    for delay in weather.copy_delays() {
        let (socket, datagram) = (Arc::clone(socket), datagram.to_vec());
        drop(tokio::spawn(async move {
            tokio::time::sleep(delay).await;
            // what cannot be sent is lost, as on any network
            drop(socket.send_to(&datagram, to).await);
        }));
    }
}

/// Forwards the target's answers to one client until the socket fails.
async fn answer(
    weather: Impairment,
    inner: Arc<UdpSocket>,
    outer: Arc<UdpSocket>,
    client: SocketAddr,
) {
    let mut buffer = vec![0; LONGEST];
    while let Ok((length, _)) = inner.recv_from(&mut buffer).await {
        pass(&weather, &outer, client, &buffer[..length]);
    }
}

#[tokio::main]
async fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [listen, target, seed, loss, duplication, delay_ms] = arguments.as_slice() else {
        return Err("expected LISTEN TARGET SEED LOSS DUPLICATION DELAY_MS".into());
    };
    let weather = Impairment {
        seed: seed.clone(),
        drawn: Arc::default(),
        loss: loss.parse()?,
        duplication: duplication.parse()?,
        delay: Duration::from_millis(delay_ms.parse()?),
        lost: Arc::default(),
        doubled: Arc::default(),
    };
    let target: SocketAddr = target.parse()?;
    let outer = Arc::new(UdpSocket::bind(listen).await?);
    let mut clients: BTreeMap<SocketAddr, Arc<UdpSocket>> = BTreeMap::new();
    let mut buffer = vec![0; LONGEST];
    let mut out = io::stdout();
    for count in 1_u64.. {
        if count.is_multiple_of(REPORT_INTERVAL) {
            let counts = [&weather.lost, &weather.doubled].map(|at| at.load(Ordering::Relaxed));
            writeln!(out, "lost {} doubled {}", counts[0], counts[1])?;
        }
        let Ok((length, client)) = outer.recv_from(&mut buffer).await else {
            // a client that is gone is reported here, and is nobody's business
            continue;
        };
        let inner = if let Some(inner) = clients.get(&client) {
            Arc::clone(inner)
        } else {
            let inner = Arc::new(UdpSocket::bind((outer.local_addr()?.ip(), 0)).await?);
            let (weather, back) = (weather.clone(), Arc::clone(&outer));
            drop(tokio::spawn(answer(
                weather,
                Arc::clone(&inner),
                back,
                client,
            )));
            clients.insert(client, Arc::clone(&inner));
            inner
        };
        pass(&weather, &inner, target, &buffer[..length]);
    }
    Ok(())
}
