//! The discovery pipeline against a stand-in machine whose every simulation costs a fraction of a
//! millisecond, and against truths that know other laws than the pipeline does.
//!
//! Sizes are those of continuous integration; `HORSEHEAD_ACCEPTANCE=full` makes every stratum five
//! times as large. `cargo test -p discrepancy --test acceptance -- --nocapture` prints the rates.
mod case;
mod composed;
mod machine;
mod maps;
mod nothing;
mod robust;
mod single;
mod strata;
mod trial;
mod truth;
