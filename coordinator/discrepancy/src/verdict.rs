//! Verdict of a diagnosis as a total function of the results of its tests.
use serde::{Deserialize, Serialize};

/// Verdict of a diagnosis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No test rejects: the residual is noise, down to the detection limits.
    NothingDetected,
    /// One effect explains the residual, and every rival is rejected.
    Named,
    /// One of several effects explains the residual; the record cannot tell which.
    Ambiguous,
    /// Something acts that is not in the library; a probe force at a joint describes it best.
    Unlisted,
    /// Disagreement or fit that this record cannot resolve; the reason is given.
    Unresolved,
}

/// Validity of the assumptions on which the tests rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TestValidity {
    /// The tests are valid: fit converged, discretisation fine enough, noise estimated from cycles.
    Valid,
    /// The noise is only stated: the tests are valid as far as the statement is right.
    NoiseStated,
    /// The noise is neither estimated from cycles nor stated: the tests are not valid.
    NoiseUnknown,
    /// No effect of the library considered: nothing can be named or called unlisted.
    NothingConsidered,
    /// Discretisation error of the simulated curves is unknown, so that the tests are not valid.
    DiscretisationUnknown,
}

/// Results of the tests of a diagnosis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Findings {
    /// Validity of the assumptions on which the tests rest.
    pub ground: TestValidity,
    /// Whether any family of tests rejects the hypothesis that the residual is noise alone.
    pub rejected: bool,
    /// Number of added effects, each supported by the evidence and more than a trace.
    pub added: usize,
    /// Number of effects in the largest ambiguity set of an added effect.
    pub rivals: usize,
    /// Whether a probe force (without a physical cause) explains the residual better than every listed
    /// effect.
    pub probe_force_wins: bool,
}

/// Returns the verdict for the findings. Every combination has a verdict, and a rejection never yields
/// "nothing detected".
pub const fn verdict(findings: &Findings) -> Verdict {
    let something = findings.rejected || findings.added > 0 || findings.probe_force_wins;
    let firm = matches!(
        findings.ground,
        TestValidity::Valid | TestValidity::NoiseStated
    );
    if matches!(findings.ground, TestValidity::DiscretisationUnknown) || (something && !firm) {
        return Verdict::Unresolved;
    }
    if !something {
        return Verdict::NothingDetected;
    }
    if findings.probe_force_wins {
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
            TestValidity::Valid,
            TestValidity::NoiseStated,
            TestValidity::NoiseUnknown,
            TestValidity::NothingConsidered,
            TestValidity::DiscretisationUnknown,
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
                                probe_force_wins: generic,
                            });
                            if rejected || added > 0 || generic {
                                assert_ne!(said, Verdict::NothingDetected);
                            }
                            if ground == TestValidity::DiscretisationUnknown {
                                assert_eq!(said, Verdict::Unresolved);
                            }
                            if !matches!(ground, TestValidity::Valid | TestValidity::NoiseStated) {
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
