//! Place of a point of the head relative to the pins that hold it.

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
}
