//! `horsehead head`: reduction of the flexible back head from its mesh.
mod files;
mod output;
mod reduce_head;

use crate::cli::{
    argument::{case::case_folder, individual::condition, output::OutputChoice},
    output::{problem::EXIT_CODES, terminal},
};
use anyhow::Context as _;
use case::pumping_unit::{
    HeadSource, QuasiStaticTurn, compare_head, load_head, mesh, quasi_static, wrapped_turn,
};
use clap::{Args, ValueEnum};
use protocol::pumping_unit::{
    HeadMesh, Machine, ModeFamily, PumpingUnit, ReduceHeadSpec, ReducedHead, RopePair, RopeWrap,
    SurfaceRequest,
};
use reduce_head::{MEBIBYTE, ROOM};
pub(in crate::cli::command) use reduce_head::{reduce_head, surface_stress};
use report::pumping_unit::{
    HeadPicture, head_gauges, head_mode_table, head_pair, head_statics, write_head_modes,
};
use report::table;
use run::{message, session::temporary::with_temporary_run};
use std::path::PathBuf;
use support::Problem;

/// Reduce the flexible back head from its mesh: modes, influence lines, gauge stress.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead head cases/cyjs10-5-37hb --out pictures
  horsehead head cases/cyjs10-5-37hb --family both --modes 24 --vtu pictures
  horsehead head my-case --write

{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// Case folder, with `case.toml` in it.
    #[arg(value_name = "CASE", value_parser = case_folder)]
    case: PathBuf,
    /// How many modes; as many as the case simulates by default.
    #[arg(long, value_name = "N", env = "HORSEHEAD_MODES")]
    modes: Option<usize>,
    /// Which modes: those that couple most to the loads of a turn, or the lowest of a family. A rope
    /// over the whole width drives only symmetric ones.
    #[arg(long, value_enum, default_value = "coupled", env = "HORSEHEAD_FAMILY")]
    family: FamilyChoice,
    /// Condition whose load is used for the quasi-static turn of the crank; that of the objective by default.
    #[arg(long, value_name = "NAME", env = "HORSEHEAD_CONDITION")]
    condition: Option<String>,
    /// Replace the case's modes file and influence file, and of a case with twin ropes the head's
    /// tables for them.
    #[arg(long, env = "HORSEHEAD_WRITE")]
    write: bool,
    /// Folder for `head.vtu`: all modes, and displacement and stress under the largest tension.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_VTU")]
    vtu: Option<PathBuf>,
    /// Folder for `head_modes.svg`: the rope arc's deflection in every mode.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_OUT")]
    out: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Families of modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FamilyChoice {
    /// Modes of both families that couple most to the wrapped rope and to the beam's motion.
    Coupled,
    /// Symmetric modes: the sideways displacement changes sign across the head's middle plane.
    Symmetric,
    /// Antisymmetric modes: the displacement in the plane of motion changes sign across the head's middle
    /// plane.
    Antisymmetric,
    /// Lowest modes of both families.
    Both,
}

impl FamilyChoice {
    fn families(self) -> Vec<ModeFamily> {
        match self {
            Self::Symmetric => vec![ModeFamily::Symmetric],
            Self::Antisymmetric => vec![ModeFamily::Antisymmetric],
            Self::Coupled | Self::Both => vec![ModeFamily::Symmetric, ModeFamily::Antisymmetric],
        }
    }
}

/// Maximum number of modes of the head that may be requested; its mesh does not resolve higher ones.
const MOST_MODES: usize = 40;

/// Reduces the head, compares it with the tables of the case, and writes the requested files.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let (unit, source) = load_head(&arguments.case)?;
    let PumpingUnit { case, machine } = &unit;
    if source.stale {
        message::print(
            "note: the tables of the case are missing or were computed from other inputs (mesh, material, arc, stations or gauges); `--write` replaces them",
        );
    }
    let modes = arguments.modes.unwrap_or(machine.run.modes);
    if !(1..=MOST_MODES).contains(&modes) {
        return Err(Problem {
            message: format!("{modes} modes cannot be computed"),
            remedy: format!("ask for 1 to {MOST_MODES}"),
        }
        .into());
    }
    if arguments.write && modes < machine.run.modes {
        return Err(Problem {
            message: format!("the case simulates {} modes", machine.run.modes),
            remedy: "write at least as many, or lower run.modes in case.toml first".to_owned(),
        }
        .into());
    }
    let chosen = condition(case, arguments.condition.as_deref())?;
    let name = case.conditions[chosen].name.clone();
    let turn = quasi_static(machine, &machine.conditions[chosen])
        .context("the crank of this case cannot complete a revolution")?;
    let wrap = hardest(machine, &turn);
    let mut spec = spec(machine, &source, wrap, (modes, arguments.family.families()));
    if arguments.family == FamilyChoice::Coupled {
        spec.patterns = patterns(machine, &turn);
    }
    spec.fields = arguments.vtu.is_some();
    check_size(&spec)?;
    let head = reduce_once(unit.clone(), &spec)?;
    let wrapped = wrapped_turn(&turn, machine.back_head.rope_anchor_deg);
    let mut comparison = compare_head(&head, &machine.modal_head, &wrapped, machine.run.modes);
    if machine.modal_head.frequencies_hz.is_empty() {
        comparison.influence_difference = [f64::NAN; 4];
        comparison.half_ranges.table = [f64::NAN; 4];
    }
    let mut written = Vec::new();
    if let Some(folder) = &arguments.vtu {
        written.push(files::write_vtu(folder, &spec.mesh, &head)?);
    }
    if let Some(folder) = &arguments.out {
        let picture = picture(machine, &source, &head);
        written.push(write_head_modes(folder, &picture)?);
    }
    if arguments.write {
        written.extend(files::write_tables(
            machine,
            &source,
            (&head, wrap.tension_n),
        )?);
    }
    for path in &written {
        message::print(&format!("wrote {}", path.display()));
    }
    let distances_m = source.surface_distances_m();
    let object = output::object((case, &name), (&source, &distances_m), &head, &comparison);
    let tables = || {
        let style = terminal::style();
        let modes = table::text(&head_mode_table(&head, &comparison), style);
        let statics = head_statics(&comparison, &name, machine.run.modes);
        let gauges = head_gauges((&head, wrap.tension_n), &source.gauges, &distances_m);
        let pair = head.twin.iter().zip(&machine.twin_ropes);
        let pair = pair.map(|(twin, ropes)| head_pair(twin, ropes.offset_m));
        let pair = pair.map(|table| format!("\n{}", table::text(&table, style)));
        let pair: String = pair.collect();
        let [statics, gauges] = [statics, gauges].map(|own| table::text(&own, style));
        format!("{modes}\n{statics}\n{gauges}{pair}")
    };
    terminal::print(arguments.output.output, tables, &object)
}

fn picture<'a>(
    machine: &Machine,
    source: &'a HeadSource,
    head: &'a ReducedHead,
) -> HeadPicture<'a> {
    HeadPicture {
        center_m: [machine.back_head.center_x_m, machine.back_head.center_y_m],
        radius_m: machine.back_head.radius_m,
        nodes_m: &source.mesh.nodes_m,
        pins: ["pin_a", "pin_b"].map(|pin| surface(&source.mesh, pin)),
        gauges: &source.gauges,
        arc_deg: &head.influence.psi_deg,
        modes: &head.modes,
    }
}

/// Returns the nodes of a named surface of the mesh; empty if the mesh lacks it.
fn surface<'a>(read: &'a mesh::Mesh, name: &str) -> &'a [usize] {
    read.surfaces.get(name).map_or(&[], Vec::as_slice)
}

/// Returns the wrap of the rope on the back head (tension and contact arc) at the largest rope tension of a
/// revolution.
fn hardest(machine: &Machine, turn: &QuasiStaticTurn) -> RopeWrap {
    let wraps = wraps(machine, turn);
    let most = wraps.max_by(|a, b| a.tension_n.total_cmp(&b.tension_n));
    most.unwrap_or(RopeWrap {
        tension_n: 0.0,
        anchor_deg: machine.back_head.rope_anchor_deg,
        leaves_deg: machine.back_head.rope_anchor_deg,
    })
}

/// Returns the rope wraps with the smallest, median and largest contact arc of a revolution, as load patterns
/// for the selection of coupled modes.
fn patterns(machine: &Machine, turn: &QuasiStaticTurn) -> Vec<RopeWrap> {
    let mut wraps: Vec<RopeWrap> = wraps(machine, turn).collect();
    wraps.sort_by(|a, b| a.leaves_deg.total_cmp(&b.leaves_deg));
    let last = wraps.len().saturating_sub(1);
    let places = [0, last / 2, last];
    places
        .iter()
        .filter_map(|k| wraps.get(*k))
        .copied()
        .collect()
}

/// Returns the wrap of the rope on the back head (tension and contact arc) at every crank angle of the
/// quasi-static revolution.
fn wraps(machine: &Machine, turn: &QuasiStaticTurn) -> impl Iterator<Item = RopeWrap> {
    let anchor_deg = machine.back_head.rope_anchor_deg;
    let places = turn.tension_n.iter().zip(&turn.contact_deg);
    places.map(move |(&tension_n, &leaves_deg)| RopeWrap {
        tension_n,
        anchor_deg,
        leaves_deg,
    })
}

/// Builds the job that reduces the head of a case; the influence lines are sampled at the arc stations of the
/// case's present tables, or at those that its geometry needs.
fn spec(
    machine: &Machine,
    source: &HeadSource,
    wrap: RopeWrap,
    (modes, families): (usize, Vec<ModeFamily>),
) -> ReduceHeadSpec {
    ReduceHeadSpec {
        mesh: mesh(&source.mesh),
        young_pa: source.young_pa,
        poisson: source.poisson,
        density_kg_m3: source.density_kg_m3,
        gauges: source.gauges,
        center_m: [machine.back_head.center_x_m, machine.back_head.center_y_m],
        arc_deg: machine.modal_head.arc_deg.clone(),
        probes_deg: Vec::new(),
        modes,
        families,
        patterns: Vec::new(),
        pair: machine.twin_ropes.as_ref().map(|twins| RopePair {
            offset_m: twins.offset_m,
            modes: twins.modes,
        }),
        wrap,
        surface: None,
        fields: false,
    }
}

/// Number of modes, times those that are simulated, among which the simulated ones are sought.
const SOUGHT: usize = 4;

/// Builds the job that reduces the head of a case to its lowest symmetric modes, with its surface, whose stress is
/// requested apart ([`surface_stress`]). The rope drives no other modes; the simulated ones are among them.
///
/// # Errors
/// If the crank cannot complete a revolution, or the answer would not fit into one message.
pub(super) fn surface_spec(
    unit: &PumpingUnit,
    source: &HeadSource,
) -> anyhow::Result<ReduceHeadSpec> {
    let PumpingUnit { case, machine } = unit;
    let turn = quasi_static(machine, &machine.conditions[case.objective.condition])
        .context("the crank of this case cannot complete a revolution")?;
    let modes = (SOUGHT * machine.run.modes).min(MOST_MODES);
    let wrap = hardest(machine, &turn);
    let spec = ReduceHeadSpec {
        surface: Some(SurfaceRequest {
            breaks_deg: machine.load_breaks_deg(),
            returned: Vec::new(),
        }),
        ..spec(machine, source, wrap, (modes, vec![ModeFamily::Symmetric]))
    };
    check_size(&spec)?;
    Ok(spec)
}

/// Converts the head's mesh into the form sent to a worker.
fn mesh(read: &mesh::Mesh) -> HeadMesh {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a mesh of four billion nodes does not fit into memory"
    )]
    let indices = |nodes: &[usize]| nodes.iter().map(|&node| node as u32).collect::<Vec<u32>>();
    let mut held = [surface(read, "pin_a"), surface(read, "pin_b")].concat();
    held.sort_unstable();
    held.dedup();
    let elements = read.volumes.get(mesh::VOLUME);
    HeadMesh {
        nodes_m: read.nodes_m.clone(),
        kind: read.kind,
        elements: indices(elements.map_or(&[], Vec::as_slice)),
        held: indices(&held),
        rope_surface: indices(surface(read, "rope_surface")),
        half: read.half,
    }
}

/// Checks that the head reduction job and its answer each fit into one message.
fn check_size(spec: &ReduceHeadSpec) -> Result<(), Problem> {
    let (nodes, elements) = (
        spec.mesh.nodes_m.len(),
        spec.mesh.elements.len() / spec.mesh.kind.nodes(),
    );
    let too_long = |what: &str, help: String| Problem {
        message: format!(
            "{what} of a mesh of {nodes} nodes and {elements} elements is more than the {} MiB \
             that travel in one message",
            ROOM / MEBIBYTE
        ),
        remedy: help,
    };
    // positions of 24 bytes, numbers of at most 5
    let there = 24 * nodes + 5 * (spec.mesh.elements.len() + spec.mesh.rope_surface.len());
    if there > ROOM {
        let half = "use a coarser mesh, or mesh only the half z >= 0 (physical group `symmetry`)";
        return Err(too_long("the description", half.to_owned()));
    }
    let field = size_of::<[f32; 3]>() * nodes;
    let stress = size_of::<[f32; 6]>() * elements;
    let fields = (spec.modes + 1) * field + stress;
    if spec.fields && fields > ROOM {
        let most = ROOM.saturating_sub(stress + field) / field.max(1);
        let help = format!("ask for at most {most} modes with --vtu (--modes {most})");
        return Err(too_long(&format!("--vtu with {} modes", spec.modes), help));
    }
    Ok(())
}

/// Reduces the head on one local worker in a temporary run folder.
fn reduce_once(mut unit: PumpingUnit, spec: &ReduceHeadSpec) -> anyhow::Result<ReducedHead> {
    // a worker builds the machine first: not with tables that are yet to come
    unit.machine.twin_ropes = None;
    let known = unit.machine.modal_head.frequencies_hz.len();
    unit.machine.run.modes = unit.machine.run.modes.min(known);
    with_temporary_run(&unit.into_case()?, "head", 1, async |dispatch, stop| {
        reduce_head(dispatch, spec, stop).await
    })
}
