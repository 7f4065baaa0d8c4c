//! The part of light that an interface reflects, by Fresnel.

use glam::DVec3;

/// The reflectance of an interface for unpolarized light, and the cosine of the refracted
/// direction; 1 and 0 for total reflection.
///
/// `cosine` is that of the angle to the normal on the light's side, and `relative_ior` the index
/// of refraction of the far side over that of the near side, η. By Snell's law the refracted sine
/// is `sin / η`, and the amplitudes parallel and perpendicular to the plane are
/// `(η cos - cos') / (η cos + cos')` and `(cos - η cos') / (cos + η cos')`.
pub(super) fn dielectric(cosine: f64, relative_ior: f64) -> (f64, f64) {
    let squared_sine = (1.0 - cosine * cosine).max(0.0) / (relative_ior * relative_ior);
    if squared_sine >= 1.0 {
        return (1.0, 0.0);
    }
    let refracted = (1.0 - squared_sine).sqrt();
    let parallel = (relative_ior * cosine - refracted) / (relative_ior * cosine + refracted);
    let perpendicular = (cosine - relative_ior * refracted) / (cosine + relative_ior * refracted);
    let reflectance = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    (reflectance, refracted)
}

/// Schlick's approximation for a metal whose reflectance is `vertical` where light comes in
/// vertically: `F + (1 - F) (1 - cos)^5` (C. Schlick, "An Inexpensive BRDF Model for
/// Physically-based Rendering", 1994). It is within some percent of the exact reflectance of
/// common metals, and exact at both ends.
pub(super) fn schlick(vertical: DVec3, cosine: f64) -> DVec3 {
    let rest = 1.0 - cosine;
    let square = rest * rest;
    vertical + (DVec3::ONE - vertical) * (square * square * rest)
}

/// The mean of [`schlick`] over a hemisphere weighted by the cosine, `∫ 2 cos F d cos`:
/// `F + (1 - F) / 21`.
pub(super) fn schlick_mean(vertical: DVec3) -> DVec3 {
    vertical + (DVec3::ONE - vertical) / 21.0
}
