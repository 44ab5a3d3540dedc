//! Access control of the router: the actions allowed to the workers of each certificate; all other actions
//! are denied.
//!
//! The transport identifies a peer by the common name of its certificate. Rules are fixed when a coordinator
//! starts and also cover a pool of names that are not in use yet; the gate decides who is admitted. A denied
//! action gives the peer no error, which is why names that are not on the list are refused at the gate.
use protocol::{key::Grant, name::NO_CERTIFICATE};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Returns the `access_control` section of the router's configuration; with `plain`, workers without
/// certificates are admitted through Unix sockets, which other users cannot reach, and through TCP listeners, which
/// the user must have allowed.
pub(super) fn control(owners: &BTreeSet<String>, plain: bool) -> Value {
    let mut rules = vec![
        rule("fetch-in", "ingress", &["query"], &[Grant::blob_queries()]),
        rule(
            "fetch-out",
            "egress",
            &["reply", "declare_queryable"],
            &[Grant::blob_queries()],
        ),
    ];
    let (mut subjects, mut policies) = (Vec::new(), Vec::new());
    let mut grant = |owner: &str, mut subject: Value| {
        let id = |what: &str| format!("{owner}-{what}");
        let Grant {
            subscribe: hear,
            publish: speak,
            liveliness: appear,
        } = Grant::of(owner);
        let hear = [hear];
        rules.extend([
            rule(&id("listen"), "ingress", &["declare_subscriber"], &hear),
            rule(&id("hear"), "egress", &["put"], &hear),
            rule(&id("speak"), "ingress", &["put"], &speak),
            rule(&id("appear"), "ingress", &["liveliness_token"], &[appear]),
        ]);
        subject["id"] = json!(id("subject"));
        subjects.push(subject);
        policies.push(json!({
            "rules": [
                id("listen"), id("hear"), id("speak"), id("appear"), "fetch-in", "fetch-out",
            ],
            "subjects": [id("subject")],
        }));
    };
    for owner in owners {
        grant(
            owner,
            json!({ "cert_common_names": [owner], "link_protocols": ["quic"] }),
        );
    }
    if plain {
        grant(
            NO_CERTIFICATE,
            json!({ "link_protocols": ["unixsock-stream", "tcp"] }),
        );
    }
    json!({
        "enabled": true, "default_permission": "deny",
        "rules": rules, "subjects": subjects, "policies": policies,
    })
}

fn rule(id: &str, flow: &str, messages: &[&str], keys: &[String]) -> Value {
    json!({
        "id": id, "permission": "allow", "flows": [flow], "messages": messages, "key_exprs": keys,
    })
}
