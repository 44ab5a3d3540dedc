//! Figures of the back head's life: the head seen from the side and its pins enlarged, coloured by life, and the damage
//! over the crank angle.
use crate::chart::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use crate::color::{AXIS, Color, GREY, GUIDE, INK, STRENGTH, VERMILLION};
use crate::document::Figure;
use crate::number::fixed;
use protocol::pumping_unit::{HeadGauge, HeadSurface};

/// Upper ends of the classes of life that have a colour of their own \[years\]; the last class has none.
const CLASSES: [f64; 7] = [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];
/// Half of the side of the square that an enlargement shows \[m\].
const REACH_M: f64 = 0.14;
/// Margin around each panel [px].
const MARGIN: f64 = 14.0;
/// Height of the label above each panel [px].
const LABEL: f64 = 24.0;
/// Least component along z of the normals of faces that are drawn: those that a viewer beside the head sees.
const FACING: f32 = 0.2;
/// Width of a sector of the crank angle over which damage is summed \[deg\].
pub const SECTOR_DEG: f64 = 10.0;

/// Input data of the figures of the back head's life.
#[derive(Clone, Copy, Debug)]
pub struct HeadLifePicture<'a> {
    /// Surface of the half z >= 0.
    pub surface: &'a HeadSurface,
    /// Life of each point of the surface \[years\]; NaN where none is assessed.
    pub years: &'a [f64],
    /// Axis of each pin's hole in the beam frame \[m\], with its name.
    pub pins: &'a [(&'static str, [f64; 2])],
    /// Strain gauges on the head.
    pub gauges: &'a [HeadGauge],
    /// Positions of the hot spots \[m\], shortest life first.
    pub spots_m: &'a [[f64; 3]],
    /// Name of each condition, with the share of the first hot spot's damage in each sector of its revolution.
    pub sectors: &'a [(String, Vec<f64>)],
}

/// Section of the side view, and where it is drawn.
struct Panel {
    /// Upper left corner of the section \[m\].
    corner_m: [f64; 2],
    /// Pixels per metre.
    scale: f64,
    /// Upper left corner of the drawing [px].
    left: f64,
    top: f64,
    /// Width and height of the drawing [px].
    size: (f64, f64),
}

impl Panel {
    fn at(&self, place_m: &[f64; 3]) -> (f64, f64) {
        (
            self.left + self.scale * (place_m[0] - self.corner_m[0]),
            self.top + self.scale * (self.corner_m[1] - place_m[1]),
        )
    }

    fn holds(&self, at: (f64, f64)) -> bool {
        self.within(at) == at
    }

    /// Returns the place of the panel that is nearest to a place.
    fn within(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (
            x.clamp(self.left, self.left + self.size.0),
            y.clamp(self.top, self.top + self.size.1),
        )
    }
}

/// Returns the colour of a life.
fn color(years: f64) -> Color {
    if years.is_nan() {
        return GUIDE;
    }
    let class = CLASSES.iter().filter(|end| years >= **end).count();
    STRENGTH.at(1.0 - class as f64 / CLASSES.len() as f64)
}

/// Draws the head and its pins, coloured by life.
fn colored_head(picture: &HeadLifePicture<'_>) -> Figure {
    let ends = |axis: usize| {
        let along = picture.surface.places_m.iter().map(|place| place[axis]);
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    let ([left, right], [bottom, top]) = (ends(0), ends(1));
    // the head beside a column of enlargements
    let side = 0.36 * WIDTH;
    let count = picture.pins.len().max(1) as f64;
    let height = count * (side + LABEL + MARGIN);
    let room = WIDTH - side - 3.0 * MARGIN;
    let scale = (room / (right - left)).min((height - LABEL - 2.0 * MARGIN) / (top - bottom));
    let whole = Panel {
        corner_m: [left, top],
        scale,
        left: MARGIN + 0.5 * (room - scale * (right - left)),
        top: LABEL,
        size: (scale * (right - left), scale * (top - bottom)),
    };
    let faces = seen(picture);
    let title = "Life of the back head";
    let svg = render((WIDTH, height + LABEL), title, |canvas| {
        draw(canvas, picture, &faces, &whole);
        canvas.text(
            (whole.left, 0.5 * LABEL),
            "seen from the side",
            TextStyle::new(12.0, INK),
        );
        for (k, (name, axis)) in picture.pins.iter().enumerate() {
            let panel = Panel {
                corner_m: [axis[0] - REACH_M, axis[1] + REACH_M],
                scale: side / (2.0 * REACH_M),
                left: WIDTH - side - MARGIN,
                top: LABEL + k as f64 * (side + LABEL + MARGIN),
                size: (side, side),
            };
            draw(canvas, picture, &faces, &panel);
            let label = format!("about pin {name}, {:.0} mm wide", 2e3 * REACH_M);
            let at = (panel.left, panel.top - 0.5 * LABEL);
            canvas.text(at, &label, TextStyle::new(12.0, INK));
        }
        legend(canvas, height + 0.3 * LABEL);
    });
    Figure {
        name: "head_life".to_owned(),
        caption: format!(
            "{title}: years until the first crack by the curve, at each point of the surface. Numbers are the hot spots, \
             rings the gauges; grey is held fixed."
        ),
        svg,
    }
}

/// Returns the indices of the faces that a viewer beside the head may see, farthest first.
fn seen(picture: &HeadLifePicture<'_>) -> Vec<usize> {
    let surface = picture.surface;
    let depth = |face: &[u32; 4]| {
        let along = face
            .iter()
            .map(|&point| surface.places_m[point as usize][2]);
        along.sum::<f64>()
    };
    let facing = |face: &[u32; 4]| {
        let along = face.iter().map(|&point| surface.normals[point as usize][2]);
        along.fold(0.0, |sum, z| sum + z) > 4.0 * FACING
    };
    let mut faces: Vec<usize> = (0..surface.faces.len())
        .filter(|k| facing(&surface.faces[*k]))
        .collect();
    faces.sort_by(|a, b| depth(&surface.faces[*a]).total_cmp(&depth(&surface.faces[*b])));
    faces
}

fn draw(canvas: &mut Canvas, picture: &HeadLifePicture<'_>, faces: &[usize], panel: &Panel) {
    let surface = picture.surface;
    for &k in faces {
        let corners = surface.faces[k].map(|point| point as usize);
        let places = corners.map(|point| panel.at(&surface.places_m[point]));
        if !places.iter().any(|place| panel.holds(*place)) {
            continue;
        }
        let places = places.map(|place| panel.within(place));
        // the shortest of the corners that are assessed
        let years = corners.map(|point| picture.years[point]);
        let least = years.into_iter().fold(f64::NAN, f64::min);
        canvas.fill(&places, color(least));
    }
    for gauge in picture.gauges {
        let place = panel.at(&gauge.position_m);
        if panel.holds(place) {
            let ring = 3.5;
            let around: Vec<(f64, f64)> = (0..=16)
                .map(|k| {
                    let (s, c) = (f64::from(k) * std::f64::consts::FRAC_PI_8).sin_cos();
                    (place.0 + ring * c, place.1 + ring * s)
                })
                .collect();
            canvas.fill(&around, GUIDE);
            canvas.line(&around, Pen::new(INK, 1.2));
        }
    }
    for (number, spot) in (1_u32..).zip(picture.spots_m) {
        let place = panel.at(spot);
        if panel.holds(place) {
            canvas.dot(place, 2.2, VERMILLION);
            let lettering = TextStyle::new(10.0, VERMILLION).bold().above();
            canvas.text((place.0 + 3.0, place.1), &number.to_string(), lettering);
        }
    }
    let (right, bottom) = (panel.left + panel.size.0, panel.top + panel.size.1);
    let frame = [
        (panel.left, panel.top),
        (right, panel.top),
        (right, bottom),
        (panel.left, bottom),
        (panel.left, panel.top),
    ];
    canvas.line(&frame, Pen::new(GUIDE, 1.0));
}

fn legend(canvas: &mut Canvas, top: f64) {
    let width = (WIDTH - 2.0 * MARGIN) / (CLASSES.len() + 1) as f64;
    let names = CLASSES.iter().enumerate().map(|(k, end)| match k {
        0 => format!("below {} year", fixed(*end, 0)),
        _ => format!("to {}", fixed(*end, 0)),
    });
    let names = names.chain(["more".to_owned()]);
    let below = CLASSES.iter().map(|end| 0.5 * end).chain([f64::INFINITY]);
    for (k, (name, years)) in names.zip(below).enumerate() {
        let left = MARGIN + k as f64 * width;
        canvas.rectangle((left, top - 6.0), (left + 14.0, top + 6.0), color(years));
        canvas.text((left + 19.0, top), &name, TextStyle::new(11.0, GREY));
    }
}

/// Draws the damage of the first hot spot over the crank angle, condition by condition.
fn damage_by_crank(picture: &HeadLifePicture<'_>) -> Figure {
    let panel = 150.0;
    let height = picture.sectors.len().max(1) as f64 * (panel + LABEL + 2.0 * MARGIN);
    let title = "Damage of the first hot spot over the crank angle";
    let shares = || picture.sectors.iter().flat_map(|(_, shares)| shares);
    let most = shares().copied().fold(f64::MIN_POSITIVE, f64::max);
    let svg = render((WIDTH, height), title, |canvas| {
        for (k, (name, shares)) in picture.sectors.iter().enumerate() {
            let top = LABEL + k as f64 * (panel + LABEL + 2.0 * MARGIN);
            let bottom = top + panel;
            let (left, right) = (50.0, WIDTH - 2.0 * MARGIN);
            let label = format!("{name}: share of the damage in each {SECTOR_DEG:.0} deg");
            canvas.text((left, top - 0.5 * LABEL), &label, TextStyle::new(12.0, INK));
            let step = (right - left) / shares.len().max(1) as f64;
            for (sector, share) in shares.iter().enumerate() {
                let from = left + sector as f64 * step;
                let up = bottom - panel * share / most;
                canvas.rectangle((from + 1.0, up), (from + step - 1.0, bottom), VERMILLION);
            }
            canvas.line(&[(left, bottom), (right, bottom)], Pen::new(AXIS, 1.0));
            for deg in [0, 90, 180, 270, 360] {
                let x = left + (right - left) * f64::from(deg) / 360.0;
                let lettering = TextStyle::new(11.0, GREY).centered().below();
                canvas.text((x, bottom + 4.0), &format!("{deg} deg"), lettering);
            }
            let lettering = TextStyle::new(11.0, GREY).right();
            canvas.text(
                (left - 6.0, top),
                &format!("{:.0} %", 100.0 * most),
                lettering,
            );
        }
    });
    Figure {
        name: "damage_by_crank".to_owned(),
        caption: format!(
            "{title}: half of the damage of a rainflow cycle at each of its two reversals, from bottom dead centre."
        ),
        svg,
    }
}

/// Draws the head coloured by life, and the damage of the first hot spot over the crank angle.
pub fn head_life(picture: &HeadLifePicture<'_>) -> Vec<Figure> {
    vec![colored_head(picture), damage_by_crank(picture)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that a face has the colour of its shortest life, that what is held has none, and that faces that look away
    /// are left out.
    #[test]
    fn faces_are_coloured_by_their_shortest_life() {
        let place = |k: u32| [f64::from(k % 3) * 0.1, f64::from(k / 3) * 0.1, 0.1];
        let surface = HeadSurface {
            places_m: (0..6).map(place).collect(),
            normals: vec![[0.0, 0.0, 1.0]; 6],
            held: vec![false; 6],
            faces: vec![[0, 1, 4, 3], [1, 2, 5, 4]],
            stress_mpa: Vec::new(),
        };
        let years = [50.0, 50.0, f64::NAN, 2.0, 50.0, f64::INFINITY];
        let picture = HeadLifePicture {
            surface: &surface,
            years: &years,
            pins: &[("A", [0.1, 0.05])],
            gauges: &[],
            spots_m: &[[0.1, 0.05, 0.1]],
            sectors: &[("5rpm".to_owned(), vec![0.25, 0.75])],
        };
        let figure = colored_head(&picture);
        for years in [2.0, 50.0] {
            let fill = format!("polygon fill=\"{}\"", color(years));
            assert!(figure.svg.contains(&fill), "{years}");
        }
        assert_ne!(color(2.0), color(50.0));
        assert_eq!(color(f64::INFINITY), STRENGTH.at(0.0));
        assert!(damage_by_crank(&picture).svg.contains("75 %"));
        let away = HeadSurface {
            normals: vec![[0.0, 0.0, -1.0]; 6],
            ..surface.clone()
        };
        let hidden = HeadLifePicture {
            surface: &away,
            ..picture
        };
        assert!(!colored_head(&hidden).svg.contains("polygon"));
    }
}
