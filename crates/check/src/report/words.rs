//! Rays, answers, bounds and verdicts as sentences, with numbers that read back as the same.

use glam::DVec3;

use crate::bounding_meshes::hull_list::window_bytes;
use crate::bounding_meshes::window::Window;
use crate::reported_hit::ReportedHit;
use crate::verdict::judge::Wrong;
use crate::verdict::surface::WrongSurface;
use crate::verdict::truth::TrueHit;
use cyltrace::math::Ray;
use cyltrace_output::{figure, readable};

/// A ray: origin, direction, and its range unless that is everything ahead.
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

/// An answer.
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

/// What contains a solid: the scene itself, or placements, outermost first.
pub(crate) fn instance_text(instance: &[u32]) -> String {
    if instance.is_empty() {
        return String::from("the scene itself");
    }
    let numbers: Vec<String> = instance.iter().map(u32::to_string).collect();
    format!("placement {}", numbers.join("/"))
}

/// The bounds of a hit; infinity means a miss.
pub(crate) fn interval_text(low: f64, high: f64) -> String {
    match (low.is_finite(), high.is_finite()) {
        (false, _) => String::from("a miss"),
        (true, false) => format!("a hit from {low:?} on, or a miss"),
        (true, true) => format!("a hit between {low:?} and {high:?}"),
    }
}

/// The exact answer.
pub(crate) fn truth_text(window: &Window, truth: Option<TrueHit>) -> String {
    let Some(TrueHit { t, solid, part }) = truth else {
        return String::from("truly a miss");
    };
    let kind = window.kind(solid).name();
    let what = part.map_or_else(
        || kind.to_owned(),
        |part| format!("{} of {kind}", part.name()),
    );
    let placed = &window.solids[solid as usize];
    let instance = instance_text(&placed.frame.instance);
    format!("truly t {t:?} on {what} {} of {instance}", placed.primitive)
}

/// What is wrong with an answer.
pub(crate) fn wrong_text(wrong: &Wrong) -> String {
    let (low, high) = wrong.allowed();
    match wrong {
        Wrong::Missed(_) => format!("missed: there is a hit between {low:?} and {high:?}"),
        Wrong::Nothing => String::from("a hit, but the ray misses everything"),
        Wrong::Range => String::from("a hit outside of the ray's range"),
        Wrong::Outside(_) => format!("the first hit is between {low:?} and {high:?}"),
        Wrong::Place => String::from("the ray misses the solid that the answer names"),
        Wrong::Solid(_) => {
            format!("the ray hits the solid that the answer names between {low:?} and {high:?}")
        }
        Wrong::Surface(WrongSurface::Part, _) => {
            String::from("the ray cannot hit the part that the answer names")
        }
        Wrong::Surface(WrongSurface::Normal(angle), _) => {
            format!("the normal is off by {angle:.1e} more than allowed")
        }
    }
}

/// A window: its number of solids, its memory, and for each number of sides the solids, or
/// leaves of compositions, that have no inscribed or circumscribed mesh.
pub(crate) fn window_text(
    window: &Window,
    number: u64,
    windows: u64,
    missing: &[(u32, [usize; 2])],
) -> String {
    let place = match &window.bounds {
        None => String::from("the whole scene"),
        Some(bounds) => format!(
            "part {} of {windows}, {} wide about {:.6}",
            number + 1,
            figure(bounds.extent().max_element()),
            bounds.center()
        ),
    };
    let solids = window.count();
    let segments = missing.iter().map(|one| one.0).max().unwrap_or(3);
    let bytes = readable(window_bytes(window, segments));
    let mut text = format!("{place}: {solids} solids, about {bytes} with {segments} sides");
    for (mesh, kind) in ["inscribed", "circumscribed"].into_iter().enumerate() {
        for (segments, counts) in missing.iter().filter(|one| one.1[mesh] > 0) {
            let count = counts[mesh];
            text += &format!("; {count} without {kind} mesh of {segments} sides");
        }
    }
    text
}
