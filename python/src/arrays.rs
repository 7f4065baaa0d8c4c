//! Arrays as the Python part of the package hands them over: contiguous, in f64, of the
//! right shape. What is wrong with a single row is found here.

use cyltrace::math::Ray;
use glam::{DQuat, DVec3};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A point or direction a row, or the same one for all rows.
#[derive(Clone, Copy)]
pub struct Vectors<'a>(&'a [f64]);

impl<'a> Vectors<'a> {
    /// An array of shape `(n, 3)`, or `(1, 3)` for all rows.
    ///
    /// # Errors
    /// When it is not contiguous.
    pub fn of(array: &'a PyReadonlyArray2<'_, f64>) -> PyResult<Self> {
        Ok(Self(array.as_slice()?))
    }

    /// The number of rows.
    pub fn len(self) -> usize {
        self.0.len() / 3
    }

    /// The vector of a row.
    pub fn row(self, row: usize) -> DVec3 {
        let row = if self.0.len() == 3 { 0 } else { row };
        DVec3::from_slice(&self.0[3 * row..])
    }
}

/// A number a row, or the same one for all rows.
#[derive(Clone, Copy)]
pub struct Numbers<'a, T = f64>(&'a [T]);

impl<'a, T: Copy + numpy::Element> Numbers<'a, T> {
    /// An array of shape `(n,)`, or `(1,)` for all rows.
    ///
    /// # Errors
    /// When it is not contiguous.
    pub fn of(array: &'a PyReadonlyArray1<'_, T>) -> PyResult<Self> {
        Ok(Self(array.as_slice()?))
    }

    /// The number of rows.
    pub fn len(self) -> usize {
        self.0.len()
    }

    /// The number of a row.
    pub fn row(self, row: usize) -> T {
        self.0[if self.0.len() == 1 { 0 } else { row }]
    }
}

/// A quaternion a row.
#[derive(Clone, Copy)]
pub struct Quaternions<'a>(&'a [f64]);

impl<'a> Quaternions<'a> {
    /// An array of shape `(n, 4)`, or `(1, 4)` for all rows.
    ///
    /// # Errors
    /// When it is not contiguous.
    pub fn of(array: &'a PyReadonlyArray2<'_, f64>) -> PyResult<Self> {
        Ok(Self(array.as_slice()?))
    }

    /// The quaternion `x, y, z, w` of a row, of any length.
    pub fn row(self, row: usize) -> DQuat {
        let row = if self.0.len() == 4 { 0 } else { row };
        DQuat::from_slice(&self.0[4 * row..])
    }
}

/// The rays of a query.
pub struct Rays<'a> {
    pub origins: Vectors<'a>,
    pub directions: Vectors<'a>,
    pub t_min: Numbers<'a>,
    pub t_max: Numbers<'a>,
}

impl Rays<'_> {
    /// How many there are.
    pub fn len(&self) -> usize {
        let vectors = self.origins.len().max(self.directions.len());
        vectors.max(self.t_min.len()).max(self.t_max.len())
    }

    /// The rays with these numbers.
    ///
    /// # Errors
    /// When a number is NaN or beyond what can be traced: which one.
    pub fn rows(&self, rows: std::ops::Range<usize>) -> Result<Vec<Ray>, String> {
        rows.map(|row| self.row(row)).collect()
    }

    fn row(&self, row: usize) -> Result<Ray, String> {
        let ray = Ray {
            origin: self.origins.row(row),
            direction: self.directions.row(row),
            t_min: self.t_min.row(row),
            t_max: self.t_max.row(row),
        };
        if let Err(error) = ray.check_sizes() {
            return Err(format!("ray {row}: {error}"));
        }
        for (name, limit) in [("t_min", ray.t_min), ("t_max", ray.t_max)] {
            if limit.is_nan() {
                return Err(format!("ray {row}: {name} is nan: it must be a number"));
            }
        }
        Ok(ray)
    }
}

/// A message as a `ValueError`.
pub fn value_error(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}
