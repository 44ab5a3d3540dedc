//! Figures of the back head's modes, one small panel each: the rope arc at rest and deflected, over the
//! outline of the head, with pins and gauges.
//!
//! Only the deflection along the arc is drawn, as it acts on the rope; whole fields are exported for
//! `ParaView`.
use super::name::mode_family;
use crate::chart::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use crate::color::{BLUE, GREY, GUIDE, INK, VERMILLION};
use crate::document::Figure;
use crate::folder::{ReportError, svg_name, write};
use crate::number::fixed;
use protocol::pumping_unit::{HeadGauge, HeadMode};
use std::path::{Path, PathBuf};

/// Number of panels per row.
const COLUMNS: usize = 4;
/// Margin around each panel [px].
const MARGIN: f64 = 12.0;
/// Height of the label above each panel [px].
const LABEL: f64 = 22.0;
/// Drawn size of the largest deflection, as a share of the head's larger side.
const DEFLECTION: f64 = 0.09;
/// Half of the length of the line that shows a gauge's direction [px].
const GAUGE: f64 = 5.0;
/// Threshold below which a mode counts as inert: its largest arc deflection relative to that of the mode that
/// moves the arc most.
const INERT: f64 = 1e-6;
/// Number of horizontal layers used to extract the outline; coarser than a mesh.
const LAYERS: usize = 40;

/// Input data of the figure of the back head's modes.
#[derive(Clone, Copy, Debug)]
pub struct HeadPicture<'a> {
    /// Centre of the rope arc \[m\].
    pub center_m: [f64; 2],
    /// Radius of the rope arc \[m\].
    pub radius_m: f64,
    /// Positions of the mesh's nodes \[m\].
    pub nodes_m: &'a [[f64; 3]],
    /// Indices of the mesh nodes of each pin hole at which the head is held.
    pub pins: [&'a [usize]; 2],
    /// Strain gauges on the head.
    pub gauges: &'a [HeadGauge],
    /// Angles on the rope arc at which the mode shapes are given \[deg\].
    pub arc_deg: &'a [f64],
    /// Modes to draw.
    pub modes: &'a [HeadMode],
}

/// Draws all modes, each scaled to the same largest deflection, since the amplitude of a mode is arbitrary.
pub(super) fn head_modes(picture: &HeadPicture<'_>) -> Figure {
    let frame = Frame::around(picture);
    let rows = picture.modes.len().div_ceil(COLUMNS);
    let height = rows as f64 * frame.pitch();
    let outline = outline(picture);
    let most = picture.modes.iter().map(largest).fold(0.0, f64::max);
    let title = "Modes of the back head along its rope arc";
    let svg = render((WIDTH, height), title, |canvas| {
        for (index, mode) in picture.modes.iter().enumerate() {
            let (row, column) = (index / COLUMNS, index % COLUMNS);
            let mut sheet = Sheet {
                canvas,
                frame: &frame,
                left: column as f64 * WIDTH / COLUMNS as f64 + MARGIN,
                top: row as f64 * frame.pitch() + LABEL,
            };
            sheet.head(picture, &outline);
            sheet.mode(picture, mode, index + 1, largest(mode) > INERT * most);
        }
    });
    Figure {
        name: "head_modes".to_owned(),
        caption: format!(
            "{title}, pin holes held: grey the arc at rest, coloured deflected, each to the same \
             largest deflection; rings are the pins, numbered dots the gauges."
        ),
        svg,
    }
}

fn largest(mode: &HeadMode) -> f64 {
    let pairs = mode.radial.iter().zip(&mode.tangential);
    pairs.fold(0.0, |most, (radial, tangential)| {
        most.max(radial.hypot(*tangential))
    })
}

/// Returns a point of the arc at an angle, displaced radially and tangentially \[m\].
fn on_arc(picture: &HeadPicture<'_>, deg: f64, [radial, tangential]: [f64; 2]) -> (f64, f64) {
    let (sin, cos) = deg.to_radians().sin_cos();
    let radius = picture.radius_m + radial;
    (
        picture.center_m[0] + radius * cos - tangential * sin,
        picture.center_m[1] + radius * sin + tangential * cos,
    )
}

/// Computes the head's outline from horizontal layers: the rightmost node of each layer upwards, then the
/// leftmost nodes downwards.
fn outline(picture: &HeadPicture<'_>) -> Vec<(f64, f64)> {
    let ends = picture.nodes_m.iter().map(|&[x, y, _]| (x, y));
    let by_height = |a: &(f64, f64), b: &(f64, f64)| a.1.total_cmp(&b.1);
    let (lowest, highest) = (ends.clone().min_by(by_height), ends.max_by(by_height));
    let (Some(lowest), Some(highest)) = (lowest, highest) else {
        return Vec::new();
    };
    let mut layers = [None::<((f64, f64), (f64, f64))>; LAYERS];
    for &[x, y, _] in picture.nodes_m {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of the height"
        )]
        let at = ((y - lowest.1) / (highest.1 - lowest.1) * LAYERS as f64) as usize;
        if let Some(layer) = layers.get_mut(at.min(LAYERS - 1)) {
            let (mut left, mut right) = layer.unwrap_or(((x, y), (x, y)));
            if x < left.0 {
                left = (x, y);
            }
            if x > right.0 {
                right = (x, y);
            }
            *layer = Some((left, right));
        }
    }
    let known: Vec<_> = layers.into_iter().flatten().collect();
    let forth = known.iter().map(|(_, right)| *right);
    let back = known.iter().rev().map(|(left, _)| *left);
    let forth = std::iter::once(lowest).chain(forth);
    forth.chain([highest]).chain(back).collect()
}

/// Section of the head's plane that every panel shows, and its scale.
struct Frame {
    /// Upper left corner of the shown section \[m\].
    corner: (f64, f64),
    /// Drawn size of the largest deflection of each mode \[m\].
    deflection: f64,
    /// Scale of the panels, in pixels per metre.
    scale: f64,
    /// Height of a panel [px].
    height: f64,
}

impl Frame {
    fn around(picture: &HeadPicture<'_>) -> Self {
        let arc = picture.arc_deg.iter().map(|&deg| {
            let (x, y) = on_arc(picture, deg, [0.0; 2]);
            [x, y]
        });
        let points = picture.nodes_m.iter().map(|node| [node[0], node[1]]);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points.chain(arc) {
            for axis in [0, 1] {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let sides = [0, 1].map(|axis| (high[axis] - low[axis]).max(1e-3));
        let deflection = DEFLECTION * sides[0].max(sides[1]);
        let scale = (WIDTH / COLUMNS as f64 - 2.0 * MARGIN) / (sides[0] + 2.0 * deflection);
        Self {
            corner: (low[0] - deflection, high[1] + deflection),
            deflection,
            scale,
            height: scale * (sides[1] + 2.0 * deflection),
        }
    }

    /// Returns the distance between rows of panels [px].
    fn pitch(&self) -> f64 {
        LABEL + self.height + MARGIN
    }
}

/// Drawing context of one mode's panel: canvas, scale and position.
struct Sheet<'a> {
    canvas: &'a mut Canvas,
    frame: &'a Frame,
    left: f64,
    top: f64,
}

impl Sheet<'_> {
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let Frame { corner, scale, .. } = self.frame;
        (
            self.left + scale * (x - corner.0),
            self.top + scale * (corner.1 - y),
        )
    }

    /// Draws the content common to all panels: outline, pins, gauges and the arc at rest.
    fn head(&mut self, picture: &HeadPicture<'_>, outline: &[(f64, f64)]) {
        let corners: Vec<_> = outline.iter().map(|&point| self.at(point)).collect();
        self.canvas.fill(&corners, GUIDE);
        for pin in picture.pins {
            let nodes = pin.iter().filter_map(|&node| picture.nodes_m.get(node));
            let count = nodes.clone().count() as f64;
            let mean = |axis: usize| nodes.clone().map(|node| node[axis]).sum::<f64>() / count;
            if count > 0.0 {
                let place = self.at((mean(0), mean(1)));
                self.canvas.dot(place, 4.0, GREY);
                self.canvas.dot(place, 2.6, GUIDE);
            }
        }
        for (number, gauge) in (1_u32..).zip(picture.gauges) {
            let [x, y, _] = gauge.position_m;
            let place = self.at((x, y));
            self.canvas.dot(place, 1.8, BLUE);
            let [along_x, along_y, _] = gauge.direction.map(|x| GAUGE * x);
            let ends = [
                (place.0 - along_x, place.1 + along_y),
                (place.0 + along_x, place.1 - along_y),
            ];
            self.canvas.line(&ends, Pen::new(BLUE, 1.0));
            let lettering = TextStyle::new(9.0, BLUE).above();
            self.canvas
                .text((place.0 + 3.0, place.1), &number.to_string(), lettering);
        }
        let rest = picture.arc_deg.iter();
        let rest: Vec<_> = rest
            .map(|&deg| self.at(on_arc(picture, deg, [0.0; 2])))
            .collect();
        let pen = Pen::new(GREY, 1.0);
        self.canvas.line(&rest, pen);
    }

    fn mode(&mut self, picture: &HeadPicture<'_>, mode: &HeadMode, number: usize, moves: bool) {
        let hz = fixed(mode.frequency_hz, 1);
        let still = if moves { "" } else { ", arc at rest" };
        let label = format!("{number}: {hz} Hz, {}{still}", mode_family(mode.family));
        let lettering = TextStyle::new(11.5, INK);
        self.canvas
            .text((self.left, self.top - 0.5 * LABEL), &label, lettering);
        if !moves {
            return;
        }
        let scale = self.frame.deflection / largest(mode);
        let moved = picture
            .arc_deg
            .iter()
            .zip(mode.radial.iter().zip(&mode.tangential));
        let moved: Vec<_> = moved
            .map(|(&deg, (radial, tangential))| {
                self.at(on_arc(picture, deg, [scale * radial, scale * tangential]))
            })
            .collect();
        let pen = Pen::new(VERMILLION, 1.6);
        self.canvas.line(&moved, pen);
    }
}

/// Writes `head_modes.svg` into a folder, creating it if needed. Returns its path.
///
/// # Errors
/// [`ReportError`] when the file cannot be written.
pub fn write_head_modes(folder: &Path, picture: &HeadPicture<'_>) -> Result<PathBuf, ReportError> {
    let figure = head_modes(picture);
    write(folder, &svg_name(&figure.name), &figure.svg)
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::pumping_unit::ModeFamily;

    fn mode(family: ModeFamily, frequency_hz: f64, radial: [f64; 3]) -> HeadMode {
        HeadMode {
            family,
            frequency_hz,
            radial: radial.to_vec(),
            tangential: vec![0.0; 3],
            gauge_stress_mpa: [0.0; 4],
            participation: [0.0; 3],
            coupling: 0.0,
        }
    }

    fn drawn(modes: &[HeadMode]) -> String {
        let nodes = [[-1.0, -0.5, 0.0], [-1.0, 0.5, 0.0], [-2.0, 0.0, 0.1]];
        let gauge = HeadGauge {
            position_m: [-1.2, 0.1, 0.1],
            direction: [0.0, 1.0, 0.0],
            length_m: 0.01,
        };
        let picture = HeadPicture {
            center_m: [0.0, 0.0],
            radius_m: 2.0,
            nodes_m: &nodes,
            pins: [&[0], &[1]],
            gauges: &[gauge; 2],
            arc_deg: &[150.0, 180.0, 210.0],
            modes,
        };
        head_modes(&picture).svg
    }

    /// Checks that every panel has a label, gauges and pins, and a curve for each mode that moves the arc,
    /// independent of the mode's amplitude.
    #[test]
    fn every_mode_has_its_picture() {
        let alone = mode(ModeFamily::Symmetric, 116.24, [0.0, 0.02, -0.01]);
        let inert = mode(ModeFamily::Antisymmetric, 124.06, [0.0, 1e-12, 0.0]);
        let svg = drawn(&[alone.clone(), inert]);
        let polylines = |svg: &str| svg.matches("<polyline").count();
        assert!(svg.contains("1: 116.2 Hz, symmetric"), "{svg}");
        assert!(svg.contains("2: 124.1 Hz, antisymmetric, arc at rest"));
        assert_eq!(polylines(&svg), 2 * (1 + 2) + 1);
        assert_eq!(svg.matches("<circle").count(), 2 * (2 * 2 + 2));
        // whatever its size, a mode is drawn alike
        let scaled = alone.radial.iter().map(|x| 30.0 * x).collect();
        let larger = HeadMode {
            radial: scaled,
            ..alone.clone()
        };
        assert_eq!(drawn(&[alone]), drawn(&[larger]));
    }

    /// Checks that the largest deflection exactly fills the space reserved for it.
    #[test]
    fn a_deflected_arc_stays_on_its_sheet() {
        let outwards = drawn(&[mode(ModeFamily::Symmetric, 1.0, [1.0; 3])]);
        let (_, curve) = outwards.rsplit_once("points=\"").unwrap();
        let (points, _) = curve.split_once('"').unwrap();
        let xs = points.split_whitespace().map(|point| {
            let (x, _) = point.split_once(',').unwrap();
            x.parse::<f64>().unwrap()
        });
        let left = xs.fold(f64::INFINITY, f64::min);
        assert!((left - 10.0 * MARGIN).abs() <= 1.0, "{left}");
    }
}
