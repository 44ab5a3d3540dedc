//! Workers on Kubernetes: a Deployment whose pods connect to the coordinator, a `NetworkPolicy` that forbids
//! all other traffic but DNS, and a Secret with the keys, which `kubectl` creates from the folder.
use super::{
    plan::{LaunchPlan, PlanPart, PlanStep, STEP, StepInput},
    shell::{line, settings},
    worker_options::WorkerOptions,
};
use link::keys::{CA, WORKER};
use serde_json::{Value, json};
use std::{fmt::Write as _, net::IpAddr, path::Path};
use support::Problem;

/// Name of all Kubernetes objects created.
const NAME: &str = "horsehead-worker";
/// Mount path of the keys in a pod.
const KEYS: &str = "/keys";

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
    let has_keys = !steps.is_empty();
    let objects = [
        deployment(
            order,
            replicas,
            &of(
                "image",
                concat!("horsehead-worker:", env!("CARGO_PKG_VERSION")),
            ),
            cpu,
            &of("memory", "1Gi"),
            has_keys,
        ),
        network_policy(order),
    ];
    let mut manifests = String::new();
    for object in objects {
        // JSON is YAML, and both kinds of people can read it when it is indented
        let _written = write!(manifests, "---\n{object:#}\n");
    }
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

fn deployment(
    order: &WorkerOptions,
    replicas: u16,
    image: &str,
    cpu: u16,
    memory: &str,
    has_keys: bool,
) -> Value {
    let slots = order.slots.unwrap_or(cpu);
    let mut arguments = WorkerOptions {
        slots: Some(slots),
        ..order.clone()
    }
    .arguments();
    if has_keys {
        arguments.extend(["--tls".to_owned(), KEYS.to_owned()]);
    }
    let resources = json!({ "cpu": cpu.to_string(), "memory": memory });
    let mut worker = json!({
        "name": "worker", "image": image, "args": arguments,
        "resources": { "requests": resources, "limits": resources },
        "securityContext": {
            "allowPrivilegeEscalation": false, "readOnlyRootFilesystem": true,
            "capabilities": { "drop": ["ALL"] },
        },
    });
    let mut pod = json!({
        "automountServiceAccountToken": false, "terminationGracePeriodSeconds": 30,
        "securityContext": {
            "runAsNonRoot": true, "runAsUser": 65532, "runAsGroup": 65532, "fsGroup": 65532,
            "seccompProfile": { "type": "RuntimeDefault" },
        },
    });
    if has_keys {
        worker["volumeMounts"] = json!([{ "name": "keys", "mountPath": KEYS, "readOnly": true }]);
        pod["volumes"] =
            json!([{ "name": "keys", "secret": { "secretName": NAME, "defaultMode": 0o440 } }]);
    }
    pod["containers"] = json!([worker]);
    json!({
        "apiVersion": "apps/v1", "kind": "Deployment", "metadata": { "name": NAME },
        "spec": {
            "replicas": replicas,
            "selector": { "matchLabels": { "app": NAME } },
            "template": { "metadata": { "labels": { "app": NAME } }, "spec": pod },
        },
    })
}

/// Builds the network policy: no incoming connections; outgoing ones only to DNS and the coordinator.
fn network_policy(order: &WorkerOptions) -> Value {
    let protocol = match order.connect.protocol {
        link::locator::Protocol::Unix | link::locator::Protocol::Tcp => "TCP",
        link::locator::Protocol::Quic => "UDP",
    };
    let mut coordinator =
        json!({ "ports": [{ "protocol": protocol, "port": order.connect.port }] });
    if let Ok(address) = order.connect.bare_host().parse::<IpAddr>() {
        let bits = if address.is_ipv4() { 32 } else { 128 };
        coordinator["to"] = json!([{ "ipBlock": { "cidr": format!("{address}/{bits}") } }]);
    }
    let names = json!({ "ports": [
        { "protocol": "UDP", "port": 53 }, { "protocol": "TCP", "port": 53 },
    ] });
    json!({
        "apiVersion": "networking.k8s.io/v1", "kind": "NetworkPolicy", "metadata": { "name": NAME },
        "spec": {
            "podSelector": { "matchLabels": { "app": NAME } },
            "policyTypes": ["Ingress", "Egress"], "ingress": [], "egress": [coordinator, names],
        },
    })
}
