//! Acceptance test of the value of more data: the pairs of effects that a record cannot tell apart.
use crate::trial::{diagnose_usual, say};
use crate::truth::Truth;

/// Checks that a time shift of the card and a lag of the load cell are the only pair that cannot be told
/// apart. To first order a lag is a shift in time, and the stand-in machine's load has few harmonics, so more
/// cycles do not help. Another crank speed does: there a shift in time is another angle, and a lag another
/// gain.
#[test]
fn a_late_card_and_a_lagging_cell_look_alike_and_nothing_else_does() {
    let answer = diagnose_usual(&Truth::healthy(7100));
    say(&format!("look-alikes: {:?}", answer.look_alikes));
    let [pair] = answer.look_alikes.as_slice() else {
        panic!("{:?}", answer.look_alikes);
    };
    assert_eq!(pair.effects, ["card_time_shift", "load_cell_lag"]);
    assert!(pair.cycles > 100.0, "{pair:?}");
    let both = pair.cycles_with_others.expect("a second record");
    assert!(both < 10.0, "{pair:?}");
}
