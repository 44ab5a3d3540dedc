//! A journal of sound records, damaged records and rubbish between them.
//!
//! The first byte of each stretch says whether its bytes become a record with mark and checksum;
//! the second how long it is. Whatever stands there, reading ends, every byte is accounted for, and
//! no sound record behind damage is missed.
#![no_main]
use coordinator::journal::{self, ReadReport};
use fuzz::{crc32, file};
use libfuzzer_sys::fuzz_target;
use protocol::{event::Event, wire};

fuzz_target!(|bytes: &[u8]| {
    let mut journal = Vec::new();
    let mut rest = bytes;
    while let [how, length, tail @ ..] = rest {
        let (body, behind) = tail.split_at(tail.len().min(usize::from(*length)));
        rest = behind;
        if how % 2 == 0 {
            let length = u32::try_from(body.len()).expect("at most 255").to_le_bytes();
            let mut checked = length.to_vec();
            checked.extend_from_slice(body);
            journal.extend_from_slice(&journal::MARK);
            journal.extend_from_slice(&length);
            journal.extend_from_slice(&crc32(&checked).to_le_bytes());
        }
        journal.extend_from_slice(body);
    }
    let path = file("journal.hhj", &journal);
    let mut sound = 0;
    let ReadReport { records, damage, end } = journal::fold(&path, |entry, event| {
        sound += u64::from(entry.length) + 12;
        let at = usize::try_from(entry.at).expect("short");
        let body = &journal[at..at + entry.length as usize];
        assert_eq!(wire::encode(&event).expect("can be encoded"), body);
        let _: Event = event;
    })
    .expect("damage is no error");
    let lost: u64 = damage.iter().map(|damage| damage.bytes).sum();
    assert_eq!(sound + lost, journal.len() as u64, "{records} records to {end}, {damage:?}");
});
