//! Curves of allowable stress range against number of cycles, as codes state them.
//!
//! A curve is a polygon in logarithmic scales: between its corners `N S^m` is constant. Above the first corner the
//! first slope continues, below the last corner the last one, or ranges do no damage (cut-off).
use statrs::distribution::{ContinuousCDF as _, Normal};
use thiserror::Error;

/// Curve of allowable stress range against number of cycles.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name of the curve: category and code.
    pub name: String,
    /// Document from which the numbers are, with its edition.
    pub source: String,
    /// Standard deviation of the decadic logarithm of the number of cycles, if the source states one.
    pub scatter: Option<f64>,
    /// Survival probability of the curve, if the source states one.
    pub survival: Option<f64>,
    /// Pieces of the curve, largest ranges first.
    pieces: Vec<Piece>,
    /// Range below which there is no damage \[MPa\].
    cut_off: f64,
}

/// Piece of a curve on which `N S^m = 10^log_a`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    log_a: f64,
    slope: f64,
    /// Smallest range of the piece \[MPa\].
    down_to: f64,
}

/// Error: numbers that are no curve, or a category that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CurveError {
    /// No such category.
    #[error("there is no category `{name}`")]
    Unknown {
        /// Name that was given.
        name: String,
    },
    /// A table with fewer than two points.
    #[error("a curve needs at least two points; it has {points}")]
    TooShort {
        /// Number of points.
        points: usize,
    },
    /// Point that is not a positive number.
    #[error("point {point} is not a pair of positive numbers")]
    NotPositive {
        /// Number of the point, from 1.
        point: usize,
    },
    /// Points along which the range does not fall with the number of cycles.
    #[error(
        "the curve rises: from point {point} to the next, more cycles must allow a smaller range"
    )]
    Rises {
        /// Number of the first of the two points, from 1.
        point: usize,
    },
}

/// Detail categories of EN 1993-1-9:2005 for normal stress: range at two million cycles \[MPa\].
const EN_CATEGORIES: [u32; 14] = [160, 140, 125, 112, 100, 90, 80, 71, 63, 56, 50, 45, 40, 36];

/// Curves of DNV-RP-C203 (2016), table 2-1, in air: name, then `log a` and `m` above and below ten million cycles.
const DNV: [(&str, [f64; 2], [f64; 2]); 14] = [
    ("B1", [15.117, 4.0], [17.146, 5.0]),
    ("B2", [14.885, 4.0], [16.856, 5.0]),
    ("C", [12.592, 3.0], [16.320, 5.0]),
    ("C1", [12.449, 3.0], [16.081, 5.0]),
    ("C2", [12.301, 3.0], [15.835, 5.0]),
    ("D", [12.164, 3.0], [15.606, 5.0]),
    ("E", [12.010, 3.0], [15.350, 5.0]),
    ("F", [11.855, 3.0], [15.091, 5.0]),
    ("F1", [11.699, 3.0], [14.832, 5.0]),
    ("F3", [11.546, 3.0], [14.576, 5.0]),
    ("G", [11.398, 3.0], [14.330, 5.0]),
    ("W1", [11.261, 3.0], [14.101, 5.0]),
    ("W2", [11.107, 3.0], [13.845, 5.0]),
    ("W3", [10.970, 3.0], [13.617, 5.0]),
];

/// Returns the names of all categories that [`Curve::named`] knows.
pub fn categories() -> Vec<String> {
    let en = EN_CATEGORIES.iter().map(|own| format!("en-{own}"));
    let dnv = DNV
        .iter()
        .map(|own| format!("dnv-{}", own.0.to_lowercase()));
    en.chain(dnv).collect()
}

impl Curve {
    /// Returns the curve of a category: `en-36` to `en-160` (EN 1993-1-9:2005) or `dnv-b1` to `dnv-w3` (DNV-RP-C203, in
    /// air).
    ///
    /// # Errors
    /// [`CurveError::Unknown`] for another name.
    pub fn named(name: &str) -> Result<Self, CurveError> {
        let lower = name.to_lowercase();
        let unknown = || CurveError::Unknown {
            name: name.to_owned(),
        };
        if let Some(category) = lower.strip_prefix("en-") {
            let category: u32 = category.parse().map_err(|_| unknown())?;
            let known = EN_CATEGORIES.contains(&category);
            return known.then(|| Self::eurocode(category)).ok_or_else(unknown);
        }
        let class = lower.strip_prefix("dnv-").ok_or_else(unknown)?;
        let mut classes = DNV.iter();
        let found = classes.find(|own| own.0.eq_ignore_ascii_case(class));
        found.map(Self::dnv).ok_or_else(unknown)
    }

    /// Returns the curve of a detail category of EN 1993-1-9:2005, 7.1: slope 3 to five million cycles, 5 to a hundred
    /// million, then the cut-off.
    fn eurocode(category: u32) -> Self {
        let at = f64::from(category);
        let knee = at * libm::cbrt(2.0 / 5.0);
        let cut_off = knee * libm::pow(5.0 / 100.0, 0.2);
        let log_a =
            |slope: f64, range: f64, cycles: f64| libm::log10(cycles) + slope * libm::log10(range);
        Self {
            name: format!("EN 1993-1-9 category {category}"),
            source: "EN 1993-1-9:2005, 7.1 and figure 7.1".to_owned(),
            scatter: None,
            survival: Some(0.95),
            pieces: vec![
                Piece {
                    log_a: log_a(3.0, at, 2e6),
                    slope: 3.0,
                    down_to: knee,
                },
                Piece {
                    log_a: log_a(5.0, knee, 5e6),
                    slope: 5.0,
                    down_to: cut_off,
                },
            ],
            cut_off,
        }
    }

    fn dnv((class, high, low): &(&str, [f64; 2], [f64; 2])) -> Self {
        let knee = libm::pow(10.0, (high[0] - 7.0) / high[1]);
        let piece = |[log_a, slope]: [f64; 2], down_to: f64| Piece {
            log_a,
            slope,
            down_to,
        };
        Self {
            name: format!("DNV-RP-C203 {class} in air"),
            source: "DNV-RP-C203 (2016), table 2-1".to_owned(),
            scatter: Some(0.2),
            survival: Some(0.977),
            pieces: vec![piece(*high, knee), piece(*low, 0.0)],
            cut_off: 0.0,
        }
    }

    /// Returns the curve that a share `survival` of all details survives, of which the logarithm of the number of cycles is
    /// normally distributed; `None` where the source states no scatter.
    #[must_use]
    pub fn at_survival(self, survival: f64) -> Option<Self> {
        let (scatter, own) = (self.scatter?, self.survival?);
        let normal = Normal::standard();
        let shift = scatter * (normal.inverse_cdf(own) - normal.inverse_cdf(survival));
        let pieces = self.pieces.iter().map(|piece| Piece {
            log_a: piece.log_a + shift,
            ..*piece
        });
        Some(Self {
            name: format!("{} at {survival} survival", self.name),
            survival: Some(survival),
            pieces: pieces.collect(),
            ..self
        })
    }

    /// Returns the curve through points of number of cycles and stress range \[MPa\]. Its first and last slope continue
    /// beyond the first and last point.
    ///
    /// # Errors
    /// [`CurveError`] for points that are no falling curve.
    pub fn table(name: &str, points: &[[f64; 2]]) -> Result<Self, CurveError> {
        if points.len() < 2 {
            return Err(CurveError::TooShort {
                points: points.len(),
            });
        }
        let positive = |point: &[f64; 2]| point.iter().all(|x| x.is_finite() && *x > 0.0);
        if let Some(bad) = points.iter().position(|point| !positive(point)) {
            return Err(CurveError::NotPositive { point: bad + 1 });
        }
        let mut pieces = Vec::new();
        for (k, pair) in points.windows(2).enumerate() {
            let [first, last] = [0, 1].map(|k| pair[k].map(libm::log10));
            if !(last[0] > first[0] && last[1] < first[1]) {
                return Err(CurveError::Rises { point: k + 1 });
            }
            let slope = (last[0] - first[0]) / (first[1] - last[1]);
            pieces.push(Piece {
                log_a: first[0] + slope * first[1],
                slope,
                down_to: pair[1][1],
            });
        }
        if let Some(last) = pieces.last_mut() {
            last.down_to = 0.0;
        }
        Ok(Self {
            name: name.to_owned(),
            source: name.to_owned(),
            scatter: None,
            survival: None,
            pieces,
            cut_off: 0.0,
        })
    }

    /// Returns the number of cycles of a stress range \[MPa\] that the curve allows; infinite at and below its cut-off.
    pub fn cycles(&self, range: f64) -> f64 {
        if range <= self.cut_off || range <= 0.0 {
            return f64::INFINITY;
        }
        let mut pieces = self.pieces.iter();
        let piece = pieces.find(|piece| range >= piece.down_to);
        piece.map_or(f64::INFINITY, |piece| {
            libm::pow(10.0, piece.log_a - piece.slope * libm::log10(range))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(is: f64, expected: f64, tolerance: f64) {
        assert!((is / expected - 1.0).abs() < tolerance, "{is} {expected}");
    }

    #[test]
    fn a_category_has_the_corners_of_the_code() {
        let curve = Curve::named("EN-71").unwrap();
        near(curve.cycles(71.0), 2e6, 1e-12);
        near(curve.cycles(2.0 * 71.0), 2e6 / 8.0, 1e-12);
        near(curve.cycles(0.737 * 71.0), 5e6, 3e-3);
        near(curve.cycles(0.737 * 71.0 * 0.75), 5e6 / 0.2373, 6e-3);
        // 0.549 of the constant amplitude limit is the cut-off
        near(curve.cycles(0.737 * 0.5495 * 71.0), 1e8, 6e-3);
        assert!(curve.cycles(0.737 * 0.548 * 71.0).is_infinite());
        for bad in ["en-70", "en-", "71", "dnv-x", ""] {
            assert!(Curve::named(bad).is_err(), "{bad}");
        }
        assert!(categories().iter().all(|name| Curve::named(name).is_ok()));
    }

    #[test]
    fn curves_of_dnv_are_continuous_and_fall() {
        for name in categories().iter().filter(|name| name.starts_with("dnv")) {
            let curve = Curve::named(name).unwrap();
            let knee = curve.pieces[0].down_to;
            near(curve.cycles(knee * 0.999_999), 1e7, 2e-3);
            near(curve.cycles(knee), 1e7, 1e-9);
            assert!(curve.cycles(0.5 * knee) > curve.cycles(knee));
        }
        let d = Curve::named("dnv-d").unwrap();
        near(d.cycles(100.0), 1.4588e6, 1e-3);
        // the mean curve lies two standard deviations of 0.2 above, to the digits of the code's survival
        let mean = d.clone().at_survival(0.5).unwrap();
        for range in [100.0, 30.0] {
            near(
                mean.cycles(range) / d.cycles(range),
                libm::pow(10.0, 0.4),
                5e-3,
            );
        }
        near(
            d.clone().at_survival(0.977).unwrap().cycles(100.0),
            d.cycles(100.0),
            1e-12,
        );
        assert!(Curve::named("en-71").unwrap().at_survival(0.9).is_none());
    }

    #[test]
    fn a_table_is_a_polygon_in_logarithmic_scales() {
        let points = [[1e4, 400.0], [1e6, 100.0], [1e8, 50.0]];
        let curve = Curve::table("own.csv", &points).unwrap();
        for [cycles, range] in points {
            near(curve.cycles(range), cycles, 1e-9);
        }
        near(curve.cycles(200.0), 1e5, 1e-9);
        // beyond its ends with their slopes
        near(curve.cycles(800.0), 1e3, 1e-9);
        near(curve.cycles(25.0), 1e10, 1e-9);
        let error = |points: &[[f64; 2]]| Curve::table("own.csv", points).unwrap_err();
        assert_eq!(error(&points[..1]), CurveError::TooShort { points: 1 });
        assert_eq!(
            error(&[[1e4, 100.0], [1e6, 100.0]]),
            CurveError::Rises { point: 1 }
        );
        assert_eq!(
            error(&[[1e4, 400.0], [1e6, f64::NAN]]),
            CurveError::NotPositive { point: 2 }
        );
    }
}
