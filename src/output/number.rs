//! How a number is shown in a table.

/// Six significant digits without trailing zeros; powers of ten for the very small and the very large.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..7.0).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let decimals = (5.0 - magnitude).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_six_digits() {
        assert_eq!(number(180.612_345), "180.612");
        assert_eq!(number(-0.000_123_456_7), "-0.000123457");
        assert_eq!(number(1_234_567.0), "1234567");
        assert_eq!(number(2.5e-12), "2.500e-12");
        assert_eq!(number(f64::NAN), "NaN");
    }
}
