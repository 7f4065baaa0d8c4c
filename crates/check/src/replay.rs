//! The ray that a replay looks at, and the word that names it.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use cyltrace::math::Ray;

use super::settings::Class;

/// A ray to look at again.
///
/// As text, `class:index`, or eight numbers of f64 by their bits in
/// hexadecimal digits, with colons between: origin, direction, `t_min`, `t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Replay {
    /// A ray of a check with the same scene and settings.
    Drawn {
        /// Its class.
        class: Class,
        /// Its number in the class.
        index: u64,
    },
    /// Any ray. If f32 does not represent it in the space of the meshes, the nearest ray that
    /// it represents is used.
    Given(Ray),
}

/// The form of a word.
const FORM: &str = "it must be CLASS:INDEX, such as grazing:17, or a ray as a run printed it: \
    8 numbers of 16 hexadecimal digits, separated by colons";

impl fmt::Display for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Drawn { class, index } => write!(f, "{class}:{index}"),
            Self::Given(ray) => {
                let (o, d) = (ray.origin, ray.direction);
                let numbers = [o.x, o.y, o.z, d.x, d.y, d.z, ray.t_min, ray.t_max];
                let bits = numbers.map(|x| format!("{:016x}", x.to_bits()));
                f.write_str(&bits.join(":"))
            }
        }
    }
}

impl FromStr for Replay {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(':').collect();
        if let [class, index] = parts[..] {
            let index = index
                .parse()
                .map_err(|_| format!("`{index}` is not the number of a ray: {FORM}"))?;
            let class = class.parse()?;
            return Ok(Self::Drawn { class, index });
        }
        let numbers = parts
            .iter()
            .map(|bits| u64::from_str_radix(bits, 16).map(f64::from_bits));
        let bits: Vec<f64> = numbers
            .collect::<Result<_, _>>()
            .map_err(|_| FORM.to_owned())?;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = bits[..] else {
            return Err(FORM.to_owned());
        };
        let ray = Ray {
            origin: DVec3::new(ox, oy, oz),
            direction: DVec3::new(dx, dy, dz),
            t_min,
            t_max,
        };
        if !ray.is_valid() {
            return Err(format!(
                "the numbers are no ray: origin {origin}, direction {direction}, t from {t_min:?} to {t_max:?}",
                origin = ray.origin,
                direction = ray.direction
            ));
        }
        Ok(Self::Given(ray))
    }
}
