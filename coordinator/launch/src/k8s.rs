//! Workers on Kubernetes: a Deployment whose pods connect to the coordinator, a `NetworkPolicy` that forbids
//! all other traffic but DNS, and a Secret with the keys, which `kubectl` creates from the folder.
use super::{
    plan::{LaunchPlan, PlanPart, PlanStep, STEP, StepInput},
    shell::{line, settings},
    worker_options::WorkerOptions,
};
use link::keys::{CA, WORKER};
use serde_json::json;
use std::{net::IpAddr, path::Path};
use support::Problem;

/// Name of all Kubernetes objects created.
const NAME: &str = "horsehead-worker";
/// Mount path of the keys in a pod.
const KEYS: &str = "/keys";

/// Deployment of workers, with the values of an example.
const DEPLOYMENT: &str = include_str!("../../../deploy/k8s/deployment.yaml");
/// Network policy of workers, with the coordinator of an example.
const NETWORK_POLICY: &str = include_str!("../../../deploy/k8s/network-policy.yaml");
/// Part of the Deployment that takes settings from a map, where the program gives arguments.
const ENVIRONMENT: &str = "          envFrom:
            - configMapRef:
                name: horsehead-worker
";
/// Parts of the Deployment that only workers with keys need.
const MOUNTS: &str = "          volumeMounts:
            - name: keys
              mountPath: /keys
              readOnly: true
";
const VOLUMES: &str = "      volumes:
        - name: keys
          secret:
            secretName: horsehead-worker
            defaultMode: 0440
";
/// Rule of the network policy for the coordinator.
const COORDINATOR: &str = "ports:
        - {protocol: UDP, port: 7447}";

/// Plans the application of the Kubernetes manifests for workers; `options` is `replicas=4`, optionally with
/// `image`, `namespace`, `cpu` and `memory`; `name` is the worker's key folder, shared by all pods.
///
/// # Errors
/// If the options cannot be parsed.
pub fn up(order: &WorkerOptions, options: &str, name: Option<&str>) -> Result<LaunchPlan, Problem> {
    let known = ["replicas", "image", "namespace", "cpu", "memory"];
    let given = settings("--k8s", options, &known)?;
    let of = |key: &str, usual: &str| {
        let found = given.iter().find(|(name, _)| name == key);
        found.map_or(usual.to_owned(), |(_, value)| value.clone())
    };
    let number = |key: &str, usual: &str, most: u16| {
        let text = of(key, usual);
        let number = text.parse::<u16>().ok().filter(|n| (1..=most).contains(n));
        number.ok_or_else(|| {
            Problem::new(
                format!("--k8s {key}={text}: not a number of 1 to {most}"),
                format!("write {key}=N"),
            )
        })
    };
    let (replicas, cpu) = (number("replicas", "1", 5000)?, number("cpu", "1", 4096)?);
    if !order.prologue.is_empty() {
        return Err(Problem::new(
            "--prologue has no effect with --k8s",
            "put what a worker needs into its image: deploy/Containerfile",
        ));
    }
    let namespace = of("namespace", "default");
    let mut steps = Vec::new();
    if let (Some(folder), Some(name)) = (&order.tls, name) {
        let make = StepInput::Command(secret(&folder.join(name)));
        steps.push(apply("make a secret of the keys", &namespace, make));
    }
    let image = of(
        "image",
        concat!("horsehead-worker:", env!("CARGO_PKG_VERSION")),
    );
    let resources = (cpu, of("memory", "1Gi"));
    let deployment = deployment(order, (replicas, &image), resources, !steps.is_empty());
    let manifests = format!("{deployment}---\n{}", network_policy(order));
    steps.push(apply(
        "apply the manifests",
        &namespace,
        StepInput::Text(manifests),
    ));
    Ok(LaunchPlan {
        local_steps: Vec::new(),
        parts: vec![PlanPart {
            place: "Kubernetes".to_owned(),
            success_message: format!(
                "{replicas} pods were asked for; `{}` shows them, `kubectl delete \
                 deployment/{NAME}` ends them",
                line(&["kubectl", "-n", &namespace, "get", "pods"].map(str::to_owned))
            ),
            steps,
        }],
    })
}

/// Builds a `kubectl apply` step that reads manifests from the given input.
fn apply(what: &str, namespace: &str, input: StepInput) -> PlanStep {
    PlanStep::Run {
        what: what.to_owned(),
        command: ["kubectl", "apply", "-n", namespace, "-f", "-"]
            .map(str::to_owned)
            .to_vec(),
        input,
        only_if: None,
        asks: false,
        limit: STEP,
        remedy: "see what `kubectl auth can-i create deployments` and `kubectl config \
                 current-context` say"
            .to_owned(),
    }
}

/// Returns the `kubectl` command that prints a Secret manifest of the keys in a folder.
fn secret(folder: &Path) -> Vec<String> {
    let make = [
        "kubectl",
        "create",
        "secret",
        "generic",
        NAME,
        "--dry-run=client",
        "-o",
        "yaml",
    ];
    let from = |file: &str| format!("--from-file={file}={}", folder.join(file).display());
    let files = [CA, WORKER[0], WORKER[1]].map(from);
    make.map(str::to_owned).into_iter().chain(files).collect()
}

/// Fills the Deployment of `deploy/k8s`, whose values stand for those of an example.
fn deployment(
    order: &WorkerOptions,
    (replicas, image): (u16, &str),
    (cpu, memory): (u16, String),
    has_keys: bool,
) -> String {
    let mut arguments = WorkerOptions {
        slots: Some(order.slots.unwrap_or(cpu)),
        ..order.clone()
    }
    .arguments();
    if has_keys {
        arguments.extend(["--tls".to_owned(), KEYS.to_owned()]);
    }
    let text = DEPLOYMENT
        .replace("replicas: 4", &format!("replicas: {replicas}"))
        .replace(
            "image: horsehead-worker",
            &format!("image: {}", json!(image)),
        )
        .replace(
            "args: [--tls=/keys]",
            &format!("args: {}", json!(arguments)),
        )
        .replace(ENVIRONMENT, "")
        .replace(
            "{cpu: \"1\", memory: 1Gi}",
            &json!({ "cpu": cpu.to_string(), "memory": memory }).to_string(),
        );
    if has_keys {
        return text;
    }
    text.replace(MOUNTS, "").replace(VOLUMES, "")
}

/// Fills the network policy of `deploy/k8s`: no incoming connections; outgoing ones only to DNS and the coordinator.
fn network_policy(order: &WorkerOptions) -> String {
    let protocol = match order.connect.protocol {
        link::locator::Protocol::Unix | link::locator::Protocol::Tcp => "TCP",
        link::locator::Protocol::Quic => "UDP",
    };
    let port = order.connect.port;
    let ports = format!("ports:\n        - {{protocol: {protocol}, port: {port}}}");
    let to = order.connect.bare_host().parse::<IpAddr>().map(|address| {
        let bits = if address.is_ipv4() { 32 } else { 128 };
        let block = json!([{ "ipBlock": { "cidr": format!("{address}/{bits}") } }]);
        format!("to: {block}\n      ")
    });
    let to = to.unwrap_or_default();
    NETWORK_POLICY.replace(COORDINATOR, &format!("{to}{ports}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that everything that is replaced in the manifests stands in them.
    #[test]
    fn the_manifests_have_what_is_filled_in() {
        let parts = [
            "replicas: 4",
            "image: horsehead-worker",
            "args: [--tls=/keys]",
            "{cpu: \"1\", memory: 1Gi}",
            ENVIRONMENT,
            MOUNTS,
            VOLUMES,
        ];
        for part in parts {
            assert!(DEPLOYMENT.contains(part), "{part}");
        }
        assert!(NETWORK_POLICY.contains(COORDINATOR));
    }
}
