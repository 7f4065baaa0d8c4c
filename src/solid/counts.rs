//! The number of solids of each kind.

use std::fmt;
use std::ops::Index;

use super::SolidKind;

/// The number of kinds.
const KINDS: usize = SolidKind::SIMPLE.len() + SolidKind::OPERATIONS.len();

/// The number of solids of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SolidCounts([u128; KINDS]);

impl SolidCounts {
    /// Adds solids of a kind.
    pub fn add(&mut self, kind: SolidKind, more: u128) {
        let count = &mut self.0[kind as usize];
        *count = count.saturating_add(more);
    }

    /// These and others.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        for (kind, count) in other.iter() {
            self.add(kind, count);
        }
        self
    }

    /// As many times these.
    #[must_use]
    pub fn times(self, factor: u128) -> Self {
        Self(self.0.map(|count| count.saturating_mul(factor)))
    }

    /// The solids of all kinds.
    #[must_use]
    pub fn total(&self) -> u128 {
        self.0
            .iter()
            .fold(0, |sum, &count| sum.saturating_add(count))
    }

    /// The kinds with at least one solid, with their counts.
    pub fn iter(&self) -> impl Iterator<Item = (SolidKind, u128)> {
        let counts = SolidKind::all().map(|kind| (kind, self[kind]));
        counts.filter(|(_, count)| *count > 0)
    }
}

impl Index<SolidKind> for SolidCounts {
    type Output = u128;

    fn index(&self, kind: SolidKind) -> &u128 {
        &self.0[kind as usize]
    }
}

/// As in "2 spheres, 1 rounded cone".
impl fmt::Display for SolidCounts {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let counts = self.iter().map(|(kind, count)| match count {
            1 => format!("1 {kind}"),
            u128::MAX => format!("more {} than can be counted", kind.plural()),
            _ => format!("{count} {}", kind.plural()),
        });
        let text = counts.collect::<Vec<_>>().join(", ").replace('_', " ");
        formatter.write_str(if text.is_empty() { "no solids" } else { &text })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_added_by_kind_and_printed_in_words() {
        let mut counts = SolidCounts::default();
        assert_eq!(counts.to_string(), "no solids");
        counts.add(SolidKind::RoundedCone, 1);
        counts.add(SolidKind::Sphere, 2);
        counts.add(SolidKind::Difference, 3);
        assert_eq!(
            counts.to_string(),
            "2 spheres, 1 rounded cone, 3 differences"
        );
        assert_eq!((counts.total(), counts.plus(&counts).total()), (6, 12));
        assert_eq!(counts.times(u128::MAX)[SolidKind::Sphere], u128::MAX);
    }
}
