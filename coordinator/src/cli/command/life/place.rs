//! Place of a point of the head relative to the pins that hold it, and to the inner edges of its surface.
use protocol::pumping_unit::HeadSurface;

/// Least rise of a face above the plane of another at an inner edge, as the sine of the angle between them.
const RISE: f64 = 0.1;

/// Pin that holds the head, across its width.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pin {
    pub(super) name: &'static str,
    /// Axis of the hole in the beam frame, x and y \[m\].
    center_m: [f64; 2],
    radius_m: f64,
}

/// Place of a point relative to the nearest pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bearing {
    pub(super) pin: &'static str,
    /// Direction from the pin's axis, counter-clockwise from +x of the beam \[deg\], 0 to 360.
    pub(super) angle_deg: f64,
    /// Distance from the edge of the hole \[m\].
    pub(super) distance_m: f64,
}

impl Pin {
    /// Finds axis and radius of the hole whose wall has nodes at these positions; `None` without a node.
    pub(super) fn around(name: &'static str, wall_m: &[[f64; 3]]) -> Option<Self> {
        let ends = |axis: usize| {
            let along = wall_m.iter().map(move |place| place[axis]);
            let (least, most) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(x), b.max(x))
            });
            (least.is_finite()).then_some([least, most])
        };
        let ([left, right], [bottom, top]) = (ends(0)?, ends(1)?);
        Some(Self {
            name,
            center_m: [0.5 * (left + right), 0.5 * (bottom + top)],
            radius_m: 0.25 * (right - left + top - bottom),
        })
    }

    /// Returns the axis of the hole in the beam frame, x and y \[m\].
    pub(super) const fn axis_m(&self) -> [f64; 2] {
        self.center_m
    }

    fn bearing(&self, [x, y, _]: &[f64; 3]) -> Bearing {
        let [dx, dy] = [x - self.center_m[0], y - self.center_m[1]];
        Bearing {
            pin: self.name,
            angle_deg: libm::atan2(dy, dx).to_degrees().rem_euclid(360.0),
            distance_m: dx.hypot(dy) - self.radius_m,
        }
    }
}

/// Returns the place of a point relative to the nearest of several pins.
pub(super) fn nearest(pins: &[Pin], place_m: &[f64; 3]) -> Option<Bearing> {
    let all = pins.iter().map(|pin| pin.bearing(place_m));
    all.min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
}

/// Returns the distance of two points, in their unit.
pub(super) fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let square = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    square.sqrt()
}

/// Returns whether a surface has an inner edge at a point: another face there rises above its plane, so that the material
/// fills more than half of the space around. Without a fillet the stress at such an edge has no limit as a mesh is refined.
pub(super) fn is_at_inner_edge(surface: &HeadSurface, point: usize) -> bool {
    let (place, normal) = (surface.places_m[point], surface.normals[point]);
    let offset = |from: usize| {
        let to = surface.places_m[from];
        [0, 1, 2].map(|axis| to[axis] - place[axis])
    };
    let corners = |face: &[u32; 4]| face.map(|corner| corner as usize);
    let meets =
        |corner: usize| corner != point && distance(&surface.places_m[corner], &place) <= 0.0;
    surface.faces.iter().map(corners).any(|corners| {
        if !corners.into_iter().any(meets) {
            return false;
        }
        let across = corners.map(offset);
        let center = [0, 1, 2].map(|axis| across.iter().map(|own| own[axis]).sum::<f64>());
        let above = center.iter().zip(normal).map(|(x, n)| x * f64::from(n));
        above.sum::<f64>() > RISE * distance(&center, &[0.0; 3])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_lies_beside_the_nearest_pin() {
        let wall = |x: f64, y: f64| {
            [
                [x - 0.04, y, 0.1],
                [x + 0.04, y, 0.1],
                [x, y - 0.04, 0.1],
                [x, y + 0.04, 0.1],
            ]
        };
        let pins = [
            Pin::around("A", &wall(-1.0, 0.2)).unwrap(),
            Pin::around("B", &wall(-1.0, -0.35)).unwrap(),
        ];
        let found = nearest(&pins, &[-1.0, 0.3, 0.16]).unwrap();
        assert_eq!((found.pin, found.angle_deg.round()), ("A", 90.0));
        assert!((found.distance_m - 0.06).abs() < 1e-12);
        let found = nearest(&pins, &[-1.05, -0.35, 0.0]).unwrap();
        assert_eq!((found.pin, found.angle_deg.round()), ("B", 180.0));
        assert!(nearest(&[], &[0.0; 3]).is_none() && Pin::around("A", &[]).is_none());
    }

    /// Checks a floor that ends at a rising wall on one side and at a falling one on the other: points 0 to 3 are those of
    /// the floor, each wall has its own at the common edge.
    #[test]
    fn an_inner_edge_lies_where_another_face_rises() {
        let places_m = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 1.0, 1.0],
            [1.0, 0.0, 1.0],
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, -1.0],
            [0.0, 0.0, -1.0],
        ];
        let surface = HeadSurface {
            places_m: places_m.to_vec(),
            normals: [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
                .into_iter()
                .flat_map(|normal| [normal; 4])
                .collect(),
            faces: vec![[0, 1, 2, 3], [4, 7, 6, 5], [8, 9, 10, 11]],
            ..HeadSurface::default()
        };
        let found: Vec<usize> = (0..12).filter(|&k| is_at_inner_edge(&surface, k)).collect();
        assert_eq!(found, [1, 2, 4, 5]);
    }
}
