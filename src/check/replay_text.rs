//! A ray as one word, bit for bit, to be passed on and replayed: its origin,
//! its direction, `t_min` and `t_max` as the bits of their f64 in hexadecimal,
//! joined by `:`.

use glam::DVec3;

use crate::math::Ray;

/// Why a word is not a ray.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RayTextError {
    /// There are more or fewer parts.
    #[error("a ray has 8 parts joined by ':'; there are {0}")]
    Parts(usize),
    /// A part is not hexadecimal.
    #[error("{0:?} is not the bits of a number in hexadecimal")]
    Number(String),
    /// The numbers are no ray.
    #[error("the ray is not finite, has no direction or an empty range")]
    Ray,
}

/// The word for a ray.
#[must_use]
pub fn ray_to_text(ray: &Ray) -> String {
    let [o, d] = [ray.origin, ray.direction];
    let numbers = [o.x, o.y, o.z, d.x, d.y, d.z, ray.t_min, ray.t_max];
    numbers.map(|x| format!("{:x}", x.to_bits())).join(":")
}

/// The ray that a word stands for.
///
/// # Errors
/// When the word is malformed or stands for no ray that can hit.
pub fn ray_from_text(text: &str) -> Result<Ray, RayTextError> {
    let parts: Vec<&str> = text.trim().split(':').collect();
    let parts: [&str; 8] = parts
        .try_into()
        .map_err(|parts: Vec<&str>| RayTextError::Parts(parts.len()))?;
    let mut values = [0.0; 8];
    for (value, part) in values.iter_mut().zip(parts) {
        let bits = u64::from_str_radix(part, 16);
        *value = f64::from_bits(bits.map_err(|_| RayTextError::Number(part.to_owned()))?);
    }
    let ray = Ray {
        origin: DVec3::from_slice(&values[..3]),
        direction: DVec3::from_slice(&values[3..6]),
        t_min: values[6],
        t_max: values[7],
    };
    if ray.is_valid() {
        Ok(ray)
    } else {
        Err(RayTextError::Ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn word_read_back_is_the_same_ray() {
        let ray = Ray::new(DVec3::new(0.1, -0.0, 3e300), DVec3::new(1.0, 5e-324, -7.0));
        assert_eq!(ray_from_text(&ray_to_text(&ray)), Ok(ray));
    }

    #[test]
    fn malformed_words_are_refused_with_their_reason() {
        assert_eq!(ray_from_text("1:2"), Err(RayTextError::Parts(2)));
        let words = ["0:0:0:x:0:0:0:0", "0:0:0:0:0:0:0:0"].map(ray_from_text);
        assert_eq!(words[0], Err(RayTextError::Number("x".into())));
        assert_eq!(words[1], Err(RayTextError::Ray));
    }
}
