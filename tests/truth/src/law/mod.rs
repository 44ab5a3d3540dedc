//! Laws of the hidden effects, written independently of the effect library of the program under test.
//!
//! Effects that the program's library models as smooth, first-order or constant are hard, hysteretic, delayed
//! or load-dependent here. [`CATALOGUE`] lists effects that the library contains, with the size that machines
//! of this type typically have; [`UNLISTED`] lists effects that the library does not contain.
mod drive;
mod friction;
mod gauge;
mod kind;
mod load;
mod nuisance;
mod post;
mod rope;
mod structure;
mod unlisted;

pub use kind::{EffectKind, HiddenEffect, PlantedEffect, Shape};
pub use nuisance::{Nuisances, Tolerance};

use kind::{at_most, kind, signed};

/// Hidden effects that the library of the program under test also contains, with their typical sizes.
#[rustfmt::skip]
pub const CATALOGUE: [EffectKind; 24] = [
    at_most(3.0, kind("crank_speed_ripple", ("slip", "1"), 0.0267, drive::kloss)),
    signed(kind("crank_angle_offset", ("angle", "deg"), 2.0, drive::late_index)),
    kind("pivot_friction", ("moment", "N.m"), 1500.0, friction::plain_bearing),
    kind("stuffing_box_friction", ("force", "N"), 800.0, friction::packing),
    at_most(5.0, kind("rope_bending_loss", ("loss", "1"), 0.015, friction::winding)),
    at_most(8.0, kind("rope_hysteresis", ("share", "1"), 0.05, rope::wires)),
    at_most(6.0, kind("rope_toe", ("strain", "1"), 7.5e-4, rope::bedding)),
    at_most(4.0, signed(kind("rope_stretch", ("length", "m"), 0.02, rope::stretch))),
    at_most(8.0, signed(kind("twin_rope_inequality", ("length", "m"), 0.002, gauge::twins))),
    signed(kind("pin_clearance", ("step", "MPa"), 0.5, gauge::clearance)),
    at_most(5.0, signed(kind("card_time_shift", ("time", "s"), 0.1, load::late_card))),
    signed(kind("load_offset", ("force", "N"), 1000.0, load::unbalance)),
    at_most(3.0, kind("load_cell_lag", ("lag", "s"), 0.15, load::slow_logger)),
    at_most(4.0, kind("card_smoothing", ("window", "deg"), 15.0, load::moving_average)),
    at_most(1.2, kind("fluid_pound", ("held", "1"), 1.0, load::fluid_pound)),
    at_most(8.0, kind("amplifier_lag", ("lag", "s"), 0.05, gauge::delay)),
    signed(kind("gauge_drift", ("drift", "MPa/rev"), 0.5, gauge::warming)),
    at_most(4.0, kind("head_profile_wear", ("depth", "m"), 0.004, structure::worn_edge)),
    at_most(5.0, kind("post_compliance", ("compliance", "m/N"), 5e-8, post::sinking)),
    at_most(6.0, signed(kind("gauge_gain", ("gain", "1"), 0.05, gauge::gain))),
    at_most(6.0, signed(kind("gauge_cross_talk", ("into", "1"), 0.05, gauge::rotated))),
    at_most(4.0, signed(kind("front_head_radius", ("centre", "m"), 0.02, structure::front_arc))),
    at_most(4.0, kind("beam_inertia", ("share", "1"), 0.2, structure::carried)),
    at_most(3.0, kind("rod_string_reaction", ("impedance", "N.s/m"), 20500.0, load::rods)),
];

/// Effect that truncates the delivered pump load card to its first harmonics; its size is the number of
/// harmonics kept. A second form of `card_smoothing`, which is in [`CATALOGUE`] as a moving average.
pub const CUT_CARD: EffectKind = kind(
    "card_smoothing",
    ("harmonics", "1"),
    1.0,
    load::truncated_card,
);

/// Hidden effects that the library of the program under test does not contain.
#[rustfmt::skip]
pub const UNLISTED: [EffectKind; 8] = [
    signed(kind("saddle_cubic_spring", ("moment", "N.m"), 4000.0, unlisted::cubic_spring)),
    kind("beam_quadratic_drag", ("moment", "N.m"), 4000.0, unlisted::drag),
    kind("crosshead_harmonic", ("force", "N"), 1500.0, unlisted::crosshead),
    signed(kind("beam_gust", ("moment", "N.m"), 5000.0, unlisted::gust)),
    kind("loose_ballast", ("mass", "kg"), 150.0, unlisted::ballast),
    at_most(3.0, kind("tuned_mass", ("mass", "kg"), 300.0, unlisted::tuned_mass)),
    kind("carrier_bar_rub", ("force", "N"), 2000.0, unlisted::rub),
    at_most(3.0, kind("gear_eccentricity", ("angle", "deg"), 0.3, unlisted::gear)),
];

/// Returns the effect kind with the identifier `id`, from [`CATALOGUE`] or [`UNLISTED`].
pub fn by_id(id: &str) -> Option<EffectKind> {
    let all = CATALOGUE.iter().chain(&UNLISTED);
    all.copied().find(|kind| kind.id == id)
}

#[cfg(test)]
mod tests {
    use super::by_id;
    use crate::draw::RandomStream;

    #[test]
    fn sizes_are_what_was_asked_for() {
        let hidden = by_id("pivot_friction")
            .expect("in the catalogue")
            .instantiate(5.0, &mut RandomStream::new(1, "law"));
        assert!((hidden.size - 7500.0).abs() < 1e-9 && hidden.shape.len() == 2);
    }
}
