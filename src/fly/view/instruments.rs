//! Instruments drawn with characters: artificial horizon, path from above, and a bar for a share of a limit.

/// Height of a character over its width.
const ASPECT: f64 = 2.0;
/// Pitch from the middle of the horizon to its upper edge, degrees.
const PITCH_SPAN_DEG: f64 = 30.0;
/// Half of the least width of the path's map, m.
const LEAST_HALF_WIDTH_M: f64 = 1.0;

/// An artificial horizon: ground is shaded, the vehicle is the mark in the middle. Angles in degrees, nose up and right side down
/// are positive.
#[must_use]
pub fn horizon((columns, rows): (usize, usize), roll_deg: f64, pitch_deg: f64) -> Vec<String> {
    let (middle_x, middle_y) = (0.5 * (columns as f64 - 1.0), 0.5 * (rows as f64 - 1.0));
    let (sin, cos) = roll_deg.to_radians().sin_cos();
    // rows by which the horizon is below the middle
    let below = pitch_deg / PITCH_SPAN_DEG * (middle_y + 0.5);
    let cell = |x: usize, y: usize| {
        let (right, down) = ((x as f64 - middle_x) / ASPECT, y as f64 - middle_y);
        // one row, also where the middle is between two
        if (-0.5..0.5).contains(&down) && right.abs() < 2.0 {
            return if right.abs() < 0.3 { '+' } else { '-' };
        }
        // with the right side down the horizon rises to the right
        if down * cos + right * sin > below { '▒' } else { ' ' }
    };
    (0..rows).map(|y| (0..columns).map(|x| cell(x, y)).collect()).collect()
}

/// The path from above, north up and west left, with the place of now; and the width of the map, m.
#[must_use]
pub fn path_map((columns, rows): (usize, usize), path_m: &[[f64; 2]]) -> (Vec<String>, f64) {
    let mut cells = vec![vec![' '; columns]; rows];
    let side = |axis: usize| {
        let of = path_m.iter().map(move |place| place[axis]);
        (of.clone().fold(f64::INFINITY, f64::min), of.fold(f64::NEG_INFINITY, f64::max))
    };
    let ((south, north), (east, west)) = (side(0), side(1));
    if path_m.is_empty() || columns == 0 || rows == 0 || !(north - south + west - east).is_finite() {
        return (cells.into_iter().map(|row| row.into_iter().collect()).collect(), 0.0);
    }
    // m a column: all of the path fits, a little within
    let per_column = (1.1 * (west - east) / columns as f64)
        .max(1.1 * (north - south) / (rows as f64 * ASPECT))
        .max(2.0 * LEAST_HALF_WIDTH_M / columns as f64);
    let (middle_x, middle_y) = (f64::midpoint(north, south), f64::midpoint(west, east));
    let place = |[x, y]: [f64; 2]| {
        let column = 0.5 * columns as f64 - (y - middle_y) / per_column;
        let row = 0.5 * rows as f64 - (x - middle_x) / (per_column * ASPECT);
        let nearest = |at: f64, count: usize| (0..count).rev().find(|cell| *cell as f64 <= at).unwrap_or(0);
        (nearest(row, rows), nearest(column, columns))
    };
    for (index, at) in path_m.iter().enumerate() {
        let (row, column) = place(*at);
        cells[row][column] = if index + 1 == path_m.len() { '●' } else { '·' };
    }
    (cells.into_iter().map(|row| row.into_iter().collect()).collect(), per_column * columns as f64)
}

/// A share of 0 to 1 as a bar of so many columns.
#[must_use]
pub fn bar(share: f64, columns: usize) -> String {
    let filled = (0..columns).filter(|cell| (*cell as f64 + 0.5) < share * columns as f64).count();
    "█".repeat(filled) + &"░".repeat(columns - filled)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_flight_has_its_ground_below_and_a_climb_has_more_sky() {
        let ground = |lines: &[String]| lines.concat().matches('▒').count();
        let level = horizon((20, 7), 0.0, 0.0);
        assert!(!level[0].contains('▒') && level[6] == "▒".repeat(20) && level[3].contains("-"), "{level:?}");
        assert!(ground(&horizon((20, 7), 0.0, 20.0)) < ground(&level));
        assert_eq!(horizon((20, 6), 0.0, 0.0).iter().filter(|line| line.contains('+')).count(), 1);
        // right side down: more ground on the right
        let rolled = horizon((20, 7), 30.0, 0.0);
        assert!(rolled[2].ends_with('▒') && rolled[4].starts_with(' '), "{rolled:?}");
    }

    #[test]
    fn a_path_north_then_west_ends_above_left() {
        let (map, width_m) = path_map((21, 7), &[[0.0, 0.0], [2.0, 0.0], [2.0, 3.0]]);
        let row = map.iter().position(|line| line.contains('●')).unwrap();
        let column = |line: &str, mark: char| line.chars().position(|letter| letter == mark).unwrap();
        assert!(row < 3 && column(&map[row], '●') < column(&map[row], '·'), "{map:?}");
        assert!((3.0..6.0).contains(&width_m), "{width_m}");
        assert_eq!(path_map((4, 2), &[]).0, ["    ", "    "]);
        assert_eq!(path_map((4, 1), &[[f64::NAN, 0.0]]).1, 0.0);
    }

    #[test]
    fn a_bar_is_as_full_as_the_share() {
        assert_eq!([0.0, 0.5, 1.0, 7.0].map(|share| bar(share, 4)), ["░░░░", "██░░", "████", "████"]);
        assert_eq!(bar(f64::NAN, 2), "░░");
    }
}
