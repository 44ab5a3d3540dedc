//! Forces without a cause: what the identifier of such an effect, `probe.JOINT.FORM`, says of its form.

/// The form: the last part of the identifier.
pub fn form(id: &str) -> &str {
    id.rsplit_once('.').map_or(id, |(_, form)| form)
}

/// Whether a periodic force is a sine.
pub fn is_sine(id: &str) -> bool {
    form(id).starts_with("sin")
}

/// The order of a periodic force, whose form is `cosH`, `sinH` or `const`.
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

/// The order of a harmonic of the period; nothing for a constant.
pub fn harmonic(id: &str) -> Option<usize> {
    order(id).filter(|order| *order > 0)
}
