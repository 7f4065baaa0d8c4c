//! The numbers with which decisions are computed.

use std::cmp::Ordering;

/// A number type for the decisions.
pub(in crate::solid) trait Number: Clone {
    /// The number of an f64.
    fn of(x: f64) -> Self;
    /// `a - b`, exactly.
    fn difference(a: f64, b: f64) -> Self;
    /// The sum.
    fn plus(&self, other: &Self) -> Self;
    /// The difference.
    fn minus(&self, other: &Self) -> Self;
    /// The product.
    fn times(&self, other: &Self) -> Self;
    /// The comparison with zero, if it is certain.
    fn sign(&self) -> Option<Ordering>;
}
