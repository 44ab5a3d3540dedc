//! The discovery pipeline against a stand-in machine whose every simulation costs a fraction of a
//! millisecond, and against truths that know other laws than the pipeline does.
mod case;
mod machine;
mod strata;
mod survey;
mod trial;
mod truth;
