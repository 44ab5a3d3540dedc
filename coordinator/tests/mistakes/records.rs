//! Mistakes in records, load cards and the numbers of the machine that a comparison with the simulation shows.
use crate::folder::Mistake;

pub(crate) const RECORDS: &[Mistake] = &[
    (
        "columns of two gauges exchanged",
        |d| {
            d.record(|row, cells| {
                if row == 0 {
                    cells.swap(2, 4);
                }
            });
        },
        "case check case",
        0,
        &[
            "5rpm: the record of gauge 1 correlates by 0.98 with the simulated gauge 3, and by -0.84 with its own",
            "correct their names",
        ],
    ),
    (
        "gauges of reversed sign, diagnosed by one look",
        |d| {
            d.record(|row, cells| {
                for cell in &mut cells[2..6] {
                    if row > 0 {
                        *cell = format!("{}", -cell.parse::<f64>().unwrap());
                    }
                }
            });
        },
        "simulate case",
        0,
        &[
            "the record of gauge 3 correlates by -0.98 with its simulation",
            "multiply the column by -1",
        ],
    ),
    (
        "gauges in microstrain",
        |d| {
            d.record(|row, cells| {
                for cell in &mut cells[2..6] {
                    if row > 0 {
                        *cell = format!("{}", cell.parse::<f64>().unwrap() / 0.206);
                    }
                }
            });
        },
        "simulate case",
        0,
        &[
            "gauge 1, gauge 2, gauge 3, gauge 4 has 5.1",
            "as if its values are in um/m of steel (factor 4.854)",
        ],
    ),
    (
        "angle from top dead centre",
        |d| {
            d.record(|row, cells| {
                if row > 0 {
                    cells[1] = format!("{:.1}", (cells[1].parse::<f64>().unwrap() + 180.0) % 360.0);
                }
            });
        },
        "simulate case",
        0,
        &[
            "every record fits its simulation from 180 deg on",
            "such as the other dead centre? subtract 180 deg",
        ],
    ),
    (
        "a load card in pounds",
        |d| {
            d.card(|row, rows| {
                (
                    rows[row][0].clone(),
                    format!("{}", rows[row][1].parse::<f64>().unwrap() / 4.448_222),
                )
            });
        },
        "simulate case",
        0,
        &[
            "times the amplitude of its simulation: as if the load that drives the simulation is in lbf (factor 4.448)",
        ],
    ),
    (
        "a load card that begins half a turn later",
        |d| {
            d.card(|row, rows| {
                let half = (row + rows.len() / 2) % rows.len();
                (rows[row][0].clone(), rows[half][1].clone())
            });
        },
        "simulate case",
        0,
        &[
            "what drives the simulation such as a measured load, begin at another point",
            "the curves do not tell which",
        ],
    ),
    (
        "a counterweight in kN m",
        |d| {
            d.replace(
                "case/case.toml",
                "counterweight_moment_n_m = 106.2e3",
                "counterweight_moment_n_m = 106.2",
            );
        },
        "simulate case",
        0,
        &[
            "the record of crank torque correlates by 0.3",
            "check its column and unit, and the values of the case that it depends on",
        ],
    ),
    (
        "a crank radius that is too long",
        |d| d.replace("case/case.toml", "radius_m = 1.0973", "radius_m = 1.2573"),
        "simulate case",
        0,
        &[
            "the record of rod position has 0.87",
            "check its unit, and the lengths, masses and loads of the case",
        ],
    ),
    (
        "an inertia in t m2",
        |d| {
            d.replace(
                "case/case.toml",
                "inertia_kg_m2 = 2.4e4",
                "inertia_kg_m2 = 24.0",
            );
        },
        "case check case",
        2,
        &["`beam.inertia_kg_m2` = 24", "at least 795 kg m2"],
    ),
    (
        "another speed with the card of the first one",
        |d| {
            d.replace(
                "case/case.toml",
                "[objective]",
                "[[conditions]]\nname = \"8rpm\"\nspeed_rpm = 8.0\ncounterweight_moment_n_m = 106.2e3\n\
                 card_file = \"measured/card_5rpm.csv\"\n\n[objective]",
            );
        },
        "simulate case --condition 8rpm",
        0,
        &[
            "condition `8rpm` (8 /min) has the load card of `5rpm` (5 /min)",
            "no prediction for `8rpm`",
        ],
    ),
];
