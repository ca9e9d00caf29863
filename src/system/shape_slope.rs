//! Derivatives of what is read off the shape of the sheet: point A's displacement and the angle between the arms.
//!
//! The angle is that of the best rigid motion of the arm ([`super::measures`]), a function of sums of products of
//! reference and present positions; their derivatives are exact.

use mpi::traits::Communicator;

use super::measures::ARM_START;
use super::subdomain::Subdomain;
use crate::ranks;

/// This rank's sums over the nodes of the arm, and their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShapeSlopes {
    /// Of point A's displacement in y, mm.
    point_a: f64,
    nodes: f64,
    /// Sums of reference position from the sheet's end and present position, value and derivative.
    from: [[f64; 2]; 2],
    now: [[f64; 2]; 2],
    /// X·x and X_1 x_2 - X_2 x_1 likewise.
    along: [f64; 2],
    across: [f64; 2],
}

impl Subdomain {
    /// For displacements `u` with derivatives `du` (local), and derivatives of the coordinates, all per unit of the
    /// parameter.
    pub fn shape_slopes(
        &self,
        u: &[f64],
        du: &[f64],
        by_coordinate: impl Fn(usize) -> [f64; 2],
    ) -> ShapeSlopes {
        let mesh = &self.problem.mesh;
        let half_length = mesh.nodes.iter().fold(0.0_f64, |m, x| m.max(x[0]));
        let mut sums = ShapeSlopes::default();
        let owned = self
            .nodes
            .iter()
            .enumerate()
            .filter(|(n, _)| self.owned[*n]);
        for (n, &node) in owned {
            if node == mesh.point_a {
                sums.point_a += du[2 * n + 1];
            }
            let [x, y] = self.coordinates[n];
            if x >= ARM_START * half_length {
                let moved = by_coordinate(n);
                let now = [x + u[2 * n], y + u[2 * n + 1]];
                let slope = [moved[0] + du[2 * n], moved[1] + du[2 * n + 1]];
                sums.add([[x - half_length, y], moved], [now, slope]);
            }
        }
        sums
    }
}

impl ShapeSlopes {
    /// Adds a node with reference and present position, each with its derivative.
    fn add(&mut self, [from, from_slope]: [[f64; 2]; 2], [now, now_slope]: [[f64; 2]; 2]) {
        self.nodes += 1.0;
        for k in 0..2 {
            self.from[0][k] += from[k];
            self.from[1][k] += from_slope[k];
            self.now[0][k] += now[k];
            self.now[1][k] += now_slope[k];
        }
        self.along[0] += dot(from, now);
        self.along[1] += dot(from_slope, now) + dot(from, now_slope);
        self.across[0] += cross(from, now);
        self.across[1] += cross(from_slope, now) + cross(from, now_slope);
    }

    /// Derivatives of point A's displacement (mm) and of the angle (degrees) of the whole sheet. Collective.
    pub fn over_ranks(&self, comm: &impl Communicator) -> [f64; 2] {
        let Self {
            point_a,
            nodes,
            from: [[fx, fy], [dfx, dfy]],
            now: [[nx, ny], [dnx, dny]],
            along: [along, by_along],
            across: [across, by_across],
        } = *self;
        let mine = [
            point_a, nodes, fx, fy, dfx, dfy, nx, ny, dnx, dny, along, by_along, across, by_across,
        ];
        let [
            point_a,
            n,
            fx,
            fy,
            dfx,
            dfy,
            nx,
            ny,
            dnx,
            dny,
            along,
            by_along,
            across,
            by_across,
        ] = ranks::sums(comm, mine);
        let ([from, by_from], [now, by_now]) = ([[fx, fy], [dfx, dfy]], [[nx, ny], [dnx, dny]]);
        let along = along - dot(from, now) / n;
        let by_along = by_along - (dot(by_from, now) + dot(from, by_now)) / n;
        let across = across - cross(from, now) / n;
        let by_across = by_across - (cross(by_from, now) + cross(from, by_now)) / n;
        let turned = (along * by_across - across * by_along) / (along * along + across * across);
        [point_a, -2.0 * turned.to_degrees()]
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
