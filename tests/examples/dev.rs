use simulation::observe::Recorder;
use simulation::run::simulate;
use std::path::Path;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let root = std::env::var("CASE").unwrap_or("cases/cyjs10-5-37hb".into());
    let mut case = coordinator::case::load(
        Path::new(&root),
        &coordinator::case::Overrides {
            measured: std::env::var("MEASURED").ok().map(Into::into),
        },
    )
    .unwrap();
    if let Ok(l) = std::env::var("PITCH") {
        let l: f64 = l.parse().unwrap();
        let f = case.ropes.cylinder_length_m / l;
        case.ropes.cylinder_length_m = l;
        case.ropes.back_cylinders = (case.ropes.back_cylinders as f64 * f).round() as usize;
        case.ropes.front_cylinders = (case.ropes.front_cylinders as f64 * f).round() as usize;
    }
    if let Ok(x) = std::env::var("SUSP") {
        case.suspension.mass_kg = x.parse().unwrap();
    }
    if let Ok(x) = std::env::var("TOL") {
        case.run.tolerance = x.parse().unwrap();
    }
    if let Ok(x) = std::env::var("LEAD") {
        case.run.lead_in_deg = x.parse().unwrap();
    }
    if let Ok(x) = std::env::var("RADD") {
        let r: f64 = x.parse().unwrap();
        case.back_head.radius_m += r;
        case.front_head.radius_m += r;
    }
    if let Ok(x) = std::env::var("MODES") {
        case.run.modes = x.parse().unwrap();
    }
    if let Ok(x) = std::env::var("RODL") {
        let r: f64 = x.parse().unwrap();
        case.rod.length_m += r;
    }
    if let Ok(x) = std::env::var("INERTIA") {
        let r: f64 = x.parse().unwrap();
        case.beam.inertia_kg_m2 *= r;
    }
    if let Ok(x) = std::env::var("RODM") {
        let r: f64 = x.parse().unwrap();
        case.rod.mass_kg *= r;
    }
    if let Ok(x) = std::env::var("GX") {
        let r: f64 = x.parse().unwrap();
        for k in 0..4 {
            case.modal_head.inertia_stress_mpa[0][k] *= r;
        }
    }
    if let Ok(x) = std::env::var("GY") {
        let r: f64 = x.parse().unwrap();
        for k in 0..4 {
            case.modal_head.inertia_stress_mpa[1][k] *= r;
        }
    }
    if let Ok(x) = std::env::var("GR") {
        let r: f64 = x.parse().unwrap();
        for k in 0..4 {
            case.modal_head.inertia_stress_mpa[2][k] *= r;
        }
    }
    if let Ok(x) = std::env::var("WHOLE") {
        if x == "1" {
            case.ropes.ends = protocol::case::RopeEnds::WholePitch;
        }
    }
    if let Ok(x) = std::env::var("RADB") {
        let r: f64 = x.parse().unwrap();
        case.back_head.radius_m += r;
    }
    if std::env::var("SWAP").is_ok() {
        case.modal_head.inertia_stress_mpa.swap(0, 1);
    }
    if let Ok(x) = std::env::var("ZETA") {
        case.modal_head.damping_ratio = x.parse().unwrap();
    }
    if let Ok(x) = std::env::var("CEXP") {
        case.contact.exponent = x.parse().unwrap();
    }
    if let Ok(x) = std::env::var("GRAV") {
        case.gravity_m_s2 = x.parse().unwrap();
    }
    if let Ok(x) = std::env::var("FRONTD") {
        let r: f64 = x.parse().unwrap();
        case.front_head.rope_anchor_deg += r;
    }
    let names = [
        "kb1", "kb23", "kb4", "kb56", "cb1", "cb23", "cb4", "cb56", "kc", "cc",
    ];
    let mut genes = if args[1] == "rec" {
        case.recommended()
    } else {
        coordinator::case::read_genes(Path::new(&args[1]), &case).unwrap()
    };
    for a in &args[2..] {
        if let Some((k, v)) = a.split_once('=') {
            let i = names.iter().position(|n| *n == k).unwrap();
            let v: f64 = v.parse().unwrap();
            genes[i] = v;
        }
    }
    let cond = case
        .condition(&std::env::var("COND").unwrap_or("5rpm".into()))
        .unwrap();
    let machine = worker::convert::machine(&case, cond).unwrap();
    let law = worker::convert::rope_law(&case, &genes).unwrap();
    let mut settings = worker::convert::run_settings(&case);
    if let Ok(m) = std::env::var("METHOD") {
        settings.method = simulation::integrator::tableau::CATALOGUE
            .iter()
            .find(|t| t.name == m)
            .unwrap();
    }
    if let Ok(x) = std::env::var("HMAX") {
        settings.longest_step = x.parse().unwrap();
    }
    if let Ok(n) = std::env::var("RANDOM") {
        let dec: f64 = std::env::var("DEC").unwrap_or("4".into()).parse().unwrap();
        let n: usize = n.parse().unwrap();
        let mut seed = 12345u64;
        let mut walls: Vec<(f64, String)> = vec![];
        let mut count = std::collections::BTreeMap::new();
        for i in 0..n {
            let g: Vec<f64> = case
                .recommended()
                .iter()
                .map(|r| {
                    seed = seed
                        .wrapping_mul(6364136223846793005)
                        .wrapping_add(1442695040888963407);
                    let u = (seed >> 11) as f64 / (1u64 << 53) as f64;
                    r * 10f64.powf(dec * (2.0 * u - 1.0))
                })
                .collect();
            let law = worker::convert::rope_law(&case, &g).unwrap();
            let mut rec = Recorder::gauges_only();
            let t = std::time::Instant::now();
            let r = simulate(&machine, &law, &settings, &mut rec);
            let w = t.elapsed().as_secs_f64();
            let name = match r.verdict {
                simulation::verdict::Verdict::Complete => "complete".to_string(),
                simulation::verdict::Verdict::Failed { kind, reached } => format!(
                    "{kind:?} {}",
                    match reached {
                        simulation::verdict::Reached::LoadFraction(_) => "load",
                        _ => "time",
                    }
                ),
            };
            let e = count.entry(name.clone()).or_insert((0, vec![]));
            e.0 += 1;
            e.1.push(w);
            walls.push((
                w,
                format!(
                    "{i} {:?} {:?} {:?}",
                    r.verdict,
                    r.statistics,
                    g.iter()
                        .zip(case.recommended())
                        .map(|(a, b)| (a / b).log10())
                        .collect::<Vec<_>>()
                ),
            ));
        }
        for (k, (c, mut w)) in count {
            w.sort_by(f64::total_cmp);
            println!(
                "{k:40} {c:4} median {:.3} max {:.3}",
                w[w.len() / 2],
                w[w.len() - 1]
            );
        }
        walls.sort_by(|a, b| b.0.total_cmp(&a.0));
        for w in walls.iter().take(6) {
            println!("{:.2} {}", w.0, w.1);
        }
        return;
    }
    let reps: usize = std::env::var("REPS")
        .ok()
        .and_then(|x| x.parse().ok())
        .unwrap_or(1);
    let mut rec = Recorder::default();
    let mut walls = vec![];
    let mut result = None;
    for _ in 0..reps {
        rec = if std::env::var("CSV").is_err() {
            Recorder::gauges_only()
        } else {
            Recorder::everything(0)
        };
        let t = std::time::Instant::now();
        result = Some(simulate(&machine, &law, &settings, &mut rec));
        walls.push(t.elapsed().as_secs_f64());
    }
    walls.sort_by(f64::total_cmp);
    let result = result.unwrap();
    println!(
        "{:?} wall {:.3}\n{:?}\nwork {:?} stored {:.1} err {:.2e}",
        result.verdict,
        walls[reps / 2],
        result.statistics,
        result.work,
        result.stored,
        (result.work.input - result.work.output - result.work.dissipated - result.stored).abs()
            / result.work.input.abs().max(1.0)
    );
    let record = case.conditions[cond].record.as_ref().unwrap();
    for g in &record.gauges {
        let sim = &rec.curves.gauge[(g.gauge - 1) as usize];
        if sim.len() < g.mean_mpa.len() {
            continue;
        }
        let n = sim.len() as f64;
        let off: f64 = sim
            .iter()
            .zip(&g.mean_mpa)
            .map(|(s, m)| m - s * 1e-6)
            .sum::<f64>()
            / n;
        let mse: f64 = sim
            .iter()
            .zip(&g.mean_mpa)
            .map(|(s, m)| (m - s * 1e-6 - off).powi(2))
            .sum::<f64>()
            / n;
        let (lo, hi) = sim
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        println!(
            "gauge {} mse {:.4} offset {:.3} range {:.3}..{:.3}",
            g.gauge,
            mse,
            off,
            lo * 1e-6,
            hi * 1e-6
        );
    }
    if let Ok(path) = std::env::var("CSV") {
        use std::fmt::Write;
        let mut s = String::from("turn,g1,g2,g3,g4,m1,m2,m3,m4,tb,tf,beam,y,torque\n");
        let c = &rec.curves;
        for i in 0..c.beam.len() {
            write!(s, "{}", i as f64 * case.run.output_step_deg).unwrap();
            for g in 0..4 {
                write!(s, ",{}", c.gauge[g][i] * 1e-6).unwrap();
            }
            for g in 0..4 {
                write!(s, ",{}", record.gauges[g].mean_mpa[i]).unwrap();
            }
            writeln!(
                s,
                ",{},{},{},{},{}",
                c.back_tension[i],
                c.front_tension[i],
                c.beam[i].to_degrees(),
                c.suspension[0][i],
                c.torque[i]
            )
            .unwrap();
        }
        std::fs::write(path, s).unwrap();
    }
}
