//! The two tools of the benchmark (Konter 2006; positions as in code_aster's model of SSNP155).

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Piece, Profile};

/// The die: a cavity of `radius` centred at (0, -`shoulder_radius`), a rounded shoulder, and the
/// flat y = 0 beyond it, drawn as far as `reach` (all mm). Its lowest point is
/// (0, -(`radius` + `shoulder_radius`)).
pub fn die(radius: f64, shoulder_radius: f64, reach: f64) -> Profile {
    let edge = radius + shoulder_radius;
    Profile::chained(vec![
        Piece::Arc {
            centre: [0.0, -shoulder_radius],
            radius,
            from: -PI,
            to: 0.0,
        },
        Piece::Arc {
            centre: [edge, -shoulder_radius],
            radius: shoulder_radius,
            from: PI,
            to: FRAC_PI_2,
        },
        Piece::Segment {
            start: [edge, 0.0],
            end: [edge.max(reach) + radius, 0.0],
        },
    ])
}

/// The punch before its stroke: a half circle of `radius` with its lowest point at
/// (0, `lowest`), and vertical sides of the given `height` above its centre (all mm).
pub fn punch(radius: f64, lowest: f64, height: f64) -> Profile {
    let centre = lowest + radius;
    Profile::chained(vec![
        Piece::Segment {
            start: [radius, centre + height],
            end: [radius, centre],
        },
        Piece::Arc {
            centre: [0.0, centre],
            radius,
            from: 0.0,
            to: -PI,
        },
        Piece::Segment {
            start: [-radius, centre],
            end: [-radius, centre + height],
        },
    ])
}
