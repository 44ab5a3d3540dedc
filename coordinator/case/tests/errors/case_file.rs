//! Faults of `case.toml` that must be reported.
use super::spoilt::{Spoilt, TOML};
use std::fs;

pub(super) const FAULTS: &[Spoilt] = &[
    (
        "syntax",
        |c| c.replace(TOML, "[rod]", "[rod"),
        &["case.toml", "[rod", "| "],
    ),
    (
        "a key in millimetres",
        |c| c.replace(TOML, "radius_m = 1.900", "radius_mm = 1900.0"),
        &[
            "case.toml",
            "unknown field `radius_mm`",
            "write `radius_m`, and multiply the value by 0.001",
        ],
    ),
    (
        "a sense in other words",
        |c| {
            c.replace(TOML, "sense = \"clockwise\"", "sense = \"anticlockwise\"");
        },
        &[
            "case.toml",
            "unknown variant `anticlockwise`",
            "did you mean `counter_clockwise`?",
        ],
    ),
    (
        "unknown key",
        |c| c.replace(TOML, "mass_kg = 450.0", "mas_kg = 450.0"),
        &[
            "case.toml",
            "unknown field `mas_kg`",
            "mas_kg = 450.0",
            "did you mean `mass_kg`?",
        ],
    ),
    (
        "unit missing in a key",
        |c| c.replace(TOML, "inertia_kg_m2 = 2.4e4", "inertia = 2.4e4"),
        &["case.toml", "`inertia`", "did you mean `inertia_kg_m2`?"],
    ),
    (
        "unit missing in a gene",
        |c| c.replace(TOML, "upper = 3.14e12, unit = \"N/m\"", "upper = 3.14e12"),
        &["case.toml", "missing field `unit`", "N.m/deg"],
    ),
    (
        "unit unknown",
        |c| {
            c.replace(
                TOML,
                "upper = 3.14e12, unit = \"N/m\"",
                "upper = 3.14e12, unit = \"N/mm\"",
            );
        },
        &[
            "case.toml",
            "unknown variant `N/mm`",
            "write `N/m`, and multiply the values by 1000",
        ],
    ),
    (
        "a preload beyond any rope",
        |c| {
            c.replace(
                TOML,
                "ends = \"half_pitch\"",
                "preload_n = 1.0e9\nends = \"half_pitch\"",
            );
        },
        &[
            "case.toml",
            "`ropes.preload_n` = 1000000000",
            "-1e6 to 1e6 N",
        ],
    ),
    (
        "an effect's value without unit",
        |c| c.effect("parameters = { moment = { value = 1500.0 } }"),
        &["case.toml", "missing field `unit`"],
    ),
    (
        "an effect's unit unknown",
        |c| c.effect("parameters = { moment = { value = 1.5, unit = \"kN.m\" } }"),
        &[
            "case.toml",
            "`effects[0].parameters.moment.unit` = \"kN.m\"",
            "write `N.m`, and multiply the values by 1000",
        ],
    ),
    (
        "an effect's value not finite",
        |c| c.effect("parameters = { moment = { value = inf, unit = \"N.m\" } }"),
        &[
            "case.toml",
            "`effects[0].parameters.moment.value` = inf",
            "a finite number of N.m",
        ],
    ),
    (
        "an effect's interval beside its value",
        |c| {
            c.effect(
                "parameters = { moment = { value = 9.0, unit = \"N.m\", ci95 = [1.0, 2.0] } }",
            );
        },
        &[
            "case.toml",
            "`effects[0].parameters.moment.ci95` = [1, 2]",
            "two finite numbers around the value, 9",
        ],
    ),
    (
        "an effect searched beside its value",
        |c| {
            c.effect(
                "parameters = { moment = { value = 9.0, unit = \"N.m\", search = [10.0, 20.0] } }",
            );
        },
        &[
            "case.toml",
            "`effects[0].parameters.moment.search` = [10, 20]",
            "two different finite numbers around the value, 9",
            "write the lower bound first, or leave search out",
        ],
    ),
    (
        "an effect searched from top to bottom",
        |c| {
            c.effect(
                "parameters = { moment = { value = 9.0, unit = \"N.m\", search = [20, -1] } }",
            );
        },
        &[
            "case.toml",
            "`effects[0].parameters.moment.search` = [20, -1]",
        ],
    ),
    (
        "an effect searched without end",
        |c| {
            c.effect(
                "parameters = { moment = { value = 9.0, unit = \"N.m\", search = [0, inf] } }",
            );
        },
        &[
            "case.toml",
            "`effects[0].parameters.moment.search` = [0, inf]",
            "two different finite numbers",
        ],
    ),
    (
        "an effect searched where it is",
        |c| {
            c.effect("parameters = { moment = { value = 9.0, unit = \"N.m\", search = [9, 9] } }");
        },
        &[
            "case.toml",
            "`effects[0].parameters.moment.search` = [9, 9]",
        ],
    ),
    (
        "an effect twice",
        |c| c.effect("\n[[effects]]\nid = \"pivot_friction\""),
        &["case.toml", "`effects[1].id`", "duplicate effect"],
    ),
    (
        "an effect's key unknown",
        |c| c.effect("parametres = {}"),
        &["case.toml", "did you mean `parameters`?"],
    ),
    (
        "unit of another quantity",
        |c| {
            c.replace(
                TOML,
                "upper = 1.10e6,  unit = \"N.m/deg\"",
                "upper = 1.10e6, unit = \"N/m\"",
            );
        },
        &[
            "case.toml",
            "`genes.kb4.unit` = \"N/m\"",
            "allowed: N.m/rad or N.m/deg for kb4",
        ],
    ),
    (
        "missing key",
        |c| c.replace(TOML, "speed_rpm = 5.0", ""),
        &["case.toml", "missing field `speed_rpm`", "add `speed_rpm`"],
    ),
    (
        "text for a number",
        |c| c.replace(TOML, "mass_kg = 450.0", "mass_kg = \"450\""),
        &[
            "case.toml",
            "invalid type",
            "mass_kg = \"450\"",
            "numbers without quotes",
        ],
    ),
    (
        "NaN",
        |c| c.replace(TOML, "mass_kg = 450.0", "mass_kg = nan"),
        &[
            "case.toml",
            "`rod.mass_kg` = NaN",
            "allowed: 0.001 to 1e6 kg",
            "mass_kg = nan",
            "^^^",
        ],
    ),
    (
        "infinity",
        |c| c.replace(TOML, "inertia_kg_m2 = 385.0", "inertia_kg_m2 = inf"),
        &["case.toml", "`rod.inertia_kg_m2` = inf", "allowed: "],
    ),
    (
        "infinite gene",
        |c| c.replace(TOML, "upper = 3.14e12", "upper = inf"),
        &["case.toml", "`genes.kb1.upper` = inf", "allowed: above 0"],
    ),
    (
        "negative mass",
        |c| c.replace(TOML, "mass_kg = 175.0", "mass_kg = -175.0"),
        &[
            "case.toml",
            "`suspension.mass_kg` = -175",
            "allowed: 0.001 to 1e6 kg",
        ],
    ),
    (
        "zero radius",
        |c| c.replace(TOML, "radius_m = 1.900", "radius_m = 0.0"),
        &[
            "case.toml",
            "`back_head.radius_m` = 0",
            "allowed: 0.001 to 100 m",
        ],
    ),
    (
        "bounds exclude the recommended value",
        |c| c.replace(TOML, "recommended = 3.14e8", "recommended = 3.14e13"),
        &["case.toml", "`genes.kb1.recommended`", "exclude"],
    ),
    (
        "prior of no width",
        |c| {
            c.replace(
                TOML,
                "upper = 3.14e12",
                "upper = 3.14e12, prior = { value = 3e8, factor = 1.0 }",
            );
        },
        &["case.toml", "`genes.kb1.prior`", "a factor above 1"],
    ),
    (
        "prior below zero",
        |c| {
            c.replace(
                TOML,
                "upper = 3.14e12",
                "upper = 3.14e12, prior = [-1.0, 3e8]",
            );
        },
        &["case.toml", "`genes.kb1.prior`", "positive and ascending"],
    ),
    (
        "bounds exchanged",
        |c| {
            c.replace(
                TOML,
                "lower = 3.14e4, upper = 3.14e12",
                "lower = 3.14e12, upper = 3.14e4",
            );
        },
        &["case.toml", "`genes.kb1.lower`", "below upper"],
    ),
    (
        "duplicate condition",
        |c| c.replace(TOML, "name = \"4rpm\"", "name = \"5rpm\""),
        &[
            "case.toml",
            "`conditions[1].name` = \"5rpm\"",
            "duplicate condition",
        ],
    ),
    (
        "back rope too short",
        |c| c.replace(TOML, "back_cylinders = 72", "back_cylinders = 50"),
        &[
            "case.toml",
            "`ropes.back_cylinders` = 50 (2.500 m of rope)",
            "allowed: ",
        ],
    ),
    (
        "crank too long",
        |c| c.replace(TOML, "radius_m = 1.0973", "radius_m = 2.0973"),
        &[
            "case.toml",
            "`ropes.back_cylinders` = 72",
            "or correct crank.radius_m = 2.0973, if a swing of",
        ],
    ),
    (
        "crank beyond the rod",
        |c| c.replace(TOML, "radius_m = 1.0973", "radius_m = 4.0"),
        &[
            "case.toml",
            "the loop of crank, rod, back rope and back head is open at a pin angle of",
            "crank.radius_m = 4",
        ],
    ),
    (
        "formula for a damping",
        |c| {
            c.replace(
                TOML,
                "cb1  = { recommended = 400.0,",
                "cb1  = { recommended = \"eq3\",",
            );
        },
        &[
            "case.toml",
            "`genes.cb1.recommended` = \"eq3\"",
            "\"eq3\" for kb1, kb23, kb4 and kb56",
        ],
    ),
    (
        "formula misspelt",
        |c| {
            c.replace(
                TOML,
                "kc   = { recommended = 1.00e6,",
                "kc   = { recommended = \"herz\",",
            );
        },
        &[
            "case.toml",
            "unknown variant `herz`",
            "did you mean `hertz`?",
        ],
    ),
    (
        "more harmonics than the card has",
        |c| {
            c.replace(
                TOML,
                "smoothing = \"none\"",
                "smoothing = { harmonics = 4000 }",
            );
        },
        &[
            "case.toml",
            "`conditions[0].smoothing` = { harmonics = 4000 }",
            "a card of",
        ],
    ),
    (
        "back rope all on the head",
        |c| {
            c.replace(TOML, "back_cylinders = 72", "back_cylinders = 56");
            c.replace(TOML, "length_m = 2.876", "length_m = 3.676");
        },
        &[
            "case.toml",
            "`ropes.back_cylinders` = 56",
            "shorter than the path",
        ],
    ),
    (
        "front rope too short",
        |c| c.replace(TOML, "front_cylinders = 114", "front_cylinders = 80"),
        &[
            "case.toml",
            "`ropes.front_cylinders` = 80 (4.000 m of rope)",
            "shorter than the path",
        ],
    ),
    (
        "front anchor within the swing",
        |c| c.replace(TOML, "rope_anchor_deg = 36.6", "rope_anchor_deg = 20.0"),
        &[
            "case.toml",
            "`front_head.rope_anchor_deg` = 20",
            "above 31.8 deg",
        ],
    ),
    (
        "anchor outside the arc",
        |c| {
            c.replace(TOML, "rope_anchor_deg = 125.0", "rope_anchor_deg = 110.0");
            c.replace(TOML, "length_m = 2.876", "length_m = 3.373");
        },
        &[
            "case.toml",
            "`back_head.rope_anchor_deg` = 110",
            "118 to 220 deg",
        ],
    ),
    (
        "step that does not divide 360",
        |c| c.replace(TOML, "output_step_deg = 0.5", "output_step_deg = 0.7"),
        &["case.toml", "`run.output_step_deg` = 0.7", "divides 360"],
    ),
    (
        "smoothing of nothing",
        |c| {
            c.replace(
                TOML,
                "smoothing = \"none\"",
                "smoothing = { harmonics = 0 }",
            );
        },
        &[
            "case.toml",
            "`conditions[0].smoothing`",
            "at least 1 harmonic",
            "moving_average_deg",
        ],
    ),
    (
        "smoothing unknown",
        |c| {
            c.replace(
                TOML,
                "smoothing = \"none\"",
                "smoothing = { harmonic = 14 }",
            );
        },
        &[
            "case.toml",
            "unknown variant `harmonic`",
            "did you mean `harmonics`?",
        ],
    ),
    (
        "speed of the motor",
        |c| c.replace(TOML, "speed_rpm = 5.0", "speed_rpm = 730.0"),
        &[
            "case.toml",
            "`conditions[0].speed_rpm` = 730",
            "0.1 to 60",
            "not the motor's",
        ],
    ),
    (
        "negative weight",
        |c| c.replace(TOML, "gauge = 3, weight = 1.0", "gauge = 3, weight = -1.0"),
        &["case.toml", "`objective.gauges[1].weight` = -1", "above 0"],
    ),
    (
        "more modes than there are",
        |c| c.replace(TOML, "modes = 6", "modes = 13"),
        &["case.toml", "`run.modes` = 13", "0 to 12"],
    ),
    (
        "no objective beside a record",
        |c| c.cut(TOML, "[objective]", "[run]"),
        &[
            "case.toml",
            "`objective` = absent",
            "condition `5rpm` has a record_file",
            "add [objective]",
        ],
    ),
    (
        "a coefficient missing",
        |c| c.replace(TOML, "kb4  = {", "# kb4  = {"),
        &["case.toml", "without `kb4`", "add `kb4 = {"],
    ),
    (
        "a budget too small",
        |c| c.replace(TOML, "modes = 6", "modes = 6\niteration_budget = 10"),
        &[
            "case.toml",
            "`run.iteration_budget` = 10",
            "100 to 1e9 iterations",
        ],
    ),
    (
        "objective without condition",
        |c| c.replace(TOML, "condition = \"5rpm\"", "condition = \"5 rpm\""),
        &[
            "case.toml",
            "`objective.condition` = \"5 rpm\"",
            "did you mean `5rpm`?",
        ],
    ),
    (
        "a condition twice in the objective",
        |c| {
            c.replace(
                TOML,
                "condition = \"5rpm\"",
                "condition = [\"5rpm\", \"5rpm\"]",
            );
        },
        &[
            "case.toml",
            "`objective.condition` = \"5rpm\"",
            "each condition once",
        ],
    ),
    (
        "a weight of the first condition",
        |c| {
            let weighted = "condition = [{ name = \"5rpm\", weight = 2.0 }, \"4rpm\"]";
            c.replace(TOML, "condition = \"5rpm\"", weighted);
        },
        &["case.toml", "without a weight", "relative to the first"],
    ),
    (
        "a condition without weight in the objective",
        |c| {
            let weighted = "condition = [\"5rpm\", { name = \"4rpm\", weight = 0.0 }]";
            c.replace(TOML, "condition = \"5rpm\"", weighted);
        },
        &[
            "case.toml",
            "`objective.condition[1].weight` = 0",
            "above 0",
        ],
    ),
    (
        "no condition in the objective",
        |c| c.replace(TOML, "condition = \"5rpm\"", "condition = []"),
        &["case.toml", "`objective.condition` = []", "at least one"],
    ),
    (
        "a second condition of the objective without a record",
        |c| {
            c.replace(
                TOML,
                "condition = \"5rpm\"",
                "condition = [\"5rpm\", \"4rpm\"]",
            );
            c.replace(TOML, "record_file = \"measured/test_4rpm.csv.gz\"", "");
        },
        &[
            "case.toml",
            "`objective.condition` = \"4rpm\"",
            "a condition with a record_file",
        ],
    ),
    (
        "gauge twice",
        |c| c.replace(TOML, "{ gauge = 3,", "{ gauge = 1,"),
        &["case.toml", "`objective.gauges[1].gauge` = 1", "each once"],
    ),
    (
        "empty",
        |c| fs::write(c.path(TOML), "\n").unwrap(),
        &["case.toml", "empty"],
    ),
    (
        "absent",
        |c| fs::remove_file(c.path(TOML)).unwrap(),
        &["case.toml", "no such file", "horsehead case new"],
    ),
];
