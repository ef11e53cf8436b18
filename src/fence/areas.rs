//! The areas of a fence.

use super::item::{CIRCLE_INSIDE, CIRCLE_OUTSIDE, FenceItem, POLYGON_INSIDE, POLYGON_OUTSIDE};
use super::zone::Zone;
use crate::frames::Geodetic;

/// The areas of a fence, and how many corners of how many came where a polygon is not whole.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Areas {
    /// m north and west of the origin
    pub zones: Vec<Zone>,
    /// corners that came, corners that the polygon says it has
    pub broken: Vec<(usize, f64)>,
}

impl Areas {
    /// The areas of items in their order, about `origin`. What is no area is passed over.
    #[must_use]
    pub fn of(items: &[FenceItem], origin: &Geodetic) -> Self {
        let mut areas = Self::default();
        let mut rest = items;
        while let Some((first, after)) = rest.split_first() {
            let inside = matches!(first.command, POLYGON_INSIDE | CIRCLE_INSIDE);
            match first.command {
                CIRCLE_INSIDE | CIRCLE_OUTSIDE => {
                    let center_m = first.place.north_west_m(origin);
                    areas.zones.push(Zone::Circle { inside, center_m, radius_m: first.parameter });
                    rest = after;
                }
                POLYGON_INSIDE | POLYGON_OUTSIDE => {
                    let own = |item: &&FenceItem| {
                        item.command == first.command && (item.parameter - first.parameter).abs() < 0.5
                    };
                    let mut count = 0;
                    while (count as f64) < first.parameter && rest.get(count).as_ref().is_some_and(own) {
                        count += 1;
                    }
                    if (count as f64) < first.parameter || count < 3 {
                        areas.broken.push((count, first.parameter));
                    } else {
                        let corners_m = rest[..count].iter().map(|item| item.place.north_west_m(origin));
                        areas.zones.push(Zone::Polygon { inside, corners_m: corners_m.collect() });
                    }
                    rest = &rest[count.max(1)..];
                }
                // the place to return to is no border
                _ => rest = after,
            }
        }
        areas
    }
}
