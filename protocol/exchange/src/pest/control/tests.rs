//! Tests of control files in both formats: three models that PEST++ has run, and invalid files.
use super::*;
use crate::pest::{Instructions, Template};
use std::{fs, path::PathBuf};

fn folder(model: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/pest")
        .join(model)
}

fn closed(name: &str) -> Result<String, String> {
    Err(format!("{name} is not there"))
}

fn shipped(model: &str) -> Control {
    let text = fs::read_to_string(folder(model).join("model.pst")).unwrap();
    Control::parse("model.pst", &text, &closed).unwrap()
}

#[test]
fn models_that_other_programs_have_run_are_read() {
    for (model, parameters, observations, prior) in [
        ("decay", 3, 25, 0),
        ("cantilever", 4, 8, 1),
        ("tanks", 5, 43, 0),
    ] {
        let control = shipped(model);
        let counts = (
            control.parameters.len(),
            control.observations.len(),
            control.prior.len(),
        );
        assert_eq!(counts, (parameters, observations, prior), "{model}");
        assert_eq!(control.commands, ["python3 model.py"]);
        let expected = if model == "tanks" {
            vec![
                "(lines 6 to 10)",
                "model.pst, line 12: FORCEN has no effect",
            ]
        } else {
            vec!["(lines 6 to 10)"]
        };
        let notes = &control.notes;
        assert!(
            notes.len() == expected.len()
                && notes
                    .iter()
                    .zip(expected)
                    .all(|(note, words)| note.contains(words)),
            "{notes:?}"
        );
        // what the templates ask for is there, and instructions give what the control file knows
        let text = |pair: &FilePair| fs::read_to_string(folder(model).join(&pair.own)).unwrap();
        for pair in &control.inputs {
            let template = Template::parse(&pair.own, &text(pair)).unwrap();
            let known = |name: &String| control.parameters.iter().any(|own| own.name == *name);
            assert!(template.fields().keys().all(known));
        }
        let read = control.outputs.iter().flat_map(|pair| {
            Instructions::parse(&pair.own, &text(pair))
                .unwrap()
                .observations()
        });
        let mut read: Vec<String> = read.collect();
        let mut known: Vec<String> = control
            .observations
            .iter()
            .map(|own| own.name.clone())
            .collect();
        read.sort();
        known.sort();
        assert_eq!(read, known);
    }
    let cantilever = shipped("cantilever");
    let of = |name: &str| {
        cantilever
            .parameters
            .iter()
            .find(|own| own.name == name)
            .unwrap()
    };
    assert_eq!(of("young2").transform, Transform::Tied("young1".to_owned()));
    assert_eq!(
        (&of("load").transform, of("load").scale),
        (&Transform::Fixed, -1.0)
    );
    let term = PriorTerm {
        factor: 1.0,
        parameter: "young1".to_owned(),
        log: true,
    };
    assert_eq!(cantilever.prior[0].terms, [term]);
    assert_eq!(
        (cantilever.prior[0].value, cantilever.prior[0].weight),
        (2.30103, 20.0)
    );
}

const NEW: &str = "pcf version=2
* control data keyword
noptmax 8
pestmode estimation
* parameter groups external
groups.csv
* parameter data external
parameters.csv
* observation data external
observations.csv
* model command line
./model # the model
* model input external
in.csv
* model output external
out.csv
* prior information external
prior.csv
++svd_pack(redsvd) ++max_run_fail(3)
";

fn files(name: &str) -> Result<String, String> {
    let text = match name {
        "groups.csv" => {
            "pargpnme,inctyp,derinc,derinclb,forcen,derincmul\ng,absolute,0.5,0,always_2,2\n"
        }
        "parameters.csv" => {
            "parnme,partrans,parval1,parlbnd,parubnd,pargp,partied\n\
             A,log,1,0,10,g,\nb,tied,2,0,10,g,a\nc,fixed,20,0,10,g,\n"
        }
        "observations.csv" => "obsnme,obsval,weight,obgnme\no1,1.5,2,G\no2,1,0,g2\n",
        "in.csv" => "pest_file,model_file\nm.tpl,m.in\n",
        "out.csv" => "pest_file,model_file\nm.ins,m.out\n",
        "prior.csv" => "pilbl,equation,weight,obgnme\np1,1.0 * log(a) - 2*c = 0.5,4,prior\n",
        other => return Err(format!("{other} is not there")),
    };
    Ok(text.to_owned())
}

#[test]
fn the_newer_form_is_read_and_what_pest_accepts_is_noted() {
    let control = Control::parse("new.pst", NEW, &files).unwrap();
    let group = &control.groups[0];
    assert_eq!(
        (group.increment_kind, group.increment),
        (IncrementKind::Absolute, 0.5)
    );
    assert_eq!(
        control.parameters[1].transform,
        Transform::Tied("a".to_owned())
    );
    assert!(control.parameters[0].lower > 0.0);
    assert_eq!(control.observations[0].group, "g");
    assert_eq!(
        (&*control.inputs[0].own, &*control.outputs[0].program),
        ("m.tpl", "m.out")
    );
    let signs: Vec<(f64, &str, bool)> = control.prior[0]
        .terms
        .iter()
        .map(|term| (term.factor, term.parameter.as_str(), term.log))
        .collect();
    assert_eq!(signs, [(1.0, "a", true), (-2.0, "c", false)]);
    let notes = control.notes.join("\n");
    for words in [
        "a is logarithmic with a lower bound",
        "c is fixed at 20",
        "++svd_pack (line 19)",
        "++max_run_fail",
        "groups.csv, line 2: FORCEN",
        "noptmax = 8 (line 3)",
    ] {
        assert!(notes.contains(words), "{words}: {notes}");
    }
    assert_eq!(control.commands, ["./model"]);
}

#[test]
fn what_contradicts_itself_is_refused() {
    let decay = fs::read_to_string(folder("decay").join("model.pst")).unwrap();
    let changes = [
        ("    3    25 ", ("    4    25 ", "NPAR = 4")),
        (" p 1.0 0.0 1\n rate", (" q 1.0 0.0 1\n rate", "group `q`")),
        ("y03 9.106215", ("y02 9.106215", "`y02` twice")),
        ("y03 9.106215", ("y03 NaN", "obsval = `NaN`")),
        ("amp log factor 5.0", ("amp log factor 5000.0", "outside")),
        ("amp log", ("amp tied", "tied to ``")),
        ("model.ins model.out", ("model.ins", "model_file")),
        (
            "* model command line\npython3 model.py\n",
            ("* model command line\n", "no command line"),
        ),
    ];
    for (from, (to, words)) in changes {
        let text = decay.replacen(from, to, 1);
        let read = Control::parse("model.pst", &text, &closed);
        let error = read.unwrap_err().to_string();
        assert!(error.contains(words), "{words}: {error}");
    }
    for text in ["", "pcf\n", "xyz\n", "pcf\n3\n"] {
        assert!(
            Control::parse("model.pst", text, &closed).is_err(),
            "{text:?}"
        );
    }
    let error = Control::parse("new.pst", NEW, &closed)
        .unwrap_err()
        .to_string();
    assert!(error.contains("groups.csv is not there"), "{error}");
}

/// Checks that a file truncated anywhere, or with any line duplicated or removed, is either read or refused
/// without a panic.
#[test]
fn nothing_panics() {
    let text = fs::read_to_string(folder("cantilever").join("model.pst")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    for at in 0..text.len() {
        let _may_fail = Control::parse("cut", text.get(..at).unwrap_or_default(), &closed);
    }
    for at in 0..lines.len() {
        let mut twice = lines.clone();
        twice.insert(at, lines[at]);
        let _may_fail = Control::parse("twice", &twice.join("\n"), &closed);
        twice.drain(at..at + 2);
        let _may_fail = Control::parse("fewer", &twice.join("\n"), &closed);
    }
}
