//! Surveys.
use crate::strata::{OUTSIDE, named, planted};
use crate::trial::{diagnose_usual, line};
use crate::truth::Truth;
use std::io::Write as _;

fn go(label: &str, truths: Vec<(String, Truth)>) {
    for (id, t) in truths {
        let started = std::time::Instant::now();
        let d = diagnose_usual(&t);
        let ids: Vec<&str> = d.effects.iter().map(|e| e.id.as_str()).collect();
        let true_ids: Vec<&str> = t.effects.iter().map(|e| e.0.as_str()).collect();
        let ok = if true_ids.is_empty() {
            "    "
        } else if true_ids.iter().all(|i| ids.contains(i)) {
            if ids.first() == true_ids.first() {
                "TOP1"
            } else {
                "SET "
            }
        } else {
            "MISS"
        };
        writeln!(
            std::io::stderr().lock(),
            "{label} {ok} {id} {:?} {:.1}s | {}",
            t.effects,
            started.elapsed().as_secs_f64(),
            line(&d)
        )
        .unwrap();
    }
}

fn per() -> u64 {
    std::env::var("PER")
        .ok()
        .and_then(|s| s.parse().ok())
        .unwrap_or(2)
}
fn multiple() -> f64 {
    std::env::var("MULT")
        .ok()
        .and_then(|s| s.parse().ok())
        .unwrap_or(3.0)
}

#[test]
#[ignore]
fn single() {
    let t = named()
        .into_iter()
        .enumerate()
        .flat_map(|(k, e)| {
            (0..per()).map(move |s| {
                (
                    e.id.clone(),
                    planted(Truth::healthy(100 + 10 * k as u64 + s), e, multiple()),
                )
            })
        })
        .collect();
    go("single", t);
}

#[test]
#[ignore]
fn zero() {
    go(
        "zero",
        (0..per())
            .map(|s| (format!("{s}"), Truth::healthy(2000 + s)))
            .collect(),
    );
}

#[test]
#[ignore]
fn outside() {
    let t = OUTSIDE
        .iter()
        .enumerate()
        .flat_map(|(k, (u, _))| {
            (0..per()).map(move |s| {
                let mut t = Truth::healthy(3000 + 10 * k as u64 + s);
                t.unlisted = Some(*u);
                (format!("{u:?}"), t)
            })
        })
        .collect();
    go("outside", t);
}

#[test]
#[ignore]
fn double() {
    let n = named();
    let t = (0..per())
        .map(|s| {
            let (a, b) = (
                (s as usize * 5 + 1) % n.len(),
                (s as usize * 7 + 3) % n.len(),
            );
            (
                format!("{} + {}", n[a].id, n[b].id),
                planted(planted(Truth::healthy(4000 + s), n[a], 4.0), n[b], 4.0),
            )
        })
        .collect();
    go("double", t);
}
