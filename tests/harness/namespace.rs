//! Two simulated machines on one host, called head and node: network namespaces joined by a virtual Ethernet
//! cable that can be unplugged.
//!
//! The head has the address [`HEAD`], the node has [`NODE`]; neither has a route to other networks.
use std::{
    path::Path,
    process::{Command, Stdio},
    sync::atomic::{AtomicU32, Ordering},
};

/// IP address of the namespace called head.
pub const HEAD: &str = "10.77.0.1";
/// IP address of the namespace called node.
pub const NODE: &str = "10.77.0.2";

/// Two network namespaces, head and node, with a virtual cable between them; deleted when dropped.
#[derive(Debug)]
pub struct Namespaces {
    head: String,
    node: String,
}

impl Namespaces {
    /// Creates the namespaces; returns `None` after calling [`crate::skip`] where this machine does not allow
    /// them.
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

    /// Returns a command that runs a program in the namespace of the head.
    pub fn on_head(&self, program: &Path) -> Command {
        within(&self.head, program)
    }

    /// Returns a command that runs a program in the namespace of the node.
    pub fn on_node(&self, program: &Path) -> Command {
        within(&self.node, program)
    }

    /// Takes the head's end of the cable down (`false`) or up (`true`). The node's end stays up, so that the
    /// node notices only missing packets.
    ///
    /// # Panics
    /// If the namespaces no longer exist.
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
