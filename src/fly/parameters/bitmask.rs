//! Bit masks in parameters.

/// Whether a bit of a bit mask is set.
pub(in crate::fly) fn has_bit(value: f64, bit: u32) -> bool {
    // a mask of at most 24 bits is a whole number in single precision
    let scaled = (value / f64::from(1_u32 << bit)).floor();
    (scaled / 2.0).fract() > 0.25
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_read_from_floats() {
        assert!(has_bit(4.0, 2) && !has_bit(4.0, 1) && has_bit(7.0, 2) && !has_bit(8.0, 2));
    }
}
