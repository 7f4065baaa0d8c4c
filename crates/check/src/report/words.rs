//! Rays, answers and bounds in words, with numbers that read back as the same.

use glam::DVec3;

use crate::finding::ReportedHit;
use cyltrace::math::Ray;

/// A ray: origin, direction, and its range where that is not everything ahead.
pub(crate) fn ray_text(ray: &Ray) -> String {
    let mut text = format!(
        "o {} d {}",
        point_text(ray.origin),
        point_text(ray.direction)
    );
    if ray.t_min != 0.0 || ray.t_max != f64::INFINITY {
        text += &format!(" t {:?} to {:?}", ray.t_min, ray.t_max);
    }
    text
}

fn point_text(point: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", point.x, point.y, point.z)
}

/// An answer in words.
pub(crate) fn answer_text(answer: Option<&ReportedHit>) -> String {
    let Some(answer) = answer else {
        return String::from("a miss");
    };
    let mut text = format!("t {:?}", answer.t);
    if let Some(place) = &answer.place {
        text += &format!(
            " on {} of solid {} of {}",
            place.part.name(),
            place.primitive,
            instance_text(&place.instance)
        );
    }
    if let Some(normal) = answer.normal {
        text += &format!(", normal {}", point_text(normal));
    }
    text
}

/// What holds a solid: the scene itself, or placements, outermost first.
pub(crate) fn instance_text(instance: &[u32]) -> String {
    if instance.is_empty() {
        return String::from("the scene itself");
    }
    let numbers: Vec<String> = instance.iter().map(u32::to_string).collect();
    format!("placement {}", numbers.join("/"))
}

/// The bounds of a hit in words; infinity stands for a miss.
pub(crate) fn interval_text(low: f64, high: f64) -> String {
    match (low.is_finite(), high.is_finite()) {
        (false, _) => String::from("a miss"),
        (true, false) => format!("a hit from {low:?} on, or a miss"),
        (true, true) => format!("a hit between {low:?} and {high:?}"),
    }
}
