//! A line of blocks that shows the course of a value.

const BLOCKS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// The last `width` values between their least and their largest; a blank for what is not a number.
#[must_use]
pub fn spark(
    values: impl DoubleEndedIterator<Item = f64> + ExactSizeIterator + Clone,
    width: usize,
) -> String {
    let skipped = values.len().saturating_sub(width);
    let shown = values.skip(skipped);
    let finite = || shown.clone().filter(|value| value.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let block = |value: f64| {
        if !value.is_finite() {
            return ' ';
        }
        let share = if high > low { (value - low) / (high - low) } else { 0.0 };
        let above = (1..BLOCKS.len()).take_while(|step| share * 8.0 >= *step as f64).count();
        BLOCKS[above]
    };
    shown.clone().map(block).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_and_largest_have_the_ends_of_the_scale() {
        assert_eq!(spark([1.0, 2.0, 3.0].into_iter(), 10), "▁▅█");
        assert_eq!(spark([9.0, 1.0, f64::NAN, 3.0].into_iter(), 3), "▁ █");
        assert_eq!(spark([2.0, 2.0].into_iter(), 10), "▁▁");
        assert_eq!(spark(std::iter::empty(), 10), "");
    }
}
