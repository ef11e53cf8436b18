//! Areas in the plane.

/// An area that must be kept in or out of; metres north and west.
#[derive(Debug, Clone, PartialEq)]
pub enum Zone {
    /// corners in order
    Polygon {
        /// to be kept in, not out of
        inside: bool,
        /// m north, m west
        corners_m: Vec<[f64; 2]>,
    },
    /// round
    Circle {
        /// to be kept in, not out of
        inside: bool,
        /// m north, m west
        center_m: [f64; 2],
        /// m
        radius_m: f64,
    },
}

impl Zone {
    /// Distance to the border, m: positive where the vehicle may be.
    #[must_use]
    pub fn spare_m(&self, place_m: [f64; 2]) -> f64 {
        let (inside, depth_m) = match self {
            Self::Circle { inside, center_m, radius_m } => {
                let distance = (place_m[0] - center_m[0]).hypot(place_m[1] - center_m[1]);
                (*inside, radius_m - distance)
            }
            Self::Polygon { inside, corners_m } => {
                let border =
                    edges(corners_m).map(|edge| distance_m(place_m, edge)).fold(f64::INFINITY, f64::min);
                (*inside, if contains(corners_m, place_m) { border } else { -border })
            }
        };
        if inside { depth_m } else { -depth_m }
    }

    /// For messages.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Polygon { inside: true, .. } => "the fence's polygon to stay in",
            Self::Polygon { inside: false, .. } => "the fence's polygon to stay out of",
            Self::Circle { inside: true, .. } => "the fence's circle to stay in",
            Self::Circle { inside: false, .. } => "the fence's circle to stay out of",
        }
    }
}

fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(from, to)| [*from, *to])
}

/// By the number of edges that a ray crosses.
fn contains(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let crossed = edges(corners)
        .filter(|[[x0, y0], [x1, y1]]| (y0 > &y) != (y1 > &y) && x < x0 + (y - y0) / (y1 - y0) * (x1 - x0));
    crossed.count() % 2 == 1
}

fn distance_m([x, y]: [f64; 2], [[x0, y0], [x1, y1]]: [[f64; 2]; 2]) -> f64 {
    let (dx, dy) = (x1 - x0, y1 - y0);
    let square = dx * dx + dy * dy;
    let along = if square > 0.0 { (((x - x0) * dx + (y - y0) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    (x - x0 - along * dx).hypot(y - y0 - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_notched_polygon_knows_its_inside() {
        // an L: the notch at the upper right is outside
        let corners_m = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0]];
        let zone = Zone::Polygon { inside: true, corners_m: corners_m.clone() };
        assert!((zone.spare_m([1.0, 1.0]) - 1.0).abs() < 1e-12);
        assert!((zone.spare_m([3.0, 3.0]) + 1.0).abs() < 1e-12);
        let out = Zone::Polygon { inside: false, corners_m };
        assert!((out.spare_m([3.0, 3.0]) - 1.0).abs() < 1e-12);
        let circle = Zone::Circle { inside: false, center_m: [0.0, 0.0], radius_m: 5.0 };
        assert!((circle.spare_m([3.0, 4.0])).abs() < 1e-12 && circle.spare_m([1.0, 0.0]) < -3.9);
    }
}
