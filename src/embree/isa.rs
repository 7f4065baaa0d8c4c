//! The instruction sets Embree can be limited to.

use std::fmt;
use std::str::FromStr;

/// The greatest instruction set a device may use; results must not depend on
/// it, and tests compare them.
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
    /// AVX-512 as of Skylake: F, DQ, CD, BW and VL.
    Avx512,
}

/// A text that names no instruction set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name:?} is no instruction set: it must be one of sse2, sse4.2, avx, avx2, avx512")]
pub struct UnknownIsa {
    /// The text as given.
    pub name: String,
}

impl MaxIsa {
    /// All of them, the least first.
    pub const ALL: [Self; 5] = [Self::Sse2, Self::Sse42, Self::Avx, Self::Avx2, Self::Avx512];

    /// The name on the command line, which is Embree's own.
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

    /// Those this processor has, the least first; none where it isn't x86-64,
    /// for Embree's code there goes by no name of these.
    #[must_use]
    pub fn available() -> Vec<Self> {
        Self::ALL
            .into_iter()
            .filter(|isa| isa.is_available())
            .collect()
    }

    /// The greatest one this processor has, which is what Embree uses unless
    /// it is limited to less.
    #[must_use]
    pub fn best() -> Option<Self> {
        Self::available().pop()
    }

    /// The name of the one in use where Embree is limited to `limit`, which is none
    /// when it is above the processor's best.
    #[must_use]
    pub fn name_in_use(limit: Option<Self>) -> &'static str {
        Self::in_use(limit).map_or("unknown", Self::name)
    }

    /// The one in use where Embree is limited to `limit`; `None` where its code goes
    /// by no name of these.
    pub(super) fn in_use(limit: Option<Self>) -> Option<Self> {
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
