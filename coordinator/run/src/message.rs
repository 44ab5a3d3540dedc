//! Messages on standard error: progress, notes and warnings. Results go to standard output.
use journal::{Damage, describe_damage};
use std::{
    fmt,
    io::{self, Write as _},
};

/// Prints a message on standard error, followed by the end of the line; who no longer listens misses it.
pub fn print(text: &str) {
    let _gone = writeln!(io::stderr().lock(), "{text}");
}

/// Prints notes on standard error, one line each.
pub fn print_notes(notes: &[impl fmt::Display]) {
    for note in notes {
        print(&format!("note: {note}"));
    }
}

/// Prints on standard error which stretches of a journal cannot be read.
pub fn print_damage(stretches: &[Damage]) {
    for stretch in describe_damage(stretches) {
        print(&format!("warning: {stretch}"));
    }
}
