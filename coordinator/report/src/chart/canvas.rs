//! Drawing surface of a figure: writes SVG elements in integer tenths of a pixel.
//!
//! Tenths keep curves smooth and take fewer bytes than decimals. Independent of axes and physics; points that
//! are not finite are skipped.
use crate::color::Color;
use maud::{Markup, PreEscaped, Render, html};

/// Width of every full-width figure \[px\].
pub const WIDTH: f64 = 960.0;
/// SVG units per pixel on screen.
const FINENESS: f64 = 10.0;
/// Typeface of every figure; the report's style sheet may replace it.
const FONT: &str = "Helvetica, Arial, sans-serif";

/// Stroke of a line in a figure: colour and width.
#[derive(Clone, Copy)]
pub struct Pen {
    color: Color,
    width: f64,
}

impl Pen {
    /// Creates a pen with a colour and a width \[px\].
    pub const fn new(color: Color, width: f64) -> Self {
        Self { color, width }
    }
}

/// Style of a text in a figure, and the position of the text relative to its anchor point.
#[derive(Clone, Copy)]
pub struct TextStyle {
    /// Font size [px].
    size: f64,
    color: Color,
    /// Horizontal alignment of the text to its anchor, as the SVG attribute `text-anchor`.
    along: &'static str,
    /// Offset of the base line below the anchor, relative to the font size.
    baseline_offset: f64,
    bold: bool,
    upwards: bool,
}

impl TextStyle {
    /// Creates the style of horizontal text that starts at its anchor point and is centred on it vertically.
    pub const fn new(size: f64, color: Color) -> Self {
        Self {
            size,
            color,
            along: "start",
            baseline_offset: 0.32,
            bold: false,
            upwards: false,
        }
    }

    /// Returns the style with the text ending at its anchor.
    #[must_use]
    pub const fn right(mut self) -> Self {
        self.along = "end";
        self
    }

    /// Returns the style with the text centred on its anchor.
    #[must_use]
    pub const fn centered(mut self) -> Self {
        self.along = "middle";
        self
    }

    /// Returns the style with the text above its anchor.
    #[must_use]
    pub const fn above(mut self) -> Self {
        self.baseline_offset = -0.2;
        self
    }

    /// Returns the style with the text below its anchor.
    #[must_use]
    pub const fn below(mut self) -> Self {
        self.baseline_offset = 0.76;
        self
    }

    /// Returns the style in bold.
    #[must_use]
    pub const fn bold(mut self) -> Self {
        self.bold = true;
        self
    }

    /// Returns the style rotated to read upwards.
    #[must_use]
    pub const fn upwards(mut self) -> Self {
        self.upwards = true;
        self
    }
}

/// Drawing surface; all positions are in pixels from the upper left corner.
pub struct Canvas {
    body: String,
}

/// Converts pixels to the nearest SVG unit (tenth of a pixel), clamped to a representable range.
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

/// Formats points as an SVG point list.
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

    /// Draws a polyline, interrupted at points that are not finite.
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

    /// Draws a straight dashed line.
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

    /// Draws a filled polygon; nothing if a corner is not finite.
    pub fn fill(&mut self, points: &[(f64, f64)], color: Color) {
        if points.len() > 2 && points.iter().all(|&point| is_finite(point)) {
            self.draw(&html! { polygon fill=(color) points=(list(points)) {} });
        }
    }

    /// Draws a filled rectangle between two corners.
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

    /// Draws a filled circle.
    pub fn dot(&mut self, at: (f64, f64), radius: f64, color: Color) {
        if is_finite(at) {
            self.draw(&html! {
                circle fill=(color) cx=(unit(at.0)) cy=(unit(at.1)) r=(unit(radius)) {}
            });
        }
    }

    /// Draws one line of text.
    pub fn text(&mut self, at: (f64, f64), text: &str, lettering: TextStyle) {
        if !is_finite(at) {
            return;
        }
        let (x, y) = (unit(at.0), unit(at.1));
        let turn = lettering.upwards.then(|| format!("rotate(-90 {x} {y})"));
        let weight = lettering.bold.then_some("bold");
        self.draw(&html! {
            text x=(x) y=(y) dy=(format!("{}em", lettering.baseline_offset)) text-anchor=(lettering.along)
                font-size=(unit(lettering.size)) font-weight=[weight] fill=(lettering.color)
                transform=[turn] { (text) }
        });
    }
}

/// Draws one figure and returns its SVG element, usable within HTML and as a file.
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
