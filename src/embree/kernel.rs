//! Code that is compiled for several instruction sets; one is chosen
//! when the program runs.

use super::isa::MaxIsa;

/// Work that is worth compiling for every instruction set: loops over many
/// numbers, in a `run` that is `#[inline(always)]`, as is all that it calls.
pub trait Kernel {
    /// What comes out.
    type Answer;

    /// Does the work. Answers are the same for every instruction set.
    fn run(self) -> Self::Answer;
}

/// The instructions that this processor has and Embree is allowed to use; from
/// [`Device::instructions`](super::Device::instructions).
#[derive(Clone, Copy, Debug)]
pub struct Instructions(Set);

#[derive(Clone, Copy, Debug)]
enum Set {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Instructions {
    /// Those of the instruction set in use, which the processor has; `None` is
    /// one that goes by no name.
    pub(super) fn of(isa: Option<MaxIsa>) -> Self {
        #[cfg(target_arch = "x86_64")]
        if isa >= Some(MaxIsa::Avx512) {
            return Self(Set::Avx512);
        } else if isa >= Some(MaxIsa::Avx2) {
            return Self(Set::Avx2);
        }
        Self(Set::Baseline)
    }

    /// Runs the work in the version for these instructions.
    #[inline]
    pub fn run<K: Kernel>(self, kernel: K) -> K::Answer {
        match self.0 {
            Set::Baseline => kernel.run(),
            // SAFETY: invariant 9.
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { avx2(kernel) },
            // SAFETY: invariant 9.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { avx512(kernel) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,f16c")]
fn avx2<K: Kernel>(kernel: K) -> K::Answer {
    kernel.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(
    enable = "avx512f,avx512dq,avx512cd,avx512bw,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt,f16c"
)]
fn avx512<K: Kernel>(kernel: K) -> K::Answer {
    kernel.run()
}
