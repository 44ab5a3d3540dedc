//! Tests with external programs that misbehave: each fails only its own individual, reports the reason, and
//! leaves nothing behind.
use crate::rig::Rig;
use std::{
    fs,
    time::{Duration, Instant},
};

/// Returns the error message of a failed simulation with the given program, after checking that no run folder
/// remains.
fn failure(rig: &Rig) -> String {
    let said = rig.refused(&["simulate", "case"]);
    let left = rig.left();
    if !left.is_empty() {
        // a worker was ended in the midst of a run: the next one on the machine clears that away, but for the empty
        // folder of one that was ended while it made or removed it, which is taken for one in the making
        rig.refused(&["simulate", "case"]);
        let mut again = rig.left();
        again.retain(|name| left.contains(name) && rig.is_filled(name));
        assert!(again.is_empty(), "{again:?}");
    }
    said
}

#[test]
fn what_went_wrong_is_said_in_the_programs_own_words() {
    for (program, words) in [
        (
            "echo the licence has run out >&2\nexit 1\n",
            "the licence has run out",
        ),
        ("exit 0\n", "no file `out.csv`"),
        ("printf 'y\\n1\\n2\\n' > out.csv\n", "2 values"),
        ("printf 'y\\n1\\n2\\n4' | head -c 5 > out.csv\n", "2 values"),
        ("printf 'y\\n1\\nNaN\\n4\\n' > out.csv\n", "line 3: `NaN`"),
        ("printf 'z\\n1\\n2\\n4\\n' > out.csv\n", "column `y`"),
        ("ln -s /etc/passwd out.csv\n", "not a regular file"),
        ("mkfifo out.csv\n", "not a regular file"),
        ("kill -9 $$\n", "signal 9"),
    ] {
        let said = failure(&Rig::shell(program, ""));
        assert!(said.contains(words), "{program}: {said}");
    }
    let said = failure(&Rig::shell("exit 0\n", "").tap(|rig| rig.limit("/bin/sh", "/bin/nothing")));
    assert!(said.contains("/bin/nothing"), "{said}");
}

#[test]
fn what_hangs_is_ended_with_all_that_it_has_started() {
    // a process of another session, without parent and without environment
    let program =
        "(setsid env -i /bin/sh -c 'echo $$ > '$PWD'/../../../pid; sleep 600' &) ; sleep 600\n";
    let rig = Rig::shell(program, "");
    rig.limit("wall_s = 3600.0", "wall_s = 1.0");
    let began = Instant::now();
    let said = failure(&rig);
    assert!(said.contains("longer than 1.0 s"), "{said}");
    assert!(began.elapsed() < Duration::from_mins(1));
    let pid = fs::read_to_string(rig.file("pid")).unwrap();
    let path = format!("/proc/{}", pid.trim());
    let is_over =
        || !fs::read_to_string(format!("{path}/cmdline")).is_ok_and(|line| line.contains("sleep"));
    tests::process::wait_until("its end", Duration::from_secs(10), is_over);
}

#[test]
fn what_writes_without_end_is_ended() {
    for program in ["while :; do echo nonsense; done\n", "cat /dev/zero > big\n"] {
        let rig = Rig::shell(program, "");
        rig.limit("output_mib = 256", "output_mib = 4");
        let said = failure(&rig);
        assert!(said.contains("output_mib"), "{said}");
    }
}

#[test]
fn what_the_program_calls_a_verdict_is_not_tried_again() {
    let program = "echo run >> ../../../count\nexit 3\n";
    let rig = Rig::shell(program, "verdicts = { 3 = \"diverged\" }");
    let shown = rig.run(&["simulate", "case", "--output", "json"]);
    let text = String::from_utf8_lossy(&shown.stdout).into_owned();
    assert!(text.contains("diverged"), "{text}");
    // once by itself, and once for each worker that joined
    let runs = fs::read_to_string(rig.file("count"))
        .unwrap()
        .lines()
        .count();
    assert!(runs <= 3, "{runs}");
}

/// Checks that a run whose first individuals all fail stops with one message that quotes the program's last
/// output.
#[test]
fn a_run_in_which_everything_fails_stops_and_says_why() {
    let rig = Rig::shell("echo no such mesh >&2\nexit 1\n", "");
    let said = rig.refused(&[
        "calibrate",
        "case",
        "--preset",
        "least-squares",
        "--run",
        "run",
    ]);
    assert_eq!(said.matches("no such mesh").count(), 1, "{said}");
    assert!(
        said.contains("all failed; last failure: /bin/sh ended with status 1"),
        "{said}"
    );
    assert!(said.contains("help: correct the program"), "{said}");
}

/// Checks that the failure of a program is said once, with its last lines and a remedy, and that failures in a search
/// that goes on are said at its end.
#[test]
fn a_program_that_fails_is_quoted_once() {
    let program = "echo in $PWD/model.py >&2\necho syntax error >&2\nexit 1\n";
    let said = failure(&Rig::shell(program, ""));
    assert_eq!(said.matches("syntax error").count(), 1, "{said}");
    // the folder is another one in every run
    assert!(said.contains("in model.py\n"), "{said}");
    assert!(
        said.contains("help: correct the program, or the files"),
        "{said}"
    );
    assert!(!said.contains("tries again"), "{said}");

    let program = "read name x < in.txt\n\
        case $x in 1*) printf 'y\\n1\\n2\\n4\\n' > out.csv;; *) echo diverged >&2; exit 1;; esac\n";
    let rig = Rig::shell(program, "");
    let ended = rig.run(&[
        "calibrate",
        "case",
        "--preset",
        "random",
        "--set",
        "points=12",
    ]);
    let said = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success(), "{said}");
    let note = said
        .split_once("simulations could not be computed: ")
        .unwrap()
        .1;
    assert!(note.contains("diverged"), "{said}");
    assert_eq!(said.matches("diverged").count(), 1, "{said}");
}

/// Checks that an abscissa in milliseconds is named as such, although the program did not fail.
#[test]
fn an_abscissa_in_another_unit_is_named() {
    let rig = Rig::shell("printf 't,y\\n0,1\\n1000,2\\n2000,4\\n' > out.csv\n", "");
    let path = rig.file("case/case.toml");
    let case = fs::read_to_string(&path).unwrap();
    let case = case.replace(
        "source = { file = \"out.csv\"",
        "source = { file = \"out.csv\", at = \"t\"",
    );
    fs::write(&path, case).unwrap();
    let times = "0,0\n0.5,1\n1,2\n1.5,3\n2,4\n";
    fs::write(rig.file("case/record.csv"), format!("time,y\n{times}")).unwrap();
    rig.done(&["allow", "case"]);
    let said = failure(&rig);
    assert!(
        said.contains("1000 times as far") && said.contains("ms for s"),
        "{said}"
    );
}

#[test]
fn a_folder_of_a_failed_run_stays_where_that_is_wanted() {
    let rig = Rig::shell("echo 7 > trace\nexit 1\n", "");
    rig.limit("keep_failed = false", "keep_failed = true");
    let said = rig.refused(&["simulate", "case"]);
    assert!(said.contains("its folder is kept"), "{said}");
    let left = rig.left();
    let trace = rig.file(left.first().expect("a folder")).join("work/trace");
    assert_eq!(fs::read_to_string(trace).unwrap(), "7\n");
}

/// Checks that the files of a failed run (filled-in input, output, messages) are exported from the journal,
/// on whichever machine the run failed.
#[test]
fn failed_runs_are_fetched_from_the_journal() {
    let program = "echo half done > trace\necho no such mesh >&2\nln -s /etc/hostname link\n\
                   dd if=/dev/zero of=long bs=1024 count=900 2>/dev/null\nexit 1\n";
    let rig = Rig::shell(program, "");
    rig.refused(&["calibrate", "case", "--preset", "random", "--run", "run"]);
    let object = rig.object(&["export", "run", "--failed"]);
    let failed = object["failed"].as_array().unwrap();
    assert!(failed.len() >= 8, "{object}");
    let one = &failed[0];
    assert_eq!(one["kind"], "crashed");
    assert!(one["why"].as_str().unwrap().contains("no such mesh"));
    let folder = rig.file(one["folder"].as_str().unwrap());
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    assert_eq!(read("work/trace"), "half done\n");
    assert!(read("work/in.txt").starts_with("x "), "what was filled in");
    assert!(read("output").contains("no such mesh"));
    assert!(read("why.txt").contains("work/long: of 921600 bytes its last 16384"));
    assert_eq!(fs::metadata(folder.join("work/long")).unwrap().len(), 16384);
    // links are not followed, and the case's own files are in the case
    assert!(!folder.join("work/link").exists() && !folder.join("work/model.sh").exists());
    // again in the same place, which is its own; another one is not emptied
    rig.done(&["export", "run", "--failed"]);
    let said = rig.refused(&["export", "run", "--failed", "--to", "case"]);
    assert!(
        said.contains("not empty") && said.contains("--force"),
        "{said}"
    );
}

#[test]
fn no_more_run_at_a_time_than_a_machine_allows() {
    // whoever finds another at work says so
    let program = "mkdir ../../busy || { echo two at a time >&2; exit 1; }\nsleep 0.05\nrmdir ../../busy\n\
                   printf 'y\\n1\\n2\\n4\\n' > out.csv\n";
    let rig = Rig::shell(program, "");
    rig.limit("cores = 1", "cores = 1\nat_once = 1");
    rig.done(&[
        "calibrate",
        "case",
        "--preset",
        "random",
        "--set",
        "points=20",
        "--run",
        "run",
    ]);
}

/// Extension method that applies a function to a value and returns the value.
trait Tap: Sized {
    fn tap(self, with: impl FnOnce(&Self)) -> Self {
        with(&self);
        self
    }
}

impl Tap for Rig {}
