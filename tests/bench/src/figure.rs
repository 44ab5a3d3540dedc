//! SVG figure of error against work, one curve per time integration method: Newton iterations on the left,
//! wall time on the right, both axes logarithmic.
use crate::work::{Comparison, Integrator, Point};
use maud::{Markup, html};

const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 400.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 334.0;
/// Left and right end of each panel in pixels; names of the methods stand at the right of the second panel.
const PANELS: [(f64, f64); 2] = [(66.0, 418.0), (458.0, 810.0)];
/// Error that is acceptable for a calibration \[%\]; drawn as a dashed line.
const WANTED: f64 = 1.0;

/// Logarithmic axis, horizontal or vertical: maps a range of values to a range of pixels.
struct Axis {
    /// Exponents of the powers of ten at the two ends of the axis.
    powers: (i32, i32),
    from: f64,
    to: f64,
}

impl Axis {
    /// Creates an axis that encloses all positive values given; one decade if there are none.
    #[expect(clippy::cast_possible_truncation, reason = "powers of ten of a number")]
    fn around(values: impl Iterator<Item = f64>, (from, to): (f64, f64)) -> Self {
        let powers = values.filter(|&v| v > 0.0).map(f64::log10);
        let (low, high) = powers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let powers = if low.is_finite() {
            (
                low.floor() as i32,
                (high.ceil() as i32).max(low.floor() as i32 + 1),
            )
        } else {
            (0, 1)
        };
        Self { powers, from, to }
    }

    fn at(&self, value: f64) -> f64 {
        let (low, high) = (f64::from(self.powers.0), f64::from(self.powers.1));
        self.from + (self.to - self.from) * (value.log10() - low) / (high - low)
    }

    /// Returns the values at the tick marks of the axis: powers of ten.
    fn ticks(&self) -> impl Iterator<Item = f64> {
        (self.powers.0..=self.powers.1).map(|power| 10_f64.powi(power))
    }
}

/// Measure of work on the horizontal axis of a panel.
struct Measure {
    title: &'static str,
    of: fn(&Point) -> f64,
}

const MEASURES: [Measure; 2] = [
    Measure {
        title: "Newton iterations",
        of: |point| point.newton_iterations as f64,
    },
    Measure {
        title: "wall time [s]",
        of: |point| point.wall_s,
    },
];

const fn color(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::TrBdf2 => "#0b5f9e",
        Integrator::Esdirk4 => "#c84b11",
        Integrator::Rodas4 => "#1b7a5a",
        Integrator::GeneralizedAlpha => "#8a4f8f",
        Integrator::Bdf => "#222222",
    }
}

/// Draws the runs of all methods: dots are runs, lines are the Pareto front of each method, a dashed line
/// marks an error of one per cent.
pub(crate) fn error_against_work(all: &Comparison) -> String {
    let errors = all.points.iter().filter_map(|point| point.error);
    let errors = errors.map(|error| 100.0 * error).chain([WANTED]);
    let y = Axis::around(errors, (BOTTOM, TOP));
    let title = "Error of the gauge curves against work, by method of integration";
    let drawn = html! {
        svg xmlns="http://www.w3.org/2000/svg" role="img" width=(WIDTH) height=(HEIGHT)
            viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) font-family="sans-serif" font-size="11" {
            title { (title) }
            rect width="100%" height="100%" fill="white" {}
            @for (measure, ends) in MEASURES.iter().zip(PANELS) {
                (panel(all, measure, ends, &y))
            }
            text x=(PANELS[0].0) y=(TOP - 12.0) { "error / range [%]" }
            (names(all, &y))
        }
    };
    drawn.into_string()
}

fn panel(all: &Comparison, measure: &Measure, ends: (f64, f64), y: &Axis) -> Markup {
    let complete = all.points.iter().filter(|point| point.error.is_some());
    let x = Axis::around(complete.map(measure.of), ends);
    let place = |work: f64, error: f64| (x.at(work), y.at(100.0 * error));
    html! {
        @for value in y.ticks() {
            line x1=(ends.0) x2=(ends.1) y1=(y.at(value)) y2=(y.at(value)) stroke="#e9e9e6" {}
            text x=(ends.0 - 6.0) y=(y.at(value) + 4.0) text-anchor="end" { (value) }
        }
        @for value in x.ticks() {
            line x1=(x.at(value)) x2=(x.at(value)) y1=(BOTTOM) y2=(BOTTOM + 5.0) stroke="#555555" {}
            text x=(x.at(value)) y=(BOTTOM + 18.0) text-anchor="middle" { (value) }
        }
        line x1=(ends.0) x2=(ends.1) y1=(BOTTOM) y2=(BOTTOM) stroke="#555555" {}
        line x1=(ends.0) x2=(ends.1) y1=(y.at(WANTED)) y2=(y.at(WANTED)) stroke="#6b6b6b"
            stroke-dasharray="5 3.5" {}
        text x=(0.5 * (ends.0 + ends.1)) y=(BOTTOM + 38.0) text-anchor="middle" { (measure.title) }
        @for point in &all.points {
            @if let Some(error) = point.error {
                @let (cx, cy) = place((measure.of)(point), error);
                circle cx=(cx) cy=(cy) r="2.2" fill=(color(point.integrator)) {}
            }
        }
        @for method in Integrator::ALL {
            @let front = all.front(method, measure.of);
            @let places = front.iter().map(|&(work, error)| place(work, error));
            @let points: Vec<String> = places.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
            polyline points=(points.join(" ")) fill="none" stroke=(color(method)) stroke-width="1.5" {}
        }
    }
}

/// Draws the methods' names at the right edge, each at the height of the method's most accurate run or below
/// the name above.
fn names(all: &Comparison, y: &Axis) -> Markup {
    const LINE: f64 = 14.0;
    let last = |method| {
        let (_, error) = *all.front(method, MEASURES[1].of).last()?;
        Some((method, y.at(100.0 * error)))
    };
    let mut named: Vec<(Integrator, f64)> = Integrator::ALL.into_iter().filter_map(last).collect();
    named.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut free = f64::NEG_INFINITY;
    for (_, at) in &mut named {
        *at = at.max(free);
        free = *at + LINE;
    }
    html! {
        @for (method, at) in named {
            text x=(PANELS[1].1 + 8.0) y=(at + 4.0) fill=(color(method)) { (method.title()) }
        }
    }
}
