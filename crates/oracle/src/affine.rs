//! Affine maps in exact numbers.

use glam::{DAffine3, DMat3};

use super::number::{Exact, ExactVector};

/// A 3 by 3 matrix, by its rows.
#[derive(Clone, Debug)]
pub struct ExactMatrix([ExactVector; 3]);

impl ExactMatrix {
    /// The image of a vector.
    #[must_use]
    pub fn times(&self, vector: &ExactVector) -> ExactVector {
        ExactVector(std::array::from_fn(|row| self.0[row].dot(vector)))
    }

    /// The image of a vector under the transposed matrix.
    #[must_use]
    pub fn times_from_left(&self, vector: &ExactVector) -> ExactVector {
        ExactVector(self.columns().map(|column| column.dot(vector)))
    }

    fn columns(&self) -> [ExactVector; 3] {
        std::array::from_fn(|column| {
            ExactVector(std::array::from_fn(|row| self.0[row].0[column].clone()))
        })
    }
}

/// The map `x -> L x + translation`.
#[derive(Clone, Debug)]
pub struct ExactAffine {
    matrix: ExactMatrix,
    translation: ExactVector,
}

impl ExactAffine {
    /// The map that moves nothing.
    #[must_use]
    pub fn identity() -> Self {
        Self::new(&DAffine3::IDENTITY)
    }

    /// The exact value of a finite map.
    ///
    /// # Panics
    /// When an entry is not finite.
    #[must_use]
    pub fn new(map: &DAffine3) -> Self {
        Self {
            matrix: ExactMatrix(std::array::from_fn(|row| {
                ExactVector::new(map.matrix3.row(row))
            })),
            translation: ExactVector::new(map.translation),
        }
    }

    /// This map after `inner`.
    #[must_use]
    pub fn after(&self, inner: &Self) -> Self {
        let columns = inner.matrix.columns();
        let matrix = ExactMatrix(std::array::from_fn(|row| {
            ExactVector(std::array::from_fn(|column| {
                self.matrix.0[row].dot(&columns[column])
            }))
        }));
        Self {
            matrix,
            translation: self.point(&inner.translation),
        }
    }

    /// The image of a point.
    #[must_use]
    pub fn point(&self, point: &ExactVector) -> ExactVector {
        &self.matrix.times(point) + &self.translation
    }

    /// The map with every entry rounded to the nearest f64.
    #[must_use]
    pub fn rounded(&self) -> DAffine3 {
        let [x, y, z] = self.matrix.columns().map(|column| column.rounded());
        DAffine3 {
            matrix3: DMat3::from_cols(x, y, z),
            translation: self.translation.rounded(),
        }
    }

    /// The matrix.
    #[must_use]
    pub fn matrix(&self) -> &ExactMatrix {
        &self.matrix
    }

    /// The translation.
    #[must_use]
    pub fn translation(&self) -> &ExactVector {
        &self.translation
    }

    /// The adjugate of the matrix and its determinant; the inverse is their
    /// quotient.
    #[must_use]
    pub fn adjugate(&self) -> (ExactMatrix, Exact) {
        let [x, y, z] = self.matrix.columns();
        let rows = ExactMatrix([y.cross(&z), z.cross(&x), x.cross(&y)]);
        let determinant = rows.0[0].dot(&x);
        (rows, determinant)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::to_f64;

    #[test]
    fn adjugate_undoes_the_matrix() {
        let matrix = DMat3::from_cols(
            DVec3::new(1.0, 2.0, 0.5),
            DVec3::new(-3.0, 0.25, 1.0),
            DVec3::new(0.0, 4.0, 7.0),
        );
        let map = ExactAffine::new(&DAffine3::from_mat3_translation(matrix, DVec3::X));
        let (adjugate, determinant) = map.adjugate();
        assert_eq!(to_f64(&determinant), matrix.determinant());
        let point = ExactVector::new(DVec3::new(0.1, -0.7, 1e-30));
        let moved = &map.point(&point) - map.translation();
        assert_eq!(adjugate.times(&moved).0, point.times(&determinant).0);
        let twice = map.after(&map).point(&point);
        assert_eq!(twice.0, map.point(&map.point(&point)).0);
    }
}
