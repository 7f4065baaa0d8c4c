//! A case as one word, to be passed on and replayed.
//!
//! Of cylinders bit for bit: fifteen numbers in hexadecimal, the bits of their f64, joined by `:` (zero
//! is written `0`): p0, p1, radius, origin, direction, t_min, t_max. The disks
//! come last: `none`, `p0`, `p1` or `both`. Of other solids by what it is drawn from:
//! the name of the family, the inputs, the seed and the index, as in
//! `cone-rim:f32:0:17`.

use glam::DVec3;

use super::family::StressFamily;
use crate::formulations::Problem;
use cyltrace::math::Ray;
use cyltrace::solid::{Caps, Cylinder, CylinderError};
use cyltrace_oracle::cases::{AnyFamily, Case, ComposedCase, Inputs};

const CAPS: [(&str, Caps); 4] = [
    ("none", Caps::None),
    ("p0", Caps::P0),
    ("p1", Caps::P1),
    ("both", Caps::Both),
];

/// Why a word is not a case.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// There are more or fewer parts.
    #[error(
        "a case has 16 parts joined by ':', fifteen numbers and the disks, or 4, family, inputs, \
         seed and index; there are {0}"
    )]
    Parts(usize),
    /// A number is not hexadecimal.
    #[error("{0:?} is not the bits of a number in hexadecimal")]
    Number(String),
    /// The last part is unknown.
    #[error("{0:?} names no disks: it must be none, p0, p1 or both")]
    Caps(String),
    /// The numbers are no cylinder.
    #[error(transparent)]
    Cylinder(#[from] CylinderError),
    /// The numbers are no ray.
    #[error("the ray is not finite, has no direction or an empty range")]
    Ray,
}

/// The word for case `index` of a family.
#[must_use]
pub fn to_word(family: StressFamily, inputs: Inputs, seed: u64, index: u64) -> String {
    match family {
        StressFamily::Solid(AnyFamily::Cylinder(family)) => {
            to_bits(&family.case(seed, index, inputs))
        }
        _ => format!("{}:{}:{seed}:{index}", family.name(), inputs.name()),
    }
}

/// A case of a single solid or of set operations.
#[derive(Clone, Debug, PartialEq)]
pub enum StressCase {
    /// Of a single solid.
    Solid(Case),
    /// Of set operations.
    Composed(ComposedCase),
}

/// The case that a word of [`to_word`] stands for.
///
/// # Errors
/// When the word is malformed or stands for no cylinder and ray.
pub fn from_word(word: &str) -> Result<StressCase, ReplayError> {
    let parts: Vec<&str> = word.trim().split(':').collect();
    if let [family, inputs, seed, index] = parts[..]
        && let Ok(family) = family.parse::<StressFamily>()
        && let Some(inputs) = Inputs::ALL.into_iter().find(|one| one.name() == inputs)
        && let (Ok(seed), Ok(index)) = (seed.parse(), index.parse::<u32>())
    {
        let index = u64::from(index);
        return Ok(match family {
            StressFamily::Solid(family) => StressCase::Solid(family.case(seed, index, inputs)),
            StressFamily::Composed(family) => {
                StressCase::Composed(family.case(seed, index, inputs))
            }
        });
    }
    from_bits(word).map(|problem| StressCase::Solid(problem.into()))
}

/// The word for a cylinder and a ray.
#[must_use]
pub fn to_bits(problem: &Problem) -> String {
    let Problem { cylinder, ray } = problem;
    let ends = [cylinder.p0(), cylinder.p1()].map(|v| v.to_array());
    let line = [ray.origin, ray.direction].map(|v| v.to_array());
    let numbers = [
        ends.as_flattened(),
        &[cylinder.radius()],
        line.as_flattened(),
    ]
    .concat();
    let numbers = numbers.into_iter().chain([ray.t_min, ray.t_max]);
    let mut parts: Vec<String> = numbers.map(|x| format!("{:x}", x.to_bits())).collect();
    let caps = CAPS.iter().find(|(_, caps)| *caps == cylinder.caps());
    parts.extend(caps.map(|(name, _)| (*name).to_owned()));
    parts.join(":")
}

fn from_bits(word: &str) -> Result<Problem, ReplayError> {
    let parts: Vec<&str> = word.trim().split(':').collect();
    let [numbers @ .., caps] = parts.as_slice() else {
        return Err(ReplayError::Parts(parts.len()));
    };
    let numbers: [&str; 15] = numbers
        .try_into()
        .map_err(|_| ReplayError::Parts(parts.len()))?;
    let mut values = [0.0; 15];
    for (value, text) in values.iter_mut().zip(numbers) {
        let bits = u64::from_str_radix(text, 16);
        *value = f64::from_bits(bits.map_err(|_| ReplayError::Number(text.to_owned()))?);
    }
    let known = CAPS.iter().find(|(name, _)| name == caps);
    let (_, caps) = *known.ok_or_else(|| ReplayError::Caps((*caps).to_owned()))?;

    let vector = |first: usize| DVec3::from_slice(&values[first..first + 3]);
    let cylinder = Cylinder::new(vector(0), vector(3), values[6], caps)?;
    let ray = Ray {
        origin: vector(7),
        direction: vector(10),
        t_min: values[13],
        t_max: values[14],
    };
    if !ray.is_valid() {
        return Err(ReplayError::Ray);
    }
    Ok(Problem { cylinder, ray })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace_oracle::cases::{ComposedFamily, Family};

    #[test]
    fn word_read_back_is_the_same_case() {
        for family in AnyFamily::all() {
            let case = family.case(1, 2, Inputs::F64);
            let word = to_word(family.into(), Inputs::F64, 1, 2);
            assert_eq!(from_word(&word), Ok(StressCase::Solid(case)), "{word}");
        }
        for family in ComposedFamily::ALL {
            let case = family.case(1, 2, Inputs::F64);
            let word = to_word(family.into(), Inputs::F64, 1, 2);
            assert_eq!(from_word(&word), Ok(StressCase::Composed(case)), "{word}");
        }
    }

    #[test]
    fn malformed_words_are_refused_with_their_reason() {
        let good = to_bits(&Family::Nominal.case(1, 2, Inputs::F64));
        let error = |word: &str| from_bits(word).unwrap_err().to_string();
        assert!(error("").contains("16 parts"));
        assert!(from_word("cone-knot:f32:0:1").is_err() && from_word("cone-rim:f16:0:1").is_err());
        assert!(error(&good.replace("both", "all")).contains("\"all\""));
        assert!(error(&format!("zz{good}")).contains("hexadecimal"));
        let zero_ray = format!(
            "{}:0:0:0:0:0:both",
            good.split(':').take(10).collect::<Vec<_>>().join(":")
        );
        assert!(error(&zero_ray).contains("no direction"));
    }
}
