//! Faults of `case.toml` that must be reported.
use super::spoilt::{Spoilt, TOML};
use std::fs;

pub(super) const FAULTS: &[Spoilt] = &[
    (
        "syntax",
        |c| c.replace(TOML, "[rod]", "[rod"),
        "Toml",
        &["case.toml", "[rod", "| "],
    ),
    (
        "a key in millimetres",
        |c| c.replace(TOML, "radius_m = 1.900", "radius_mm = 1900.0"),
        "Toml",
        &["case.toml", "`radius_mm`", "`radius_m`", "0.001"],
    ),
    (
        "a sense in other words",
        |c| {
            c.replace(TOML, "sense = \"clockwise\"", "sense = \"anticlockwise\"");
        },
        "Toml",
        &["case.toml", "`anticlockwise`", "`counter_clockwise`"],
    ),
    (
        "unknown key",
        |c| c.replace(TOML, "mass_kg = 450.0", "mas_kg = 450.0"),
        "Toml",
        &["case.toml", "`mas_kg`", "mas_kg = 450.0", "`mass_kg`"],
    ),
    (
        "unit missing in a key",
        |c| c.replace(TOML, "inertia_kg_m2 = 2.4e4", "inertia = 2.4e4"),
        "Toml",
        &["case.toml", "`inertia`", "`inertia_kg_m2`"],
    ),
    (
        "unit missing in a gene",
        |c| c.replace(TOML, "upper = 3.14e12, unit = \"N/m\"", "upper = 3.14e12"),
        "Toml",
        &["case.toml", "`unit`", "N.m/deg"],
    ),
    (
        "an integrator that is gone",
        |c| c.replace(TOML, "integrator = \"esdirk4\"", "integrator = \"bdf5\""),
        "Toml",
        &["case.toml", "`bdf5`", "tr_bdf2", "esdirk4"],
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
        "Toml",
        &["case.toml", "`N/mm`", "`N/m`", "1000"],
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
        "Field",
        &[
            "case.toml",
            "`ropes.preload_n` = 1000000000",
            "-1e6 to 1e6 N",
        ],
    ),
    (
        "an effect's value without unit",
        |c| c.effect("parameters = { moment = { value = 1500.0 } }"),
        "Toml",
        &["case.toml", "`unit`"],
    ),
    (
        "an effect's unit unknown",
        |c| c.effect("parameters = { moment = { value = 1.5, unit = \"kN.m\" } }"),
        "Field",
        &[
            "case.toml",
            "`effects[0].parameters.moment.unit` = \"kN.m\"",
            "`N.m`",
            "1000",
        ],
    ),
    (
        "an effect's value not finite",
        |c| c.effect("parameters = { moment = { value = inf, unit = \"N.m\" } }"),
        "Field",
        &["case.toml", "`effects[0].parameters.moment.value` = inf"],
    ),
    (
        "an effect's interval beside its value",
        |c| {
            c.effect(
                "parameters = { moment = { value = 9.0, unit = \"N.m\", ci95 = [1.0, 2.0] } }",
            );
        },
        "Field",
        &["case.toml", "`effects[0].parameters.moment.ci95` = [1, 2]"],
    ),
    (
        "an effect searched beside its value",
        |c| {
            c.effect(
                "parameters = { moment = { value = 9.0, unit = \"N.m\", search = [10.0, 20.0] } }",
            );
        },
        "Field",
        &[
            "case.toml",
            "`effects[0].parameters.moment.search` = [10, 20]",
        ],
    ),
    (
        "an effect searched from top to bottom",
        |c| {
            c.effect(
                "parameters = { moment = { value = 9.0, unit = \"N.m\", search = [20, -1] } }",
            );
        },
        "Field",
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
        "Field",
        &[
            "case.toml",
            "`effects[0].parameters.moment.search` = [0, inf]",
        ],
    ),
    (
        "an effect searched where it is",
        |c| {
            c.effect("parameters = { moment = { value = 9.0, unit = \"N.m\", search = [9, 9] } }");
        },
        "Field",
        &[
            "case.toml",
            "`effects[0].parameters.moment.search` = [9, 9]",
        ],
    ),
    (
        "an effect twice",
        |c| c.effect("\n[[effects]]\nid = \"pivot_friction\""),
        "Field",
        &["case.toml", "`effects[1].id`"],
    ),
    (
        "an effect's key unknown",
        |c| c.effect("parametres = {}"),
        "Toml",
        &["case.toml", "`parameters`"],
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
        "Field",
        &["case.toml", "`genes.kb4.unit` = \"N/m\""],
    ),
    (
        "missing key",
        |c| c.replace(TOML, "speed_rpm = 5.0", ""),
        "Toml",
        &["case.toml", "add `speed_rpm`"],
    ),
    (
        "text for a number",
        |c| c.replace(TOML, "mass_kg = 450.0", "mass_kg = \"450\""),
        "Toml",
        &["case.toml", "mass_kg = \"450\""],
    ),
    (
        "NaN",
        |c| c.replace(TOML, "mass_kg = 450.0", "mass_kg = nan"),
        "Field",
        &[
            "case.toml",
            "`rod.mass_kg` = NaN",
            "0.001 to 1e6 kg",
            "mass_kg = nan",
            "^^^",
        ],
    ),
    (
        "infinity",
        |c| c.replace(TOML, "inertia_kg_m2 = 385.0", "inertia_kg_m2 = inf"),
        "Field",
        &["case.toml", "`rod.inertia_kg_m2` = inf", "allowed: "],
    ),
    (
        "infinite gene",
        |c| c.replace(TOML, "upper = 3.14e12", "upper = inf"),
        "Field",
        &["case.toml", "`genes.kb1.upper` = inf", "allowed: above 0"],
    ),
    (
        "negative mass",
        |c| c.replace(TOML, "mass_kg = 175.0", "mass_kg = -175.0"),
        "Field",
        &[
            "case.toml",
            "`suspension.mass_kg` = -175",
            "0.001 to 1e6 kg",
        ],
    ),
    (
        "zero radius",
        |c| c.replace(TOML, "radius_m = 1.900", "radius_m = 0.0"),
        "Field",
        &["case.toml", "`back_head.radius_m` = 0", "0.001 to 100 m"],
    ),
    (
        "bounds exclude the recommended value",
        |c| c.replace(TOML, "recommended = 3.14e8", "recommended = 3.14e13"),
        "Field",
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
        "Field",
        &["case.toml", "`genes.kb1.prior`"],
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
        "Field",
        &["case.toml", "`genes.kb1.prior`"],
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
        "Field",
        &["case.toml", "`genes.kb1.lower`"],
    ),
    (
        "duplicate condition",
        |c| c.replace(TOML, "name = \"4rpm\"", "name = \"5rpm\""),
        "Field",
        &["case.toml", "`conditions[1].name` = \"5rpm\""],
    ),
    (
        "back rope too short",
        |c| c.replace(TOML, "back_cylinders = 72", "back_cylinders = 50"),
        "Field",
        &[
            "case.toml",
            "`ropes.back_cylinders` = 50",
            "2.500 m",
            "allowed: ",
        ],
    ),
    (
        "crank too long",
        |c| c.replace(TOML, "radius_m = 1.0973", "radius_m = 2.0973"),
        "Field",
        &[
            "case.toml",
            "`ropes.back_cylinders` = 72",
            "radius_m = 2.0973",
        ],
    ),
    (
        "crank beyond the rod",
        |c| c.replace(TOML, "radius_m = 1.0973", "radius_m = 4.0"),
        "Contradiction",
        &["case.toml", "crank.radius_m = 4"],
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
        "Field",
        &["case.toml", "`genes.cb1.recommended` = \"eq3\"", "23", "56"],
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
        "Toml",
        &["case.toml", "`herz`", "`hertz`"],
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
        "Field",
        &["case.toml", "`conditions[0].smoothing` = {", "4000"],
    ),
    (
        "back rope all on the head",
        |c| {
            c.replace(TOML, "back_cylinders = 72", "back_cylinders = 56");
            c.replace(TOML, "length_m = 2.876", "length_m = 3.676");
        },
        "Field",
        &["case.toml", "`ropes.back_cylinders` = 56"],
    ),
    (
        "front rope too short",
        |c| c.replace(TOML, "front_cylinders = 114", "front_cylinders = 80"),
        "Field",
        &["case.toml", "`ropes.front_cylinders` = 80", "4.000 m"],
    ),
    (
        "front anchor within the swing",
        |c| c.replace(TOML, "rope_anchor_deg = 36.6", "rope_anchor_deg = 20.0"),
        "Field",
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
        "Field",
        &[
            "case.toml",
            "`back_head.rope_anchor_deg` = 110",
            "118 to 220 deg",
        ],
    ),
    (
        "step that does not divide 360",
        |c| c.replace(TOML, "output_step_deg = 0.5", "output_step_deg = 0.7"),
        "Field",
        &["case.toml", "`run.output_step_deg` = 0.7", "360"],
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
        "Field",
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
        "Toml",
        &["case.toml", "`harmonic`", "`harmonics`"],
    ),
    (
        "speed of the motor",
        |c| c.replace(TOML, "speed_rpm = 5.0", "speed_rpm = 730.0"),
        "Field",
        &["case.toml", "`conditions[0].speed_rpm` = 730", "0.1 to 60"],
    ),
    (
        "negative weight",
        |c| c.replace(TOML, "gauge = 3, weight = 1.0", "gauge = 3, weight = -1.0"),
        "Field",
        &["case.toml", "`objective.gauges[1].weight` = -1", "above 0"],
    ),
    (
        "more modes than there are",
        |c| c.replace(TOML, "modes = 6", "modes = 13"),
        "Field",
        &["case.toml", "`run.modes` = 13", "0 to 12"],
    ),
    (
        "no objective beside a record",
        |c| c.cut(TOML, "[objective]", "[run]"),
        "Field",
        &[
            "case.toml",
            "`objective` = absent",
            "`5rpm`",
            "record_file",
            "add [objective]",
        ],
    ),
    (
        "a coefficient missing",
        |c| c.replace(TOML, "kb4  = {", "# kb4  = {"),
        "Field",
        &["case.toml", "`kb4`", "add `kb4 = {"],
    ),
    (
        "a budget too small",
        |c| c.replace(TOML, "modes = 6", "modes = 6\niteration_budget = 10"),
        "Field",
        &["case.toml", "`run.iteration_budget` = 10", "100 to 1e9"],
    ),
    (
        "objective without condition",
        |c| c.replace(TOML, "condition = \"5rpm\"", "condition = \"5 rpm\""),
        "Field",
        &["case.toml", "`objective.condition` = \"5 rpm\"", "`5rpm`"],
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
        "Field",
        &["case.toml", "`objective.condition` = \"5rpm\""],
    ),
    (
        "a weight of the first condition",
        |c| {
            let weighted = "condition = [{ name = \"5rpm\", weight = 2.0 }, \"4rpm\"]";
            c.replace(TOML, "condition = \"5rpm\"", weighted);
        },
        "Field",
        &["case.toml", "without a weight"],
    ),
    (
        "a condition without weight in the objective",
        |c| {
            let weighted = "condition = [\"5rpm\", { name = \"4rpm\", weight = 0.0 }]";
            c.replace(TOML, "condition = \"5rpm\"", weighted);
        },
        "Field",
        &[
            "case.toml",
            "`objective.condition[1].weight` = 0",
            "above 0",
        ],
    ),
    (
        "no condition in the objective",
        |c| c.replace(TOML, "condition = \"5rpm\"", "condition = []"),
        "Field",
        &["case.toml", "`objective.condition` = []"],
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
        "Field",
        &[
            "case.toml",
            "`objective.condition` = \"4rpm\"",
            "record_file",
        ],
    ),
    (
        "gauge twice",
        |c| c.replace(TOML, "{ gauge = 3,", "{ gauge = 1,"),
        "Field",
        &["case.toml", "`objective.gauges[1].gauge` = 1"],
    ),
    (
        "empty",
        |c| fs::write(c.path(TOML), "\n").unwrap(),
        "Damaged",
        &["case.toml", "empty"],
    ),
    (
        "absent",
        |c| fs::remove_file(c.path(TOML)).unwrap(),
        "Missing",
        &["case.toml"],
    ),
];
