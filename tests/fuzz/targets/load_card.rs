//! Load cards as people write them: one turn of finite loads, or refused in words.
#![no_main]
use coordinator::case::read_card;
use fuzz::file;
use libfuzzer_sys::fuzz_target;
use protocol::pumping_unit::Smoothing;

fuzz_target!(|bytes: &[u8]| {
    match read_card(&file("card.csv", bytes), Smoothing::None, "a card") {
        Ok(card) => {
            assert!(card.turn_deg.len() >= 24 && card.turn_deg.len() == card.load_n.len());
            assert!(card.load_n.iter().all(|load| load.is_finite()));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
