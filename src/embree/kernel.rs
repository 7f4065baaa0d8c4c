//! Code that is compiled for several instruction sets. One of the versions is chosen at run
//! time.

use super::isa::MaxIsa;

/// Work that is worth compiling for every instruction set: a loop over many numbers. `run` and
/// all that it calls are `#[inline(always)]`.
pub trait Kernel {
    /// The result.
    type Answer;

    /// Does the work. The result is the same for every instruction set.
    fn run(self) -> Self::Answer;
}

/// The instructions that this processor supports and that Embree may use; from
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
    /// The instructions of the set in use, which the processor supports. `None` is an unnamed
    /// set.
    pub(super) fn of(isa: Option<MaxIsa>) -> Self {
        #[cfg(target_arch = "x86_64")]
        if isa >= Some(MaxIsa::Avx512) {
            return Self(Set::Avx512);
        } else if isa >= Some(MaxIsa::Avx2) {
            return Self(Set::Avx2);
        }
        Self(Set::Baseline)
    }

    /// Runs the version for these instructions.
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
