//! Two machines on one: network namespaces joined by a cable that can be pulled.
//!
//! The head is at [`HEAD`], the node at [`NODE`]; nothing leads out of them.
use std::{
    path::Path,
    process::{Command, Stdio},
    sync::atomic::{AtomicU32, Ordering},
};

/// Address of the head within its namespaces.
pub const HEAD: &str = "10.77.0.1";
/// Address of the node within its namespaces.
pub const NODE: &str = "10.77.0.2";

/// A head, a node and the cable between them; gone when dropped.
#[derive(Debug)]
pub struct Namespaces {
    head: String,
    node: String,
}

impl Namespaces {
    /// Makes them; `None` after [`crate::skip`] where this machine does not allow it.
    pub fn make() -> Option<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = |what: &str| format!("hh{}-{count}-{what}", std::process::id());
        let made = Self {
            head: name("head"),
            node: name("node"),
        };
        match made.connect() {
            Ok(()) => Some(made),
            Err(reason) => {
                crate::skip(&format!(
                    "network namespaces cannot be made here ({reason}); this needs Linux, root and iproute2"
                ));
                None
            }
        }
    }

    fn connect(&self) -> Result<(), String> {
        let Self { head, node } = self;
        ip(&["netns", "add", head])?;
        ip(&["netns", "add", node])?;
        ip(&[
            "link", "add", "cable", "netns", head, "type", "veth", "peer", "name", "cable",
            "netns", node,
        ])?;
        for (namespace, address) in [(head, HEAD), (node, NODE)] {
            ip(&[
                "-n",
                namespace,
                "addr",
                "add",
                &format!("{address}/24"),
                "dev",
                "cable",
            ])?;
            ip(&["-n", namespace, "link", "set", "lo", "up"])?;
            ip(&["-n", namespace, "link", "set", "cable", "up"])?;
        }
        Ok(())
    }

    /// A program to be run on the head.
    pub fn on_head(&self, program: &Path) -> Command {
        within(&self.head, program)
    }

    /// A program to be run on the node.
    pub fn on_node(&self, program: &Path) -> Command {
        within(&self.node, program)
    }

    /// Pulls the cable out of the head, or puts it back: the node notices nothing but silence.
    ///
    /// # Panics
    /// If the namespaces are gone.
    pub fn plug(&self, is_in: bool) {
        let state = if is_in { "up" } else { "down" };
        ip(&["-n", &self.head, "link", "set", "cable", state]).expect("the cable is there");
    }
}

impl Drop for Namespaces {
    fn drop(&mut self) {
        for namespace in [&self.head, &self.node] {
            // fails only if it was never made; the cable goes with it
            drop(ip(&["netns", "del", namespace]));
        }
    }
}

fn within(namespace: &str, program: &Path) -> Command {
    let mut command = Command::new("ip");
    command.args(["netns", "exec", namespace]).arg(program);
    command
}

fn ip(arguments: &[&str]) -> Result<(), String> {
    let output = Command::new("ip")
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("ip: {error}"))?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    Err(format!("ip {}: {said}", arguments.join(" ")))
}
