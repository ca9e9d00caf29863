//! Elements to ranks, by METIS on the dual graph.

use super::SheetMesh;

/// The rank of every element.
pub type Partition = Vec<usize>;

/// METIS could not partition the mesh.
#[derive(Debug, thiserror::Error)]
#[error(
    "METIS could not split {elements} elements into {parts} parts ({reason}); run with fewer ranks"
)]
pub struct PartitionError {
    elements: usize,
    parts: usize,
    reason: String,
}

/// Splits the elements into `parts` pieces of nearly equal size with few shared nodes, by METIS's
/// multilevel recursive bisection (Karypis and Kumar, 1998) of the graph of elements that share an
/// edge.
pub fn partition(mesh: &SheetMesh, parts: usize) -> Result<Partition, PartitionError> {
    if parts == 1 {
        return Ok(vec![0; mesh.elements.len()]);
    }
    let failed = |reason: String| PartitionError {
        elements: mesh.elements.len(),
        parts,
        reason,
    };
    let (offsets, neighbours) = dual_graph(mesh.nx, mesh.ny);
    let count = i32::try_from(parts).map_err(|e| failed(e.to_string()))?;
    let mut part = vec![0; mesh.elements.len()];
    metis::Graph::new(1, count, &offsets, &neighbours)
        .map_err(|e| failed(e.to_string()))?
        .part_recursive(&mut part)
        .map_err(|e| failed(e.to_string()))?;
    Ok(part.into_iter().map(|p| p as usize).collect())
}

/// Adjacency of the elements in compressed form: offsets and neighbours.
fn dual_graph(nx: usize, ny: usize) -> (Vec<i32>, Vec<i32>) {
    let mut offsets = vec![0];
    let mut neighbours = Vec::with_capacity(4 * nx * ny);
    for j in 0..ny {
        for i in 0..nx {
            let element = j * nx + i;
            let candidates = [
                (j > 0).then(|| element - nx),
                (i > 0).then(|| element - 1),
                (i + 1 < nx).then(|| element + 1),
                (j + 1 < ny).then(|| element + nx),
            ];
            neighbours.extend(candidates.into_iter().flatten().map(|n| n as i32));
            offsets.push(neighbours.len() as i32);
        }
    }
    (offsets, neighbours)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_gets_its_share() {
        let mesh = SheetMesh::new(60.0, 1.0, 85, 3);
        for parts in 1..=4 {
            let ranks = partition(&mesh, parts).unwrap();
            for part in 0..parts {
                let share = ranks.iter().filter(|&&r| r == part).count() * parts;
                let even = mesh.elements.len();
                assert!(share > even * 9 / 10 && share < even * 11 / 10);
            }
        }
    }
}
