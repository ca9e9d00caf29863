//! The least change that a linear model asks for, within bounds.

/// Halvings of the interval of the multiplier: more than a double has bits.
const HALVINGS: usize = 200;

/// The shortest `x` within `lower <= x <= upper` (which hold 0 between them) with `gradient · x = wanted`, and whether there
/// is one; otherwise the `x` within the bounds that comes nearest.
///
/// The shortest one is `x = clamp(λ gradient)`, and `gradient · x` grows with the multiplier λ.
pub fn least_change(
    gradient: &[f64],
    wanted: f64,
    lower: &[f64],
    upper: &[f64],
) -> (Vec<f64>, bool) {
    let clamped = |multiplier: f64| -> Vec<f64> {
        let bounds = lower.iter().zip(upper);
        let one = |(g, (low, high)): (&f64, (&f64, &f64))| (multiplier * g).clamp(*low, *high);
        gradient.iter().zip(bounds).map(one).collect()
    };
    let reached = |x: &[f64]| super::statistics::dot(gradient, x);
    let weakest = gradient
        .iter()
        .map(|g| g.abs())
        .filter(|g| *g > 0.0)
        .fold(f64::INFINITY, f64::min);
    if !weakest.is_finite() {
        return (vec![0.0; gradient.len()], wanted == 0.0);
    }
    let longest = lower
        .iter()
        .chain(upper)
        .fold(0.0, |most: f64, bound| most.max(bound.abs()));
    // Here every component with an influence is at its bound.
    let most = wanted.signum() * longest / weakest;
    let corner = clamped(most);
    if (wanted - reached(&corner)) * wanted.signum() > 0.0 {
        return (corner, false);
    }
    let (mut near, mut far) = (0.0, most);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        if (wanted - reached(&clamped(middle))) * wanted.signum() > 0.0 {
            near = middle;
        } else {
            far = middle;
        }
    }
    (clamped(far), true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_bounds_in_the_way_the_change_is_along_the_gradient() {
        let (x, reached) = least_change(&[3.0, 4.0], 5.0, &[-10.0; 2], &[10.0; 2]);
        assert!(reached && (x[0] - 0.6).abs() < 1e-12 && (x[1] - 0.8).abs() < 1e-12);
    }

    #[test]
    fn what_one_parameter_cannot_give_the_other_one_does() {
        let (x, reached) = least_change(&[3.0, -4.0], 5.0, &[-1.0, -0.5], &[1.0, 0.5]);
        assert!(
            reached && (x[0] - 1.0).abs() < 1e-12 && (x[1] + 0.5).abs() < 1e-12,
            "{x:?}"
        );
        let (x, reached) = least_change(&[3.0, -4.0], -4.4, &[-0.4, -0.8], &[0.4, 0.8]);
        assert!(
            reached && (x[0] + 0.4).abs() < 1e-12 && (x[1] - 0.8).abs() < 1e-12,
            "{x:?}"
        );
    }

    #[test]
    fn what_is_out_of_reach_gives_the_nearest_corner() {
        let (x, reached) = least_change(&[3.0, -4.0], 9.0, &[-1.0; 2], &[1.0; 2]);
        assert_eq!((x, reached), (vec![1.0, -1.0], false));
    }

    #[test]
    fn without_influence_nothing_is_reached() {
        assert_eq!(
            least_change(&[0.0], 1.0, &[-1.0], &[1.0]),
            (vec![0.0], false)
        );
    }
}
