//! The sheet that a figure is drawn on: it writes SVG elements, in whole tenths of a pixel.
//!
//! Tenths keep curves smooth and are shorter in a file than decimals. Knows nothing of axes or of
//! physics; what is not finite is not drawn.
use crate::color::Color;
use maud::{Markup, PreEscaped, Render, html};

/// Width of every full-width figure \[px\].
pub const WIDTH: f64 = 960.0;
/// Units of the SVG per pixel on screen.
const FINENESS: f64 = 10.0;
/// Typeface of every figure; the report's style sheet may replace it.
const FONT: &str = "Helvetica, Arial, sans-serif";

/// A pen.
#[derive(Clone, Copy)]
pub struct Pen {
    color: Color,
    width: f64,
}

impl Pen {
    /// A pen of a colour and a width \[px\].
    pub const fn new(color: Color, width: f64) -> Self {
        Self { color, width }
    }
}

/// Where a text's anchor point lies in it, and how it looks.
#[derive(Clone, Copy)]
pub struct Lettering {
    /// Size [px].
    size: f64,
    color: Color,
    /// Where along the text the anchor is, as SVG names it.
    along: &'static str,
    /// By how much the base line lies below the anchor, over the size.
    drop: f64,
    bold: bool,
    upwards: bool,
}

impl Lettering {
    /// Upright text that starts at its anchor, centred vertically.
    pub const fn new(size: f64, color: Color) -> Self {
        Self {
            size,
            color,
            along: "start",
            drop: 0.32,
            bold: false,
            upwards: false,
        }
    }

    /// The same, ending at its anchor.
    #[must_use]
    pub const fn right(mut self) -> Self {
        self.along = "end";
        self
    }

    /// The same with the anchor in its middle.
    #[must_use]
    pub const fn centered(mut self) -> Self {
        self.along = "middle";
        self
    }

    /// The same, standing on its anchor.
    #[must_use]
    pub const fn above(mut self) -> Self {
        self.drop = -0.2;
        self
    }

    /// The same, hanging from its anchor.
    #[must_use]
    pub const fn below(mut self) -> Self {
        self.drop = 0.76;
        self
    }

    /// The same in bold.
    #[must_use]
    pub const fn bold(mut self) -> Self {
        self.bold = true;
        self
    }

    /// The same, reading upwards.
    #[must_use]
    pub const fn upwards(mut self) -> Self {
        self.upwards = true;
        self
    }
}

/// A sheet; all positions in pixels from its upper left corner.
pub struct Canvas {
    body: String,
}

/// Nearest unit of the SVG; points far off the sheet are brought to a distance that fits.
fn unit(pixels: f64) -> i32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to a range that fits"
    )]
    let unit = (pixels * FINENESS).round().clamp(-1e6, 1e6) as i32;
    unit
}

fn is_finite((x, y): (f64, f64)) -> bool {
    x.is_finite() && y.is_finite()
}

/// Points as SVG lists them.
fn list(points: &[(f64, f64)]) -> String {
    let places = points
        .iter()
        .map(|&(x, y)| format!("{},{}", unit(x), unit(y)));
    places.collect::<Vec<_>>().join(" ")
}

impl Canvas {
    fn draw(&mut self, element: &Markup) {
        element.render_to(&mut self.body);
        self.body.push('\n');
    }

    /// A curve; broken wherever a point is not finite.
    pub fn line(&mut self, points: &[(f64, f64)], pen: Pen) {
        for run in points.split(|&point| !is_finite(point)) {
            if run.len() > 1 {
                self.draw(&html! {
                    polyline fill="none" stroke=(pen.color) stroke-width=(unit(pen.width))
                        points=(list(run)) {}
                });
            }
        }
    }

    /// A straight dashed line.
    pub fn dashed(&mut self, from: (f64, f64), to: (f64, f64), pen: Pen) {
        const DASH: f64 = 5.0;
        const GAP: f64 = 3.5;
        if is_finite(from) && is_finite(to) {
            self.draw(&html! {
                polyline fill="none" stroke=(pen.color) stroke-width=(unit(pen.width))
                    stroke-dasharray=(format!("{} {}", unit(DASH), unit(GAP)))
                    points=(list(&[from, to])) {}
            });
        }
    }

    /// A filled polygon; nothing if a corner is not finite.
    pub fn fill(&mut self, points: &[(f64, f64)], color: Color) {
        if points.len() > 2 && points.iter().all(|&point| is_finite(point)) {
            self.draw(&html! { polygon fill=(color) points=(list(points)) {} });
        }
    }

    /// A filled rectangle between two corners.
    pub fn rectangle(&mut self, from: (f64, f64), to: (f64, f64), color: Color) {
        if !(is_finite(from) && is_finite(to)) {
            return;
        }
        let (left, right) = (unit(from.0.min(to.0)), unit(from.0.max(to.0)));
        let (top, bottom) = (unit(from.1.min(to.1)), unit(from.1.max(to.1)));
        self.draw(&html! {
            rect fill=(color) x=(left) y=(top) width=(right - left) height=(bottom - top) {}
        });
    }

    /// A filled disc.
    pub fn dot(&mut self, at: (f64, f64), radius: f64, color: Color) {
        if is_finite(at) {
            self.draw(&html! {
                circle fill=(color) cx=(unit(at.0)) cy=(unit(at.1)) r=(unit(radius)) {}
            });
        }
    }

    /// One line of text.
    pub fn text(&mut self, at: (f64, f64), text: &str, lettering: Lettering) {
        if !is_finite(at) {
            return;
        }
        let (x, y) = (unit(at.0), unit(at.1));
        let turn = lettering.upwards.then(|| format!("rotate(-90 {x} {y})"));
        let weight = lettering.bold.then_some("bold");
        self.draw(&html! {
            text x=(x) y=(y) dy=(format!("{}em", lettering.drop)) text-anchor=(lettering.along)
                font-size=(unit(lettering.size)) font-weight=[weight] fill=(lettering.color)
                transform=[turn] { (text) }
        });
    }
}

/// Draws one figure and returns its SVG: an element that can stand in HTML as well as in a file.
pub fn render((width, height): (f64, f64), title: &str, paint: impl FnOnce(&mut Canvas)) -> String {
    let mut canvas = Canvas {
        body: String::new(),
    };
    paint(&mut canvas);
    let drawn = html! {
        svg xmlns="http://www.w3.org/2000/svg" role="img" width=(width) height=(height)
            viewBox=(format!("0 0 {} {}", unit(width), unit(height)))
            stroke-linejoin="round" font-family=(FONT) {
            title { (title) }
            (PreEscaped("\n"))
            (PreEscaped(canvas.body))
        }
    };
    drawn.into_string()
}
