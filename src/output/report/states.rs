//! The saved states of a run, read back from its field files and made small enough for a page.
//!
//! They come from the files and not from memory: so a run that was continued shows its whole past.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hdf5::{Dataset, File, H5Type};
use serde::Serialize;

use super::super::{OutputDir, OutputError};

/// Bytes of packed states that a page may hold; text makes a third more of them.
const BUDGET: usize = 2_400_000;
/// Up to this number of elements their mid-side nodes are kept, and edges are drawn curved.
const CURVED_UP_TO: usize = 600;
/// Steps of a packed value between its least and its greatest.
const STEPS: f64 = 65535.0;

/// States of sheet and contact points, thinned to [`BUDGET`] and rounded to 16 bits; binary arrays are little-endian in
/// base64.
#[derive(Serialize)]
pub(super) struct States {
    /// Times, ms.
    times: Vec<f64>,
    /// Number of states in the files.
    saved: usize,
    /// Nodes per state.
    nodes: usize,
    /// Nodes per element: 8, or 4 without the mid-sides.
    corners: usize,
    /// Node numbers of the elements, 32 bits.
    elements: String,
    /// x and y of each node in each state, 16 bits between the ends of `span`.
    positions: String,
    /// [x least, x greatest, y least, y greatest], mm.
    span: [f64; 4],
    /// Equivalent plastic strain, 16 bits between 0 and `strain_max`.
    strain: String,
    strain_max: f64,
    /// Von Mises stress, 16 bits between 0 and `stress_max` (MPa).
    stress: String,
    stress_max: f64,
    contact: Contact,
}

/// Contact points that carry a force, state by state.
#[derive(Serialize)]
struct Contact {
    /// Place along the undeformed sheet, mm, and 1 for points under the punch, 0 for those on the die.
    along: Vec<f32>,
    upper: Vec<u8>,
    /// Number of points that carry a force in each state.
    counts: Vec<usize>,
    /// For each of them: number of the point, 32 bits.
    points: String,
    /// Pressure and friction (MPa), and x, y (mm): 32-bit floats.
    values: String,
    /// State of each of them, as in the file: 1 stick, 2 slip forward, 3 slip backward.
    status: Vec<i32>,
}

impl States {
    /// Reads the states of the run in `folder`, whose files must be closed.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub(super) fn read(folder: &OutputDir) -> Result<Self, OutputError> {
        let path = folder.fields();
        let failed = |error: hdf5::Error| OutputError::hdf5(&path, "reading it back", error);
        let sheet = Series::open(&path).map_err(failed)?;
        let mesh = Mesh::read(&sheet).map_err(failed)?;
        let keep = thinned(sheet.times.len(), BUDGET / (8 * mesh.nodes.len()).max(1));
        let fields = Fields::read(&sheet, &mesh, &keep).map_err(failed)?;
        let path = folder.contact();
        let failed = |error: hdf5::Error| OutputError::hdf5(&path, "reading it back", error);
        let contact =
            Contact::read(&Series::open(&path).map_err(failed)?, &keep).map_err(failed)?;
        let span = fields.span();
        let greatest = |values: &[f64]| values.iter().copied().fold(1e-12, f64::max);
        let (strain_max, stress_max) = (greatest(&fields.strain), greatest(&fields.stress));
        Ok(Self {
            times: keep.iter().map(|&step| sheet.times[step]).collect(),
            saved: sheet.times.len(),
            nodes: mesh.nodes.len(),
            corners: mesh.corners,
            elements: text(
                mesh.elements
                    .iter()
                    .map(|&node| (node as u32).to_le_bytes()),
            ),
            positions: text(fields.positions.iter().enumerate().map(|(index, &value)| {
                let axis = 2 * (index % 2);
                packed(value, span[axis], span[axis + 1])
            })),
            span,
            strain: text(
                fields
                    .strain
                    .iter()
                    .map(|&value| packed(value, 0.0, strain_max)),
            ),
            strain_max,
            stress: text(
                fields
                    .stress
                    .iter()
                    .map(|&value| packed(value, 0.0, stress_max)),
            ),
            stress_max,
            contact,
        })
    }
}

/// A time series file and its steps.
struct Series {
    file: File,
    times: Vec<f64>,
    points: Vec<[f64; 2]>,
}

impl Series {
    fn open(path: &Path) -> hdf5::Result<Self> {
        let file = File::open(path)?;
        let times = file.dataset("VTKHDF/Steps/Values")?.read_raw()?;
        let points = file.dataset("VTKHDF/Points")?.read_raw::<f64>()?;
        Ok(Self {
            times,
            points: points.chunks_exact(3).map(|x| [x[0], x[1]]).collect(),
            file,
        })
    }

    fn rows(&self, step: usize) -> Range<usize> {
        step * self.points.len()..(step + 1) * self.points.len()
    }

    fn array(&self, name: &str) -> hdf5::Result<Dataset> {
        self.file.dataset(&format!("VTKHDF/PointData/{name}"))
    }

    fn scalars<T: H5Type + Copy>(&self, array: &Dataset, step: usize) -> hdf5::Result<Vec<T>> {
        Ok(array.read_slice_1d::<T, _>(self.rows(step))?.to_vec())
    }

    fn displacements(&self, array: &Dataset, step: usize) -> hdf5::Result<Vec<[f64; 2]>> {
        let rows = array.read_slice_2d::<f64, _>((self.rows(step), 0..2))?;
        Ok(rows.rows().into_iter().map(|x| [x[0], x[1]]).collect())
    }
}

/// The sheet's mesh over all ranks: nodes that several ranks have are there once.
struct Mesh {
    /// Of each node one point of the file.
    nodes: Vec<usize>,
    corners: usize,
    elements: Vec<usize>,
}

impl Mesh {
    fn read(sheet: &Series) -> hdf5::Result<Self> {
        let counts = |name: &str| {
            sheet
                .file
                .dataset(&format!("VTKHDF/{name}"))?
                .read_raw::<i64>()
        };
        let connectivity = counts("Connectivity")?;
        let parts = counts("NumberOfPoints")?;
        let of_part = counts("NumberOfConnectivityIds")?;
        let corners = if connectivity.len() / 8 <= CURVED_UP_TO {
            8
        } else {
            4
        };
        let (mut known, mut nodes, mut elements) = (HashMap::new(), Vec::new(), Vec::new());
        let (mut first_point, mut rest) = (0, &connectivity[..]);
        for (points, ids) in parts.iter().zip(of_part) {
            let (mine, others) = rest.split_at((ids as usize).min(rest.len()));
            for point in mine.chunks_exact(8).flat_map(|element| &element[..corners]) {
                let point = first_point + *point as usize;
                let place = sheet.points[point].map(|x| (x * 1e7).round() as i64);
                elements.push(*known.entry(place).or_insert_with(|| {
                    nodes.push(point);
                    nodes.len() - 1
                }));
            }
            first_point += *points as usize;
            rest = others;
        }
        Ok(Self {
            nodes,
            corners,
            elements,
        })
    }
}

/// Nodal values of all states that are kept.
struct Fields {
    positions: Vec<f64>,
    strain: Vec<f64>,
    stress: Vec<f64>,
}

impl Fields {
    fn read(sheet: &Series, mesh: &Mesh, keep: &[usize]) -> hdf5::Result<Self> {
        let displacement = sheet.array("displacement")?;
        let strain = sheet.array("equivalent_plastic_strain")?;
        let stress = sheet.array("von_mises_stress")?;
        let mut fields = Self {
            positions: Vec::new(),
            strain: Vec::new(),
            stress: Vec::new(),
        };
        for &step in keep {
            let moved = sheet.displacements(&displacement, step)?;
            for &node in &mesh.nodes {
                let (from, by) = (sheet.points[node], moved[node]);
                fields.positions.extend([from[0] + by[0], from[1] + by[1]]);
            }
            let at_nodes = |values: Vec<f64>| mesh.nodes.iter().map(move |&node| values[node]);
            fields
                .strain
                .extend(at_nodes(sheet.scalars(&strain, step)?));
            fields
                .stress
                .extend(at_nodes(sheet.scalars(&stress, step)?));
        }
        Ok(fields)
    }

    fn span(&self) -> [f64; 4] {
        let mut span = [f64::MAX, f64::MIN, f64::MAX, f64::MIN];
        for place in self.positions.chunks_exact(2) {
            for axis in 0..2 {
                span[2 * axis] = span[2 * axis].min(place[axis]);
                span[2 * axis + 1] = span[2 * axis + 1].max(place[axis]);
            }
        }
        span
    }
}

impl Contact {
    fn read(points: &Series, keep: &[usize]) -> hdf5::Result<Self> {
        let displacement = points.array("displacement")?;
        let pressure = points.array("contact_pressure")?;
        let friction = points.array("friction_traction")?;
        let status = points.array("contact_status")?;
        let (mut counts, mut numbers, mut values, mut states) =
            (Vec::new(), Vec::new(), Vec::<f32>::new(), Vec::new());
        for &step in keep {
            let moved = points.displacements(&displacement, step)?;
            let pressures: Vec<f64> = points.scalars(&pressure, step)?;
            let tractions: Vec<f64> = points.scalars(&friction, step)?;
            let status: Vec<i32> = points.scalars(&status, step)?;
            let before = numbers.len();
            for (number, &status) in status.iter().enumerate().filter(|(_, status)| **status > 0) {
                let (from, by) = (points.points[number], moved[number]);
                numbers.push(number as u32);
                states.push(status);
                let place = [from[0] + by[0], from[1] + by[1]];
                values.extend(
                    [pressures[number], tractions[number], place[0], place[1]].map(|v| v as f32),
                );
            }
            counts.push(numbers.len() - before);
        }
        Ok(Self {
            along: points.points.iter().map(|x| x[0] as f32).collect(),
            upper: points.points.iter().map(|x| u8::from(x[1] > 0.0)).collect(),
            counts,
            points: text(numbers.iter().map(|number| number.to_le_bytes())),
            values: text(values.iter().map(|value| value.to_le_bytes())),
            status: states,
        })
    }
}

/// At most `most` of `count` states, evenly spread, always with the first and the last.
fn thinned(count: usize, most: usize) -> Vec<usize> {
    let most = most.max(2);
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|k| k * (count - 1) / (most - 1)).collect()
}

fn packed(value: f64, least: f64, greatest: f64) -> [u8; 2] {
    let share = (value - least) / (greatest - least).max(f64::MIN_POSITIVE);
    // What is not a number is shown as the least.
    ((STEPS * share.clamp(0.0, 1.0)).round() as u16).to_le_bytes()
}

fn text<const N: usize>(bytes: impl Iterator<Item = [u8; N]>) -> String {
    STANDARD.encode(bytes.flatten().collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_both_ends() {
        assert_eq!(thinned(4, 10), [0, 1, 2, 3]);
        assert_eq!(thinned(11, 3), [0, 5, 10]);
        assert_eq!(thinned(7, 0), [0, 6]);
        assert!(thinned(0, 5).is_empty());
    }

    #[test]
    fn values_are_packed_between_their_ends() {
        assert_eq!(packed(-1.0, -1.0, 3.0), [0, 0]);
        assert_eq!(packed(3.0, -1.0, 3.0), [255, 255]);
        assert_eq!(packed(9.0, -1.0, 3.0), [255, 255]);
        assert_eq!(packed(f64::NAN, 0.0, 1.0), [0, 0]);
        assert_eq!(packed(0.0, 0.0, 0.0), [0, 0]);
    }
}
