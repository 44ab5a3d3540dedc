//! The sheet a figure is drawn on: plotters' SVG writer, in tenths of a pixel.
//!
//! plotters places everything on whole units; drawing ten times too large and scaling down by the
//! view box keeps curves smooth. Knows nothing of axes or of physics.
use super::ChartError;
use plotters::coord::Shift;
use plotters::prelude::{
    Circle, Color, DrawingArea, IntoDrawingArea, PathElement, Polygon, RGBColor, Rectangle,
    SVGBackend, ShapeStyle, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, IntoFont, TextStyle};

/// Units of the SVG per pixel on screen.
const FINENESS: f64 = 10.0;
/// plotters divides font sizes by this when it writes SVG.
const FONT_FACTOR: f64 = 1.24;
/// Typeface of every figure; the report's style sheet may replace it.
const FONT: &str = "Helvetica, Arial, sans-serif";

/// A pen.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    /// Colour.
    pub color: RGBColor,
    /// Width [px].
    pub width: f64,
}

/// Where a text's anchor point lies in it, and how it looks.
#[derive(Clone, Copy)]
pub(super) struct Lettering {
    /// Size [px].
    pub size: f64,
    /// Colour.
    pub color: RGBColor,
    /// Horizontal place of the anchor.
    pub horizontal: HPos,
    /// Vertical place of the anchor.
    pub vertical: VPos,
    /// Weight and slant.
    pub style: FontStyle,
    /// Whether it reads upwards.
    pub upwards: bool,
}

impl Lettering {
    /// Upright text that starts at its anchor, centred vertically.
    pub(super) const fn new(size: f64, color: RGBColor) -> Self {
        Self {
            size,
            color,
            horizontal: HPos::Left,
            vertical: VPos::Center,
            style: FontStyle::Normal,
            upwards: false,
        }
    }

    /// The same with another anchor.
    pub(super) const fn at(mut self, horizontal: HPos, vertical: VPos) -> Self {
        self.horizontal = horizontal;
        self.vertical = vertical;
        self
    }

    /// The same in bold.
    pub(super) const fn bold(mut self) -> Self {
        self.style = FontStyle::Bold;
        self
    }

    /// The same, reading upwards.
    pub(super) const fn upwards(mut self) -> Self {
        self.upwards = true;
        self
    }
}

/// A sheet; all positions in pixels from its upper left corner.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
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

fn place((x, y): (f64, f64)) -> (i32, i32) {
    (unit(x), unit(y))
}

fn width(pen: Pen) -> ShapeStyle {
    pen.color.stroke_width(unit(pen.width).unsigned_abs())
}

impl Canvas<'_> {
    /// A curve; broken wherever a point is not finite.
    pub(super) fn line(&self, points: &[(f64, f64)], pen: Pen) -> Result<(), ChartError> {
        for run in points.split(|(x, y)| !(x.is_finite() && y.is_finite())) {
            if run.len() > 1 {
                let path: Vec<_> = run.iter().copied().map(place).collect();
                self.area.draw(&PathElement::new(path, width(pen)))?;
            }
        }
        Ok(())
    }

    /// A straight dashed line.
    pub(super) fn dashed(
        &self,
        from: (f64, f64),
        to: (f64, f64),
        pen: Pen,
    ) -> Result<(), ChartError> {
        const DASH: f64 = 5.0;
        const GAP: f64 = 3.5;
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        if !(length.is_finite() && length > 0.0) {
            return Ok(());
        }
        let along = |s: f64| {
            let share = s.min(length) / length;
            (
                from.0 + share * (to.0 - from.0),
                from.1 + share * (to.1 - from.1),
            )
        };
        let mut start = 0.0;
        while start < length {
            self.line(&[along(start), along(start + DASH)], pen)?;
            start += DASH + GAP;
        }
        Ok(())
    }

    /// A filled polygon; nothing if a corner is not finite.
    pub(super) fn fill(&self, points: &[(f64, f64)], color: RGBColor) -> Result<(), ChartError> {
        if points.len() < 3
            || points
                .iter()
                .any(|(x, y)| !(x.is_finite() && y.is_finite()))
        {
            return Ok(());
        }
        let corners: Vec<_> = points.iter().copied().map(place).collect();
        Ok(self.area.draw(&Polygon::new(corners, color.filled()))?)
    }

    /// A filled rectangle between two corners.
    pub(super) fn rectangle(
        &self,
        from: (f64, f64),
        to: (f64, f64),
        color: RGBColor,
    ) -> Result<(), ChartError> {
        Ok(self
            .area
            .draw(&Rectangle::new([place(from), place(to)], color.filled()))?)
    }

    /// A filled disc.
    pub(super) fn dot(
        &self,
        at: (f64, f64),
        radius: f64,
        color: RGBColor,
    ) -> Result<(), ChartError> {
        Ok(self
            .area
            .draw(&Circle::new(place(at), unit(radius), color.filled()))?)
    }

    /// One line of text.
    pub(super) fn text(
        &self,
        at: (f64, f64),
        text: &str,
        lettering: Lettering,
    ) -> Result<(), ChartError> {
        let font = (
            FONT,
            lettering.size * FINENESS * FONT_FACTOR,
            lettering.style,
        )
            .into_font();
        let font = if lettering.upwards {
            font.transform(FontTransform::Rotate270)
        } else {
            font
        };
        let style = TextStyle::from(font)
            .color(&lettering.color)
            .pos(Pos::new(lettering.horizontal, lettering.vertical));
        Ok(self.area.draw(&Text::new(text, place(at), style))?)
    }
}

/// Draws one figure and returns its SVG: an element that can stand in HTML as well as in a file.
///
/// # Errors
/// [`ChartError`] when plotters cannot write.
pub(super) fn render(
    (width_px, height_px): (f64, f64),
    title: &str,
    paint: impl FnOnce(&Canvas<'_>) -> Result<(), ChartError>,
) -> Result<String, ChartError> {
    let size = (
        unit(width_px).unsigned_abs(),
        unit(height_px).unsigned_abs(),
    );
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let canvas = Canvas { area };
        paint(&canvas)?;
        canvas.area.present()?;
    }
    // plotters' own opening tag fixes the size in its units; ours shrinks it to pixels
    let body = svg.split_once('>').map_or("", |(_, body)| body);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{width_px}\" \
         height=\"{height_px}\" viewBox=\"0 0 {} {}\" stroke-linejoin=\"round\">\n\
         <title>{}</title>{body}",
        size.0,
        size.1,
        escape(title),
    ))
}

/// Escapes text content for XML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
