//! `horsehead dashboard`: shows runs in a browser, live and finished.
use crate::cli::output::{problem::EXIT_CODES, terminal};
use clap::Args;
use dashboard::{DEFAULT_PORT, FolderPages, RunPages, listen, listen_near, token};
use dashboard::{Pages, serve};
use run::{
    folder::RunFolder,
    message,
    session::{dispatcher, interrupt},
};
use std::{
    io::Read as _,
    net::{IpAddr, Ipv4Addr, TcpListener},
    path::PathBuf,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};
use study::Stop;
use support::Problem;
use tokio::sync::watch;

/// Show a run, or a folder of runs, in a browser: while it goes on, and afterwards.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead dashboard
  horsehead dashboard runs/cyjs10-5-37hb-quick-seed1
  horsehead calibrate cases/cyjs10-5-37hb --dashboard

No request changes a run, and only this machine is answered unless --address says otherwise.
The token in the printed address keeps other users of the machine out.
From another machine: ssh -L 7450:127.0.0.1:7450 HOST, then open the printed address there.
Ctrl-C ends the dashboard; runs go on.
{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Run folder, which need not exist yet, or a folder of runs.
    #[arg(
        value_name = "RUN|FOLDER",
        default_value = "runs",
        env = "HORSEHEAD_RUN"
    )]
    path: PathBuf,
    /// Port to listen on; 0 for any free one.
    #[arg(long, value_name = "PORT", default_value_t = DEFAULT_PORT, env = "HORSEHEAD_PORT")]
    port: u16,
    /// Address of this machine to listen on; at any other than loopback, token and runs travel unencrypted over the
    /// network.
    #[arg(long, value_name = "IP", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST), env = "HORSEHEAD_ADDRESS")]
    address: IpAddr,
    /// End when standard input does, and show the run even before it has begun: for `--dashboard`.
    #[arg(long, hide = true, env = "HORSEHEAD_ATTACHED")]
    attached: bool,
}

/// Longest time for which the page of a command that has ended is kept up, until it shows the end.
const LAST_LOOK: Duration = Duration::from_secs(5);
/// Time for which the page of the end is served to the browsers that are open.
const LAST_ANSWER: Duration = Duration::from_secs(1);

/// Serves the pages until the user stops it.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let path = &arguments.path;
    let is_run = arguments.attached || RunFolder::new(path).is_begun();
    if !is_run && !path.is_dir() {
        return Err(Problem {
            message: format!("{} is neither a run folder nor a folder of runs", path.display()),
            remedy: "name a folder below runs/, or a folder that holds such folders; `horsehead calibrate CASE \
                     --dashboard` begins a run with its page"
                .to_owned(),
        }
        .into());
    }
    let listener = if arguments.attached {
        listen_near(arguments.address, arguments.port)?
    } else {
        listen(arguments.address, arguments.port)?
    };
    let address = listener.local_addr()?;
    let token = token()?;
    let url = format!("http://{address}/?token={token}");
    terminal::write(&format!("{url}\n"))?;
    if !arguments.attached {
        message::print("open this address in a browser; Ctrl-C ends the dashboard, and runs go on");
    }
    if !address.ip().is_loopback() {
        message::print(
            "warning: the token and the runs travel without encryption: whoever overhears them can see the runs",
        );
    }
    if is_run {
        let pages = Arc::new(RunPages::begin(path));
        let own = Arc::clone(&pages);
        let end = arguments
            .attached
            .then(|| input_end(move || own.has_ended()));
        let served = block_on((listener, &token), Arc::clone(&pages), end);
        pages.close();
        served
    } else {
        let pages = Arc::new(FolderPages::begin(path));
        let served = block_on((listener, &token), Arc::clone(&pages), None);
        pages.close();
        served
    }
}

/// Serves pages to browsers with the token until the user stops it, or `end` becomes true.
fn block_on(
    (listener, token): (TcpListener, &str),
    pages: Arc<impl Pages>,
    end: Option<Stop>,
) -> anyhow::Result<()> {
    dispatcher::block_on(async {
        let mut stop = interrupt::listen();
        listener.set_nonblocking(true)?;
        let listener = tokio::net::TcpListener::from_std(listener)?;
        let ended = async move {
            match end {
                Some(mut end) => tokio::select! {
                    _gone = end.wait_for(|end| *end) => {}
                    _gone = stop.wait_for(|stop| *stop) => {}
                },
                None => drop(stop.wait_for(|stop| *stop).await),
            }
        };
        serve(listener, token, pages, ended).await?;
        Ok(())
    })
}

/// Returns a value that becomes true when standard input has ended and the page shows the end of the run, or does
/// not show it in time.
fn input_end(shows_end: impl Fn() -> bool + Send + 'static) -> Stop {
    let (sender, end) = watch::channel(false);
    thread::spawn(move || {
        let mut rest = Vec::new();
        // what ends with an error has ended, too
        drop(std::io::stdin().read_to_end(&mut rest));
        let begun = Instant::now();
        while !shows_end() && begun.elapsed() < LAST_LOOK {
            thread::sleep(Duration::from_millis(100));
        }
        thread::sleep(LAST_ANSWER);
        sender.send_replace(true);
    });
    end
}
