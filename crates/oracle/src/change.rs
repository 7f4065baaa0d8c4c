//! How far the numbers of a case are from making one of its conditions zero.
//!
//! To first order, the least change that brings a polynomial F of the numbers `v` to
//! zero, the same *relative* change for all, is `|F| / Σ |v ∂F/∂v|`. `v ∂F/∂v` is taken
//! as `(F(v + v/2^40) - F(v)) 2^40`, from exact values: the rest of the second
//! order is below 2^-30 of it for the polynomials in question, which have degrees
//! below 20.

use super::number::{Exact, exact, long, to_f64};
use cyltrace::math::power_of_two;

/// The least change of any of the conditions.
pub(super) fn least_change(
    mut numbers: Vec<Exact>,
    conditions: impl Fn(&[Exact]) -> Vec<Exact>,
) -> f64 {
    let values = conditions(&numbers);
    let mut changes = vec![exact(0.0); values.len()];
    let (step, steps) = (exact(power_of_two(-40)), exact(power_of_two(40)));
    for i in 0..numbers.len() {
        let stated = numbers[i].clone();
        numbers[i] = &stated + &stated * &step;
        for (j, moved) in conditions(&numbers).into_iter().enumerate() {
            let by = moved - &values[j];
            changes[j] = &changes[j] + if by < exact(0.0) { -by } else { by };
        }
        numbers[i] = stated;
    }
    let gap = |(value, change): (&Exact, &Exact)| {
        if *value == exact(0.0) {
            return 0.0;
        }
        (to_f64(&(long(value) / long(&(change * &steps))))).abs()
    };
    values
        .iter()
        .zip(&changes)
        .map(gap)
        .fold(f64::INFINITY, f64::min)
}
