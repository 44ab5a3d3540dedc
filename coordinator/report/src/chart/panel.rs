//! Pair of axes on a canvas: places values and draws ticks, curves and bands.
use super::canvas::{Canvas, Pen, TextStyle};
use super::scale::AxisScale;
use crate::color::{AXIS, Color, GREY, GUIDE, INK, ZERO};

/// Length of a labelled tick [px]; unlabelled ticks are about half as long.
const TICK: f64 = 4.0;
/// Font size of tick labels [px].
const LABEL: f64 = 10.5;
/// Width of a digit in a tick label [px].
const DIGIT: f64 = 5.9;

/// Rectangular plot area on the canvas with a scale along each side.
pub struct Panel {
    /// Left edge of the panel \[px\].
    pub left: f64,
    /// Upper edge of the panel \[px\].
    pub top: f64,
    /// Width of the panel \[px\].
    pub width: f64,
    /// Height of the panel \[px\].
    pub height: f64,
    /// Horizontal scale, from abscissa values to positions in the panel.
    pub x: AxisScale,
    /// Vertical scale, from values to positions in the panel.
    pub y: AxisScale,
}

impl Panel {
    /// Returns the right edge of the panel \[px\].
    pub fn right(&self) -> f64 {
        self.left + self.width
    }

    /// Returns the lower edge of the panel \[px\].
    pub fn bottom(&self) -> f64 {
        self.top + self.height
    }

    /// Returns the horizontal position on the canvas of a value of the horizontal scale \[px\].
    pub fn at_x(&self, x: f64) -> f64 {
        self.left + self.width * self.x.share(x)
    }

    /// Returns the vertical position on the canvas of a value of the vertical scale \[px\].
    pub fn at_y(&self, y: f64) -> f64 {
        self.bottom() - self.height * self.y.share(y)
    }

    /// Returns the position on the canvas of a point given in values of both scales \[px\].
    pub fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.at_x(x), self.at_y(y))
    }

    /// Draws guide lines behind the curves, with a darker one at zero.
    pub fn guides(&self, canvas: &mut Canvas) {
        let (low, high) = self.y.ends();
        let ticks = self.y.ticks();
        for tick in ticks.iter().filter(|tick| !tick.label.is_empty()) {
            let zero = tick.value.abs() < 1e-9 * (high - low).abs();
            let color = if zero { ZERO } else { GUIDE };
            let y = self.at_y(tick.value);
            canvas.line(&[(self.left, y), (self.right(), y)], Pen::new(color, 0.6));
        }
    }

    /// Draws the left axis with ticks, optional labels and the title.
    pub fn left_axis(&self, canvas: &mut Canvas, labels: bool, title: &str) {
        let pen = axis_pen();
        canvas.line(&[(self.left, self.top), (self.left, self.bottom())], pen);
        let ticks = self.y.ticks();
        for tick in &ticks {
            let y = self.at_y(tick.value);
            let length = tick_length(&tick.label);
            canvas.line(&[(self.left - length, y), (self.left, y)], pen);
            if labels && !tick.label.is_empty() {
                let lettering = TextStyle::new(LABEL, INK).right();
                canvas.text((self.left - TICK - 3.0, y), &tick.label, lettering);
            }
        }
        if title.is_empty() {
            return;
        }
        let longest = ticks.iter().map(|tick| tick.label.chars().count()).max();
        let lettering = TextStyle::new(LABEL, GREY).centered().above();
        canvas.text(
            (
                self.left - title_distance(longest.unwrap_or(0)),
                self.top + 0.5 * self.height,
            ),
            title,
            lettering.upwards(),
        );
    }

    /// Draws the lower axis with ticks, optional labels and the title.
    pub fn lower_axis(&self, canvas: &mut Canvas, labels: bool, title: &str) {
        let pen = axis_pen();
        let y = self.bottom();
        canvas.line(&[(self.left, y), (self.right(), y)], pen);
        for tick in self.x.ticks() {
            let x = self.at_x(tick.value);
            let length = tick_length(&tick.label);
            canvas.line(&[(x, y), (x, y + length)], pen);
            if labels && !tick.label.is_empty() {
                let lettering = TextStyle::new(LABEL, INK).centered().below();
                canvas.text((x, y + TICK + 3.0), &tick.label, lettering);
            }
        }
        if title.is_empty() {
            return;
        }
        let lettering = TextStyle::new(LABEL, GREY).centered().below();
        canvas.text(
            (self.left + 0.5 * self.width, y + TICK + 18.0),
            title,
            lettering,
        );
    }

    /// Draws a curve through points given in values of the panel's scales.
    pub fn curve(&self, canvas: &mut Canvas, points: &[(f64, f64)], pen: Pen) {
        let path: Vec<_> = points.iter().map(|&point| self.at(point)).collect();
        canvas.line(&path, pen);
    }

    /// Fills the area between two curves over the same abscissa, given as points (abscissa, lower value,
    /// upper value), for every stretch of finite values.
    pub fn band(&self, canvas: &mut Canvas, rows: &[(f64, f64, f64)], color: Color) {
        for run in rows.split(|(x, low, high)| !(x + low + high).is_finite()) {
            let upper = run.iter().map(|&(x, _, high)| self.at((x, high)));
            let lower = run.iter().rev().map(|&(x, low, _)| self.at((x, low)));
            canvas.fill(&upper.chain(lower).collect::<Vec<_>>(), color);
        }
    }

    /// Writes a remark in the middle of the panel.
    pub fn remark(&self, canvas: &mut Canvas, text: &str) {
        let lettering = TextStyle::new(11.5, GREY).centered();
        canvas.text(
            (self.left + 0.5 * self.width, self.top + 0.5 * self.height),
            text,
            lettering,
        );
    }
}

const fn axis_pen() -> Pen {
    Pen::new(AXIS, 0.8)
}

/// Returns the distance of the left axis's title from the axis [px]: beyond tick labels of `longest`
/// characters, but within the margin.
fn title_distance(longest: usize) -> f64 {
    (TICK + 6.0 + DIGIT * longest as f64).clamp(40.0, 50.0)
}

const fn tick_length(label: &str) -> f64 {
    if label.is_empty() { 0.55 * TICK } else { TICK }
}

/// Returns vertical label positions close to those in `wanted` and at least `gap` apart, between `low` and
/// `high` \[px\], in the order of the input.
pub fn spread(wanted: &[f64], gap: f64, low: f64, high: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|&a, &b| wanted[a].total_cmp(&wanted[b]));
    let mut placed = wanted.to_vec();
    let mut floor = low;
    for &index in &order {
        placed[index] = placed[index].max(floor);
        floor = placed[index] + gap;
    }
    let mut ceiling = high;
    for &index in order.iter().rev() {
        placed[index] = placed[index].min(ceiling);
        ceiling = placed[index] - gap;
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::{DIGIT, TICK, spread, title_distance};

    #[test]
    fn the_title_stands_beyond_the_longest_label() {
        for longest in 0..8_u8 {
            let labels = TICK + 3.0 + DIGIT * f64::from(longest);
            assert!(title_distance(usize::from(longest)) > labels, "{longest}");
        }
    }

    #[test]
    fn labels_are_kept_apart_and_inside() {
        let placed = spread(&[50.0, 48.0, 99.0, 100.0], 10.0, 0.0, 100.0);
        let wanted = [58.0, 48.0, 90.0, 100.0];
        for (placed, wanted) in placed.iter().zip(wanted) {
            assert!((placed - wanted).abs() < 1e-12, "{placed} is not {wanted}");
        }
    }
}
