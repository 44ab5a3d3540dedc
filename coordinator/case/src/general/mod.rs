//! Cases of models that this program does not know: what is unknown and what is measured stands in
//! one general form, everything else travels to the workers as it is.
//!
//! ```toml
//! name = "test rig"                 # heads every report
//! records = "measured"              # or "synthetic"; measured unless stated
//!
//! [model]
//! kind = "oscillator"               # workers announce the kinds that they simulate
//! stop_mm = 30.0                    # everything else here is the model's: it travels as it is
//!
//! [[unknowns]]                      # in the order of every table
//! name = "stiffness"                # short, of letters, digits, `_` and `-`; typed on command lines
//! title = "stiffness of the spring" # in words; the name unless stated
//! symbol = "k"                      # the name unless stated
//! unit = "N/mm"                     # a word: nothing converts it
//! scale = "logarithmic"             # or "linear": what may be zero or negative
//! start = 6.0                       # the best guess; where searches begin
//! lower = 1.0                       # what is searched
//! upper = 40.0
//! trust = [-0.5, 0.5]               # optional: where models usually survive; decades about the start, on a
//!                                   # linear scale halves of the interval
//! prior = [4.0, 9.0]                # optional: 95 % lies within it; of a logarithmic scale as well
//!                                   # { value = 6.0, factor = 1.5 }: within value / factor and value x factor;
//!                                   # or { value = .., deviation = .. }, one standard deviation as in `trust`
//! absent = 0.0                      # optional: the value at which it does nothing; `start = absent` leaves it
//!                                   # out, for a diagnosis to suspect
//! fixed = true                      # optional: known, and not searched; needs no bounds
//! suspect = "leakage"               # optional, with `absent`: unknowns of one name are suspected together
//! difference = 0.01                 # optional: what differences move it by, a share of its value; on a linear
//!                                   # scale in its unit
//! tie = { to = "other", ratio = 1.0 }   # optional: always so many times another one; needs no start, no bounds
//!
//! [[conditions]]
//! name = "5hz"
//! held_out = true                   # optional: takes no part in any fit, and judges it
//! drive_hz = 5.0                    # everything else here is the model's
//!
//! [[channels]]                      # one per quantity and condition
//! name = "force"
//! title = "force on the foundation" # the name unless stated
//! unit = "N"
//! condition = "5hz"
//! abscissa = { name = "phase", unit = "deg", period = 360.0 }   # period: only where the curve begins anew
//! held_out = false                  # optional: as for a condition; or { from = 90.0, to = 180.0 }, a part of its record
//!                                   # that `identify` and `diagnose` do not fit (a calibration's errors are of all)
//! offset = "fixed"                  # optional: in place of the objective's, for this channel
//! noise = 0.05                      # standard deviation of one value; needed where nothing was repeated. Beside
//!                                   # repeated cycles their scatter counts, and at least half of this variance
//! correlation = 0.8                 # optional: of the noise, from one value to the next, where nothing was
//!                                   # repeated; unless stated, a diagnosis takes it from what the best model leaves
//! model_error = 0.02                # optional: no law of the model is better than this; adds to the noise
//! record = { file = "measured/5hz.csv", at = "phase_deg", column = "force_n", cycle = "cycle" }
//!                                   # weight = "COLUMN": factor of each value's difference; its noise is `noise`
//!                                   # over it. rows = { column = "COLUMN", is = "WORD" }: those rows alone
//!
//! [[channels]]                      # what is not measured says where it is computed
//! name = "velocity"
//! unit = "mm/s"
//! condition = "5hz"
//! abscissa = { name = "phase", unit = "deg", period = 360.0, points = { first = 0.0, step = 3.0, count = 120 } }
//!
//! [objective]                       # what a calibration minimises: weighted mean squared errors
//! condition = "5hz"                 # or ["5hz", "9hz"]: every individual is simulated under each, and their
//!                                   # sums are added up; `identify` and `diagnose` fit the first of them, and
//!                                   # the others judge
//! terms = [{ channel = "force", weight = 1.0 }]   # of every condition that has such a channel
//! offset = "free"                   # sensors without an absolute zero; or "fixed": then constants count,
//!                                   # and a channel may be a single number
//! ```
//!
//! `[[effects]]` are those of every case. A record is a table in CSV, gzipped if it ends in `.gz`: one
//! row per place, cycles one after the other, each at the same places, with their number in the column
//! `cycle`; without that column there is one cycle.
mod channels;
mod conditions;
mod file;
mod objective;
mod read;
mod record;
mod rows;
mod unknowns;

pub use read::read;
