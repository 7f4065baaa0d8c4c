//! Wavefront OBJ: `v` and `f` lines, and a `g` line for each placed prototype.
//!
//! A group is named after its prototype and the numbers of the placements from
//! the scene inward, as `trace` reports them: `tree/3/0`. The group of the scene's
//! own solids is `scene`. Characters with a meaning in OBJ or to its readers become
//! `_`. Numbers are f64 in the shortest form that reads back exactly.

use std::fmt::Write as _;
use std::io::Write;

use crate::meshes::walk::{Instance, instances};
use crate::meshes::{AT_ONCE, MeshFileError, Plan, Progress, proceed};
use crate::scene::Scene;
use crate::solid::tessellation::triangles_of;

/// Characters of the longest f64 in its shortest form: a sign, 17 digits, a
/// point, and `e-308` or the zeros of `0.0000`.
const LONGEST_NUMBER: u128 = 24;

/// The name of the root's own group.
const ROOT: &str = "scene";

pub(super) fn write(
    scene: &Scene,
    plan: &Plan,
    name: &str,
    writer: &mut dyn Write,
    progress: &mut Progress,
) -> Result<(), MeshFileError> {
    writer.write_all(comment(plan, name).as_bytes())?;
    let mut text = String::new();
    // OBJ counts from 1.
    let mut first = 1_u64;
    instances(scene, &mut |instance| {
        text.clear();
        push_group(&mut text, instance);
        for (_, solid) in instance.prototype.singles() {
            let vertices = instance.vertices(&solid, plan.segments(), plan.fit());
            for vertices in vertices.chunks(AT_ONCE) {
                for vertex in vertices {
                    let _ = writeln!(text, "v {:?} {:?} {:?}", vertex.x, vertex.y, vertex.z);
                }
                writer.write_all(text.as_bytes())?;
                text.clear();
                proceed(progress, vertices.len())?;
            }
            let triangles = triangles_of(&solid, plan.segments());
            for triangles in triangles.chunks(AT_ONCE) {
                for &triangle in triangles {
                    let [a, b, c] = instance
                        .outward(triangle)
                        .map(|corner| first + u64::from(corner));
                    let _ = writeln!(text, "f {a} {b} {c}");
                }
                writer.write_all(text.as_bytes())?;
                text.clear();
                proceed(progress, triangles.len())?;
            }
            first += vertices.len() as u64;
        }
        Ok(())
    })
}

/// An upper bound of the size of the file.
pub(super) fn most_bytes(plan: &Plan, name: &str) -> u128 {
    let digits = 1 + u128::from(plan.vertices().checked_ilog10().unwrap_or(0));
    let (names, groups) = plan.group_names();
    let parts = [
        // "v x y z" and "f a b c", with the end of the line.
        (plan.vertices(), 5 + 3 * LONGEST_NUMBER),
        (plan.triangles(), 5 + 3 * digits),
        // "g name"; the root's name is counted below.
        (groups, 3),
        (names, 1),
        (1, (ROOT.len() + comment(plan, name).len()) as u128),
    ];
    parts.into_iter().fold(0, |bytes: u128, (count, each)| {
        bytes.saturating_add(count.saturating_mul(each))
    })
}

fn comment(plan: &Plan, name: &str) -> String {
    let lines = plan.comment(name);
    lines.map(|line| format!("# {line}\n")).concat()
}

fn push_group(text: &mut String, instance: &Instance) {
    let is_plain = |c: char| !c.is_whitespace() && !c.is_control() && !"/#\\".contains(c);
    text.push_str("g ");
    if instance.path.is_empty() {
        text.push_str(ROOT);
    }
    let name = instance.prototype.name.chars();
    text.extend(name.map(|c| if is_plain(c) { c } else { '_' }));
    for number in instance.path {
        let _ = write!(text, "/{number}");
    }
    text.push('\n');
}
