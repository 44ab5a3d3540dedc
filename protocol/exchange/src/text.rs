//! Decoding of text files, whatever program saved them.
use std::borrow::Cow;

/// Converts the bytes of a text file to text without a byte-order mark: UTF-8, UTF-16, or else Latin-1, the encoding of
/// older programs on Windows.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    if !is_utf16(bytes) {
        return utf8_or_latin1(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    }
    let is_big = matches!(bytes, [0xfe, 0xff, ..] | [0, ..]);
    let pairs = bytes.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
    let units = pairs.map(if is_big {
        u16::from_be_bytes
    } else {
        u16::from_le_bytes
    });
    let letters =
        char::decode_utf16(units).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER));
    let text: String = letters.collect();
    Cow::Owned(text.trim_start_matches('\u{feff}').to_owned())
}

/// Returns whether bytes begin a text in UTF-16, as spreadsheets write it: with its byte-order mark, or with zero bytes in
/// the first two characters.
pub const fn is_utf16(bytes: &[u8]) -> bool {
    matches!(
        bytes,
        [0xff, 0xfe, ..]
            | [0xfe, 0xff, ..]
            | [1..=255, 0, 1..=255, 0, ..]
            | [0, 1..=255, 0, 1..=255, ..]
    )
}

/// Converts bytes to text: UTF-8, or Latin-1 where they are not.
pub fn utf8_or_latin1(bytes: &[u8]) -> Cow<'_, str> {
    std::str::from_utf8(bytes).map_or_else(
        |_| Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()),
        Cow::Borrowed,
    )
}

#[cfg(test)]
mod tests {
    use super::decoded;

    #[test]
    fn every_usual_encoding_is_read() {
        for (bytes, text) in [
            ("µm".as_bytes(), "µm"),
            (b"\xef\xbb\xbfpcf", "pcf"),
            (b"\xb5m", "µm"),
            (b"\xff\xfea\0b\0", "ab"),
            (b"\xfe\xff\0a\0b", "ab"),
            (b"a\0b\0c\0", "abc"),
            (b"", ""),
        ] {
            assert_eq!(decoded(bytes), text);
        }
    }
}
