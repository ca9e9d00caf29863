//! Whether an outline crosses itself.

use super::Piece;
use crate::plane::Vector;

/// Arcs are looked at as chords of at most this angle, radians: they are within 0.1 % of the radius.
const CHORD: f64 = 0.08;
/// How far the last line is followed beyond its end, mm: more than any tool's size.
const FAR: f64 = 1e6;

/// A chord and the piece it belongs to.
struct Chord {
    ends: [Vector; 2],
    piece: usize,
}

/// The first two pieces of a chain that cross, the earlier one first. The last piece goes on for ever if it is straight.
pub(super) fn first_crossing(pieces: &[Piece]) -> Option<[usize; 2]> {
    let chords = chords(pieces);
    for (index, late) in chords.iter().enumerate() {
        // The chord before shares a point with this one.
        let before = &chords[..index.saturating_sub(1)];
        if let Some(early) = before.iter().find(|early| cross(early.ends, late.ends)) {
            return Some([early.piece, late.piece]);
        }
    }
    None
}

fn chords(pieces: &[Piece]) -> Vec<Chord> {
    let mut chords = Vec::new();
    for (piece, shape) in pieces.iter().enumerate() {
        let count = match *shape {
            Piece::Segment { .. } => 1,
            Piece::Arc { from, to, .. } => ((to - from).abs() / CHORD).ceil().max(1.0) as usize,
        };
        let at = |k: usize| shape.at(k as f64 / count as f64);
        chords.extend((0..count).map(|k| Chord {
            ends: [at(k), at(k + 1)],
            piece,
        }));
    }
    if let (Some(&Piece::Segment { start, end }), Some(last)) = (pieces.last(), chords.last_mut()) {
        let length = (end[0] - start[0]).hypot(end[1] - start[1]);
        last.ends[1] = [0, 1].map(|k| end[k] + FAR * (end[k] - start[k]) / length);
    }
    chords
}

/// Whether two segments have a point in common that is no end of both.
fn cross([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> bool {
    let side = |p: Vector, q: Vector, r: Vector| {
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let apart = |s: f64, t: f64| s * t > 0.0;
    let along = |p: Vector, q: Vector, r: Vector, s: Vector| {
        // Four points on one line: their boxes decide.
        [0, 1]
            .iter()
            .all(|&k| p[k].max(q[k]) >= r[k].min(s[k]) && r[k].max(s[k]) >= p[k].min(q[k]))
    };
    !apart(side(a, b, c), side(a, b, d))
        && !apart(side(c, d, a), side(c, d, b))
        && along(a, b, c, d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_cross_or_do_not() {
        let first = [[0.0, 0.0], [2.0, 0.0]];
        assert!(cross(first, [[1.0, -1.0], [1.0, 1.0]]));
        assert!(
            cross(first, [[1.0, 0.0], [1.0, 1.0]]),
            "one ends on the other"
        );
        assert!(cross(first, [[1.0, 0.0], [3.0, 0.0]]), "on one line");
        assert!(!cross(first, [[3.0, 0.0], [4.0, 0.0]]));
        assert!(!cross(first, [[1.0, 0.1], [1.0, 1.0]]));
        assert!(!cross(first, [[2.1, -1.0], [2.1, 1.0]]));
    }
}
