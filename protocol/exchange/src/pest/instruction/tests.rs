//! Tests of every kind of instruction, and of files that do not match the instructions.
use super::Instructions;
use proptest::prelude::*;

fn read(instructions: &str, text: &str) -> Result<Vec<(String, f64)>, String> {
    let instructions =
        Instructions::parse("a.ins", instructions).map_err(|error| error.to_string())?;
    instructions
        .read("a.out", text)
        .map_err(|error| error.to_string())
}

fn values(instructions: &str, text: &str) -> Vec<f64> {
    let found = read(instructions, text).unwrap();
    found.into_iter().map(|(_, value)| value).collect()
}

#[test]
fn every_kind_of_instruction_finds_its_number() {
    let text = "title\n time   1.5 2.5D+00\n x= 3.5,4.5 end\nlast 123456\n";
    for (instructions, expected) in [
        ("pif @\n@time@ !a! !B!\n", vec![1.5, 2.5]),
        ("pif @\nl2 w w !a!\n", vec![1.5]),
        ("pif @\nl2 [a]8:11 (b)13:14\n", vec![1.5, 2.5]),
        ("pif @\n@time@\n& !dum! !b!\n", vec![2.5]),
        ("pif @\n@x=@ !a!@,@ !b! @end@\n", vec![3.5, 4.5]),
        ("pif @\nl1\nl2 t4 !a!\n", vec![3.5]),
        ("pif @\n@last@ [a]6:7 [b]8:9\n", vec![12.0, 34.0]),
    ] {
        assert_eq!(values(instructions, text), expected, "{instructions}");
    }
    assert_eq!(
        Instructions::parse("a", "pif @\nl1 !A! !dum! !b!\n")
            .unwrap()
            .observations(),
        ["a", "b"]
    );
}

/// Checks that the search continues after a line that contains the first marker but not the second, unless a
/// value was already read from that line.
#[test]
fn a_missing_second_marker_resumes_the_search() {
    let text = "sum 1\nsum of b 2\n";
    assert_eq!(values("pif @\n@sum@ @of b@ !a!\n", text), [2.0]);
    let error = read("pif @\n@sum@ !a! @of b@ !b!\n", text).unwrap_err();
    assert!(
        error.contains("line 2") && error.contains("a.out, line 1"),
        "{error}"
    );
}

#[test]
fn what_does_not_fit_is_said_with_both_lines() {
    for (instructions, text, words) in [
        ("pif @\nl3 !a!\n", "1\n2\n", "the end in a.out"),
        ("pif @\n@x@ !a!\n", "1\n2\n", "no line with `x`"),
        ("pif @\nl1 !a!\n", "NaN\n", "`NaN` in a.out, line 1"),
        ("pif @\nl1 !a! !b!\n", "1.5\n", "nothing in a.out"),
        ("pif @\nl1 [a]3:5\n", "1\n", "nothing"),
        ("pif @\nl1 !a!\n", "", "the end"),
        ("pif @\nl1 w !a!\n", "1\n", "no further word"),
        ("pif @\nl1 t9 !a!\n", "1\n", "column 9"),
        ("pif @\nl1 !a!\n", "1.2.3\n", "`1.2.3`"),
    ] {
        let error = read(instructions, text).unwrap_err();
        assert!(
            error.contains(words) && error.contains("a.ins, line 2"),
            "{error}"
        );
    }
}

#[test]
fn what_is_no_instruction_is_refused() {
    for (instructions, words) in [
        ("", "line 1"),
        ("ptf @\n", "line 1"),
        ("pif a\n", "line 1"),
        ("pif !\n", "line 1"),
        ("pif @\nw !a!\n", "line 2"),
        ("pif @\n& !a!\n", "line 2"),
        ("pif @\nl0 !a!\n", "line 2"),
        ("pif @\nl1 !a\n", "line 2"),
        ("pif @\nl1 [a]5:3\n", "line 2"),
        ("pif @\nl1 @x !a!\n", "line 2"),
        ("pif @\nl1 !a!\nl1 !A!\n", "line 3: `a` once more"),
    ] {
        let error = read(instructions, "").unwrap_err();
        assert!(error.contains(words), "{instructions:?}: {error}");
    }
}

proptest! {
    #[test]
    fn nothing_panics(
        instructions in "pif @\n(l[0-3] |@[ab]@ |w |t[0-9] |!a! ?|\\(b\\)[1-4]:[1-9] |\\[c\\]2:[1-9] |\n){0,8}",
        text in "[ab1.,e \n\u{e4}]{0,60}",
    ) {
        let _may_fail = read(&instructions, &text);
    }
}
