//! Cases of models that are programs of the user's own: the kind `command`.
//!
//! ```toml
//! [model]
//! kind = "command"
//! entry = "decay"                         # name of the entry in the machine's allow list of programs
//! command = ["python3", "model.py"]       # optional: command that `horsehead allow` proposes for the allow list
//! version = ["python3", "--version"]      # optional: command whose output must be equal on all machines of a run;
//!                                         # `horsehead allow` proposes it as well
//! files = ["model.py", "tables"]          # optional: files and folders beside this file that are sent to the workers
//! deadline_s = 60.0                       # maximum duration of one run of the program
//! repeatable = false                      # optional: whether equal inputs give bit-identical outputs on all machines
//! reference_tolerance = 1e-3              # optional, if not repeatable: allowed deviation of a machine's outputs at
//!                                         # the start values from the first machine's, as a share of each channel's
//!                                         # root mean square
//! verdicts = { 3 = "diverged" }           # optional: exit statuses that are caused by the parameter values; such
//!                                         # runs are not repeated
//! inputs = [
//!     { file = "model.in", template = "model.tpl" },     # PEST template
//!     { file = "job.txt", braces = "job.txt.in" },       # text with placeholders {name}
//!     { file = "params.in", dakota = "standard" },       # Dakota parameters file: standard, aprepro, json
//!     { file = "params.in", dakota = "json", components = ["mesh.exo"] },  # the same with analysis components
//! ]
//! outputs = [
//!     { file = "model.out", instructions = "model.ins" },  # PEST instruction file: named values
//!     { file = "results.out", dakota = ["w1", "w2"] },     # Dakota results file: named values
//!     { file = "results.out", dakota = ["w1"], gradients = true },  # the same with their gradients where requested
//!     { file = "curve.csv" },                              # table with a header
//!     { file = "curve.json" },                             # JSON object
//! ]
//! # optional: values that are computed from the parameters alone, as PEST's prior information
//! equations = [{ name = "belief", terms = [{ parameter = "young", factor = 1.0, log = true }] }]
//! # optional: name, factor and offset with which an unknown is written, if not its own name and value
//! parameters = { load = { name = "Q", factor = -1.0, offset = 0.0 } }
//!
//! [[conditions]]
//! name = "slow"
//! values = { speed = 5.0 }                # optional: values for the templates in addition to the unknowns
//!
//! [[channels]]                            # as in every case, with the source of its values, one of:
//! source = { file = "curve.csv", column = "force_n", at = "time_s" }   # interpolated at the record's points
//! source = { file = "curve.json", values = "/force", at = "/time" }    # the same for JSON
//! source = { named = ["w1", "w2"] }                                    # one named value per abscissa point
//! ```
mod allow;
mod assemble;
mod field_width;
mod file;
mod files;
pub mod import;
pub(crate) mod kind;
mod parameters;

pub use allow::{EntryProposal, propose_entry};
