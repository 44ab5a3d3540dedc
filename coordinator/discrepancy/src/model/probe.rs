//! Parsing of the identifiers `probe.JOINT.FORM` of probe forces, that is of forces at a joint without a
//! physical cause.

/// Returns the form of a probe force, e.g. `sin2`: the last part of its identifier.
pub fn form(id: &str) -> &str {
    id.rsplit_once('.').map_or(id, |(_, form)| form)
}

/// Returns whether the probe force with an identifier is a sine of the period's phase.
pub fn is_sine(id: &str) -> bool {
    form(id).starts_with("sin")
}

/// Returns the order of a periodic probe force, whose form is `cosH`, `sinH` or `const`.
pub fn order(id: &str) -> Option<usize> {
    let form = form(id);
    if form == "const" {
        return Some(0);
    }
    let digits = form
        .strip_prefix("cos")
        .or_else(|| form.strip_prefix("sin"))?;
    digits.parse().ok()
}

/// Returns the order of a harmonic probe force; `None` for a constant.
pub fn harmonic(id: &str) -> Option<usize> {
    order(id).filter(|order| *order > 0)
}
