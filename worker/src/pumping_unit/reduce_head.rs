//! Modal reduction of a back head, requested by a job; mesh and result are plain data, and no case is needed.
use protocol::pumping_unit::{Influence, TwinHead};
use protocol::{
    job::Failure,
    pumping_unit::{
        ElementKind, HeadFields, HeadMode, HeadSurface, ModeFamily, OmittedMode, ReduceHeadSpec,
        ReducedHead, RopeWrap,
    },
};
use simulation::flexible::{
    self, Family, Gauge, Mesh, Pair, Reduction, ReductionRequest, Steel, SurfaceLoads, SwayTables,
    Wrap, reduce,
};
use std::time::Instant;

const MEGAPASCAL_PER_PASCAL: f64 = 1e-6;

/// Runs the modal reduction of a back head.
///
/// # Errors
/// [`Failure::Misconfigured`] saying why the mesh cannot be reduced.
pub(super) fn run(spec: &ReduceHeadSpec) -> Result<ReducedHead, Failure> {
    check(spec)?;
    let mesh = mesh(spec);
    let gauges = spec.gauges.map(|gauge| Gauge {
        position: gauge.position_m,
        direction: gauge.direction,
        length: gauge.length_m,
    });
    let radians = |degrees: &[f64]| degrees.iter().map(|x| x.to_radians()).collect::<Vec<f64>>();
    let families: Vec<Family> = spec.families.iter().map(|f| family(*f)).collect();
    let wrap = |wrap: RopeWrap| Wrap {
        tension: wrap.tension_n,
        anchor: wrap.anchor_deg.to_radians(),
        leaves: wrap.leaves_deg.to_radians(),
    };
    let asked = spec.surface.as_ref().map(|own| {
        let returned: Vec<usize> = own.returned.iter().map(|&load| load as usize).collect();
        (radians(&own.breaks_deg), returned)
    });
    let started = Instant::now();
    let reduction = reduce(&ReductionRequest {
        mesh: &mesh,
        steel: Steel {
            young: spec.young_pa,
            poisson: spec.poisson,
            density: spec.density_kg_m3,
        },
        gauges: &gauges,
        center: spec.center_m,
        stations: &radians(&spec.arc_deg),
        probes: &radians(&spec.probes_deg),
        wrap: Some(wrap(spec.wrap)),
        patterns: &spec.patterns.iter().copied().map(wrap).collect::<Vec<_>>(),
        pair: spec.pair.map(|pair| Pair {
            offset: pair.offset_m,
            modes: pair.modes,
        }),
        modes: spec.modes,
        families: &families,
        surface: asked
            .as_ref()
            .map(|(breaks, returned)| SurfaceLoads { breaks, returned }),
        fields: spec.fields,
    })
    .map_err(|error| Failure::misconfigured("flexible_head", error.to_string()))?;
    let wall_s = started.elapsed().as_secs_f64();
    Ok(assemble(spec, &reduction, wall_s))
}

/// Checks the numbers of a request and refuses those with which no reduction is possible.
fn check(spec: &ReduceHeadSpec) -> Result<(), Failure> {
    let positive = [
        ("young_pa", spec.young_pa),
        ("density_kg_m3", spec.density_kg_m3),
        (
            "gauges.length_m",
            spec.gauges
                .iter()
                .map(|g| g.length_m)
                .fold(f64::MAX, f64::min),
        ),
    ];
    for (field, value) in positive {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Failure::misconfigured(
                field,
                format!("is {value}; it must be a positive number"),
            ));
        }
    }
    if !(0.0..0.5).contains(&spec.poisson) {
        return Err(Failure::misconfigured(
            "poisson",
            format!("is {}; it must be 0 to below 0.5", spec.poisson),
        ));
    }
    if let Some(pair) = &spec.pair
        && !(pair.offset_m > 0.0 && pair.offset_m.is_finite())
    {
        return Err(Failure::misconfigured(
            "pair.offset_m",
            format!("is {}; it must be a positive number", pair.offset_m),
        ));
    }
    for gauge in &spec.gauges {
        let square: f64 = gauge.direction.iter().map(|x| x * x).sum();
        if !((square - 1.0).abs() < 1e-6 && gauge.position_m.iter().all(|x| x.is_finite())) {
            return Err(Failure::misconfigured(
                "gauges",
                "a gauge needs a finite position and a direction of length 1",
            ));
        }
    }
    if spec.modes == 0 || spec.families.is_empty() {
        return Err(Failure::misconfigured(
            "modes",
            "ask for at least one mode of at least one family",
        ));
    }
    Ok(())
}

const fn family(family: ModeFamily) -> Family {
    match family {
        ModeFamily::Symmetric => Family::Symmetric,
        ModeFamily::Antisymmetric => Family::Antisymmetric,
    }
}

const fn mode_family(family: Family) -> ModeFamily {
    match family {
        Family::Symmetric => ModeFamily::Symmetric,
        Family::Antisymmetric => ModeFamily::Antisymmetric,
    }
}

fn mesh(spec: &ReduceHeadSpec) -> Mesh {
    let indices = |nodes: &[u32]| nodes.iter().map(|&node| node as usize).collect();
    Mesh {
        nodes: spec.mesh.nodes_m.clone(),
        kind: match spec.mesh.kind {
            ElementKind::Hexahedron => flexible::ElementKind::Hexahedron,
            ElementKind::Tetrahedron => flexible::ElementKind::Tetrahedron,
        },
        elements: indices(&spec.mesh.elements),
        held: indices(&spec.mesh.held),
        rope_faces: indices(&spec.mesh.rope_surface),
        half: spec.mesh.half,
    }
}

/// Converts the readings of four gauges from pascals to megapascals.
fn four(pascal: &[f64]) -> [f64; 4] {
    let mut four = [0.0; 4];
    for (to, from) in four.iter_mut().zip(pascal) {
        *to = from * MEGAPASCAL_PER_PASCAL;
    }
    four
}

/// Converts the gradients of four gauges from pascals to megapascals per metre.
fn gradient(pascal: &[[Option<f64>; 3]]) -> [[Option<f64>; 3]; 4] {
    let mut four = [[None; 3]; 4];
    for (to, from) in four.iter_mut().zip(pascal) {
        *to = from.map(|own| own.map(|x| x * MEGAPASCAL_PER_PASCAL));
    }
    four
}

/// Converts a table of readings of four gauges from pascals to megapascals.
fn table(rows: &[Vec<f64>]) -> Vec<[f64; 4]> {
    rows.iter().map(|row| four(row)).collect()
}

fn twin(spec: &ReduceHeadSpec, sway: &SwayTables) -> TwinHead {
    let hertz = |frequency: &f64| frequency / std::f64::consts::TAU;
    TwinHead {
        frequencies_hz: sway.frequencies.iter().map(hertz).collect(),
        radial: sway.radial.clone(),
        tangential: sway.tangential.clone(),
        lateral: sway.lateral.clone(),
        gauge_stress_mpa: table(&sway.gauge_stress),
        influence: Influence {
            psi_deg: spec.arc_deg.clone(),
            normal_mpa_per_n: table(&sway.normal_influence),
            tangential_mpa_per_n: table(&sway.tangential_influence),
        },
        lateral_mpa_per_n: table(&sway.lateral_influence),
    }
}

fn assemble(spec: &ReduceHeadSpec, reduction: &Reduction, wall_s: f64) -> ReducedHead {
    let hertz = |frequency: f64| frequency / std::f64::consts::TAU;
    let modes = reduction.modes.iter().map(|mode| HeadMode {
        family: mode_family(mode.family),
        frequency_hz: hertz(mode.frequency),
        radial: mode.radial.clone(),
        tangential: mode.tangential.clone(),
        gauge_stress_mpa: four(&mode.gauge_stress),
        participation: mode.participation,
        coupling: mode.coupling,
    });
    let left_out = reduction.left_out.iter().map(|mode| OmittedMode {
        family: mode_family(mode.family),
        frequency_hz: hertz(mode.frequency),
        coupling: mode.coupling,
    });
    ReducedHead {
        modes: modes.collect(),
        left_out: left_out.collect(),
        influence: Influence {
            psi_deg: spec.arc_deg.clone(),
            normal_mpa_per_n: table(&reduction.normal_influence),
            tangential_mpa_per_n: table(&reduction.tangential_influence),
        },
        inertia_stress_mpa: reduction.inertia_stress.each_ref().map(|row| four(row)),
        twin: reduction.sway.as_ref().map(|sway| twin(spec, sway)),
        wrap_stress_mpa: four(&reduction.wrap_reading),
        wrap_gradient_mpa_per_m: gradient(&reduction.wrap_gradient),
        compliance_m_per_n: reduction.compliance.clone(),
        mass_kg: reduction.mass,
        center_of_mass_m: reduction.center_of_mass,
        inertia_about_pivot_kg_m2: reduction.inertia,
        unknowns: reduction.unknowns,
        lanczos_steps: reduction.lanczos_steps,
        wall_s,
        surface: reduction.surface.as_ref().map(surface),
        fields: spec.fields.then(|| fields(reduction)),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "pictures need no more than single precision"
)]
fn fields(reduction: &Reduction) -> HeadFields {
    let single = |field: &[[f64; 3]]| field.iter().map(|u| u.map(|x| x as f32)).collect();
    HeadFields {
        modes: reduction.modes.iter().map(|m| single(&m.field)).collect(),
        wrap_m: single(&reduction.wrap_field),
        wrap_stress_mpa: reduction
            .wrap_stress
            .iter()
            .map(|stress| stress.map(|s| (s * MEGAPASCAL_PER_PASCAL) as f32))
            .collect(),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a mesh of four billion nodes does not fit into memory, and finite elements are no better than single precision"
)]
fn surface(surface: &flexible::SurfaceStress) -> HeadSurface {
    let points = || surface.points.iter();
    let stress = |stress: &[f64; 6]| stress.map(|s| (s * MEGAPASCAL_PER_PASCAL) as f32);
    let of_load = |load: &Vec<[f64; 6]>| load.iter().map(stress).collect();
    HeadSurface {
        places_m: points().map(|point| point.place).collect(),
        normals: points()
            .map(|point| point.normal.map(|x| x as f32))
            .collect(),
        held: points().map(|point| point.held).collect(),
        faces: surface
            .faces
            .iter()
            .map(|face| face.map(|k| k as u32))
            .collect(),
        stress_mpa: surface.stress.iter().map(of_load).collect(),
    }
}
