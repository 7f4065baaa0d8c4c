//! The instruction sets that Embree can be limited to.

use std::fmt;
use std::str::FromStr;

/// The greatest instruction set that a device may use. Results do not depend on it; tests
/// compare them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MaxIsa {
    /// SSE2, which every x86-64 processor has.
    Sse2,
    /// SSE4.2.
    Sse42,
    /// AVX.
    Avx,
    /// AVX2 with FMA3.
    Avx2,
    /// AVX-512 as in Skylake: F, DQ, CD, BW and VL.
    Avx512,
}

/// A name that is not that of an instruction set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name:?} is no instruction set: it must be one of sse2, sse4.2, avx, avx2, avx512")]
pub struct UnknownIsa {
    /// The text as given.
    pub name: String,
}

impl MaxIsa {
    /// All sets, the least first.
    pub const ALL: [Self; 5] = [Self::Sse2, Self::Sse42, Self::Avx, Self::Avx2, Self::Avx512];

    /// Embree's own name of the set, also used on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sse2 => "sse2",
            Self::Sse42 => "sse4.2",
            Self::Avx => "avx",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The sets that this processor supports, the least first. Empty if the processor is not
    /// x86-64: no name here applies to Embree's code there.
    #[must_use]
    pub fn available() -> Vec<Self> {
        Self::ALL
            .into_iter()
            .filter(|isa| isa.is_available())
            .collect()
    }

    /// The greatest set that this processor supports. Embree uses it unless it is limited.
    #[must_use]
    pub fn best() -> Option<Self> {
        Self::available().pop()
    }

    /// The name of the set that Embree uses with this limit: the lesser of the limit and the
    /// processor's best. `"unknown"` if the processor is not x86-64.
    #[must_use]
    pub fn name_in_use(limit: Option<Self>) -> &'static str {
        Self::in_use(limit).map_or("unknown", Self::name)
    }

    /// The set that Embree uses with this limit; `None` if the processor is not x86-64.
    pub(crate) fn in_use(limit: Option<Self>) -> Option<Self> {
        Self::lesser(limit, Self::best())
    }

    fn lesser(limit: Option<Self>, best: Option<Self>) -> Option<Self> {
        best.map(|best| limit.map_or(best, |limit| limit.min(best)))
    }

    #[cfg(target_arch = "x86_64")]
    fn is_available(self) -> bool {
        use std::arch::is_x86_feature_detected as has;
        match self {
            Self::Sse2 => has!("sse2"),
            Self::Sse42 => has!("sse4.2") && has!("popcnt"),
            Self::Avx => has!("avx") && Self::Sse42.is_available(),
            Self::Avx2 => {
                has!("avx2")
                    && has!("fma")
                    && has!("f16c")
                    && has!("lzcnt")
                    && has!("bmi1")
                    && has!("bmi2")
                    && Self::Avx.is_available()
            }
            Self::Avx512 => {
                has!("avx512f")
                    && has!("avx512dq")
                    && has!("avx512cd")
                    && has!("avx512bw")
                    && has!("avx512vl")
                    && Self::Avx2.is_available()
            }
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn is_available(self) -> bool {
        false
    }
}

impl fmt::Display for MaxIsa {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl FromStr for MaxIsa {
    type Err = UnknownIsa;

    fn from_str(name: &str) -> Result<Self, UnknownIsa> {
        Self::ALL
            .into_iter()
            .find(|isa| isa.name() == name)
            .ok_or_else(|| UnknownIsa { name: name.into() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_above_the_best_is_not_in_use() {
        let (less, more) = (Some(MaxIsa::Avx), Some(MaxIsa::Avx512));
        assert_eq!(MaxIsa::lesser(more, less), less);
        assert_eq!(MaxIsa::lesser(less, more), less);
        assert_eq!(MaxIsa::lesser(None, more), more);
        assert_eq!(MaxIsa::lesser(more, None), None);
    }
}
