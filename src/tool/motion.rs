//! The punch's motion in time: down by the stroke, then up again.

/// Stroke against time, linear in each phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PunchMotion {
    /// Full stroke, mm.
    pub stroke: f64,
    /// Share of the stroke by which the punch goes back.
    pub unload_fraction: f64,
    /// Duration of the stroke, ms.
    pub time_load: f64,
    /// Duration of the travel back, ms.
    pub time_unload: f64,
}

impl PunchMotion {
    /// How far the punch is down at time `t` (ms), mm.
    pub fn depth(&self, t: f64) -> f64 {
        let back = ((t - self.time_load) / self.time_unload).clamp(0.0, 1.0);
        let down = (t / self.time_load).clamp(0.0, 1.0);
        self.stroke * (down - self.unload_fraction * back)
    }

    /// How far the punch has travelled at time `t` (ms), down and back together, mm.
    pub fn travel(&self, t: f64) -> f64 {
        if t <= self.time_load {
            self.depth(t)
        } else {
            2.0 * self.stroke - self.depth(t)
        }
    }

    /// The end of the whole motion, ms.
    pub fn end(&self) -> f64 {
        if self.unload_fraction > 0.0 {
            self.time_load + self.time_unload
        } else {
            self.time_load
        }
    }

    /// The time of the downward travel at which the punch is at `depth` (mm), ms.
    pub fn time_at_depth(&self, depth: f64) -> f64 {
        self.time_load * depth / self.stroke
    }

    /// The time of the travel back at which the punch has gone back by `way` (mm), ms.
    pub fn time_at_return(&self, way: f64) -> f64 {
        self.time_load + self.time_unload * way / (self.unload_fraction * self.stroke)
    }
}

/// How a tool moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Not at all.
    Fixed,
    /// Down and up again.
    Down(PunchMotion),
}

impl Motion {
    /// Displacement at time `t` (ms), mm.
    pub fn shift(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Fixed => [0.0, 0.0],
            Self::Down(motion) => [0.0, -motion.depth(t)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_hit_exactly() {
        let motion = PunchMotion {
            stroke: 28.5,
            unload_fraction: 0.1,
            time_load: 900.0,
            time_unload: 100.0,
        };
        assert_eq!(motion.depth(0.0), 0.0);
        assert_eq!(motion.depth(900.0), 28.5);
        assert!((motion.depth(1000.0) - 25.65).abs() < 1e-14);
        assert_eq!(motion.end(), 1000.0);
        assert!((motion.travel(1000.0) - 31.35).abs() < 1e-12 && motion.travel(450.0) == 14.25);
        assert!((motion.depth(motion.time_at_depth(10.0)) - 10.0).abs() < 1e-14);
        assert!((motion.depth(motion.time_at_return(1.0)) - 27.5).abs() < 1e-14);
    }
}
