//! What a diagnosis says: a total function of its tests.
use serde::Serialize;

/// The answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No test rejects: what remains is noise, down to the detection limits.
    NothingDetected,
    /// One effect explains it, and every rival is rejected.
    Named,
    /// One of several effects explains it; the record cannot tell which.
    Ambiguous,
    /// Something acts that is not in the library; a form of force at a joint describes it best.
    Unlisted,
    /// There is a disagreement, or a fit, that this record cannot resolve; the reason is given.
    Unresolved,
}

/// What the tests stand on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// The fit converged, the model is fine enough, the noise was seen: tests mean what they say.
    Firm,
    /// The noise is stated, not seen: tests mean what they say as far as the statement is right.
    NoiseStated,
    /// The noise was neither seen nor stated.
    NoiseUnknown,
    /// Not one effect of the library was considered: nothing can be named, and nothing is unlisted.
    NothingConsidered,
    /// How far the discretisation moves the curves is not known.
    Unsound,
}

/// What the tests of a diagnosis found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Findings {
    /// What they stand on.
    pub ground: Ground,
    /// Some family of tests rejects.
    pub rejected: bool,
    /// Effects that were added, each believed and worth it.
    pub added: usize,
    /// Members of the largest ambiguity set among the added effects.
    pub rivals: usize,
    /// A form of force without a cause beats every name.
    pub generic: bool,
}

/// The verdict of findings. Every combination has one, and a rejection is never "nothing".
pub const fn verdict(findings: &Findings) -> Verdict {
    let something = findings.rejected || findings.added > 0 || findings.generic;
    let firm = matches!(findings.ground, Ground::Firm | Ground::NoiseStated);
    if matches!(findings.ground, Ground::Unsound) || (something && !firm) {
        return Verdict::Unresolved;
    }
    if !something {
        return Verdict::NothingDetected;
    }
    if findings.generic {
        return Verdict::Unlisted;
    }
    match (findings.added, findings.rivals) {
        (0, _) => Verdict::Unresolved,
        (_, 0 | 1) => Verdict::Named,
        _ => Verdict::Ambiguous,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_has_a_verdict_and_a_rejection_is_never_nothing() {
        let flags = [false, true];
        let grounds = [
            Ground::Firm,
            Ground::NoiseStated,
            Ground::NoiseUnknown,
            Ground::NothingConsidered,
            Ground::Unsound,
        ];
        for ground in grounds {
            for rejected in flags {
                for generic in flags {
                    for added in 0..4 {
                        for rivals in 0..5 {
                            let said = verdict(&Findings {
                                ground,
                                rejected,
                                added,
                                rivals,
                                generic,
                            });
                            if rejected || added > 0 || generic {
                                assert_ne!(said, Verdict::NothingDetected);
                            }
                            if ground == Ground::Unsound {
                                assert_eq!(said, Verdict::Unresolved);
                            }
                            if !matches!(ground, Ground::Firm | Ground::NoiseStated) {
                                let quiet = [Verdict::NothingDetected, Verdict::Unresolved];
                                assert!(quiet.contains(&said), "{ground:?} {said:?}");
                            }
                        }
                    }
                }
            }
        }
    }
}
