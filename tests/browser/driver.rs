//! Browser without a window, driven over `WebDriver`.
use fantoccini::{Client, ClientBuilder};
use hyper_util::client::legacy::connect::HttpConnector;
use serde_json::{Value, json};
use std::{
    fs,
    net::TcpStream,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};
use tests::process::{Process, free_tcp_locator, wait_until};
use tokio::runtime::Runtime;

/// Longest wait for something to appear on a page.
pub(crate) const LIMIT: Duration = Duration::from_secs(40);

/// Browser with one page; ends when dropped.
pub(crate) struct Browser {
    runtime: Runtime,
    client: Client,
    /// Log of the browser, which has the messages of its pages' consoles.
    log: PathBuf,
    _folder: tempfile::TempDir,
    _driver: Process,
}

/// Returns whether a program can be started.
fn exists(program: &str) -> bool {
    let mut command = Command::new(program);
    command.arg("--version").stdout(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

impl Browser {
    /// Starts a browser; `None` on a machine without Chromium, except in CI.
    pub(crate) fn start() -> Option<Self> {
        if !exists("chromium") || !exists("chromedriver") {
            tests::skip("no chromium and chromedriver: apt-get install chromium chromium-driver");
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        let locator = free_tcp_locator();
        let (_, port) = locator.rsplit_once(':').unwrap();
        let port: u16 = port.parse().unwrap();
        let mut command = Command::new("chromedriver");
        command.arg(format!("--port={port}")).stderr(Stdio::null());
        let driver = Process::start(command);
        wait_until("chromedriver listens", LIMIT, || {
            TcpStream::connect(("127.0.0.1", port)).is_ok()
        });
        let log = folder.path().join("browser.log");
        let arguments = [
            "--headless=new",
            // a test may run as root, and shows only pages of its own
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--disable-dev-shm-usage",
            "--enable-logging",
            &format!("--log-file={}", log.display()),
            &format!(
                "--user-data-dir={}",
                folder.path().join("profile").display()
            ),
        ];
        let capabilities = json!({ "goog:chromeOptions": { "args": arguments } });
        let capabilities = serde_json::from_value(capabilities).unwrap();
        let runtime = Runtime::new().unwrap();
        let client = runtime.block_on(async {
            ClientBuilder::new(HttpConnector::new())
                .capabilities(capabilities)
                .connect(&format!("http://127.0.0.1:{port}"))
                .await
        });
        Some(Self {
            runtime,
            client: client.unwrap(),
            log,
            _folder: folder,
            _driver: driver,
        })
    }

    pub(crate) fn open(&self, url: &str) {
        self.runtime.block_on(self.client.goto(url)).unwrap();
    }

    /// Returns the value of a script's `return` statement.
    pub(crate) fn script(&self, script: &str) -> Value {
        let answer = self.client.execute(script, Vec::new());
        self.runtime.block_on(answer).unwrap()
    }

    /// Returns the text of the first element that a CSS selector finds; empty without one.
    pub(crate) fn text(&self, selector: &str) -> String {
        let script = format!(
            "const found = document.querySelector({}); return found ? found.innerText : '';",
            json!(selector)
        );
        self.script(&script).as_str().unwrap().to_owned()
    }

    /// Waits until a script returns true, and returns the time that it took.
    pub(crate) fn wait_for(&self, what: &str, script: &str) -> Duration {
        let begun = Instant::now();
        while self.script(script) != Value::Bool(true) {
            assert!(
                begun.elapsed() < LIMIT,
                "not within {LIMIT:?}: {what}; the page shows:\n{}",
                self.text("body").chars().take(1500).collect::<String>()
            );
            thread::sleep(Duration::from_millis(50));
        }
        begun.elapsed()
    }

    /// Waits until the state of the run on the page is `state`.
    pub(crate) fn wait_for_state(&self, state: &str) -> Duration {
        let script = format!(
            "return document.getElementById('state').textContent === {}",
            json!(state)
        );
        self.wait_for(&format!("the run is {state}"), &script)
    }

    /// Sets the size of the window and writes a picture of it.
    pub(crate) fn picture(&self, (width, height): (u32, u32), file: &Path) {
        let picture = self.runtime.block_on(async {
            self.client.set_window_size(width, height).await?;
            // figures are laid out again
            tokio::time::sleep(Duration::from_millis(200)).await;
            self.client.screenshot().await
        });
        fs::write(file, picture.unwrap()).unwrap();
    }

    /// Returns the messages that pages wrote to their consoles, errors of scripts and refused resources among
    /// them.
    pub(crate) fn console(&self) -> Vec<String> {
        let log = fs::read_to_string(&self.log).unwrap_or_default();
        let messages = log.lines().filter(|line| line.contains(":CONSOLE"));
        messages.map(str::to_owned).collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // the driver ends the browser with the session
        drop(self.runtime.block_on(self.client.clone().close()));
    }
}
