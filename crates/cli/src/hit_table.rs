//! Tables of hits, and of the solids that contain points. The columns are fixed; new ones
//! are added at the end.

use std::fmt::Write;

use cyltrace::scene::Scene;
use cyltrace::tracer::{Containing, HitFields, PartialHit};

/// The header line.
pub const HEADER: &str =
    "ray,hit,t,x,y,z,nx,ny,nz,prototype,solid,primitive,part,crossing,instance,u,v,error\n";

/// The fields of a hit that the columns contain.
pub const FIELDS: HitFields = HitFields::all().difference(HitFields::SPAWN);

/// The cells of a miss after `ray` and `hit`: all 16 empty.
const MISS: &str = ",,,,,,,,,,,,,,,";

/// Appends the row of ray number `ray`, whose hit has all of [`FIELDS`].
pub fn push_row(rows: &mut String, ray: u64, hit: Option<&PartialHit>, scene: &Scene) {
    let Some(hit) = hit else {
        push(rows, format_args!("{ray},0,{MISS}\n"));
        return;
    };
    push(rows, format_args!("{ray},1"));
    push_number(rows, hit.t());
    for vector in [hit.point(), hit.normal()] {
        for value in requested(vector).to_array() {
            push_number(rows, value);
        }
    }
    rows.push(',');
    push_text(rows, &scene.prototypes[hit.prototype().0 as usize].name);
    push(
        rows,
        format_args!(
            ",{},{},{},{},",
            hit.solid().name(),
            hit.primitive(),
            hit.part().name(),
            hit.crossing().name()
        ),
    );
    push_path(rows, requested(hit.instance()));
    let (u, v) = requested(hit.uv());
    for value in [u, v, requested(hit.error())] {
        push_number(rows, value);
    }
    rows.push('\n');
}

fn requested<T>(field: Option<T>) -> T {
    field.expect("a row's hit has all of `FIELDS`")
}

/// The header line of a table of points.
pub const POINTS_HEADER: &str = "point,inside,prototype,solid,primitive,instance\n";

/// Appends the row of point number `point` and a solid that contains it, if any.
pub fn push_point_row(
    rows: &mut String,
    point: u64,
    containing: Option<&Containing>,
    scene: &Scene,
) {
    let Some(containing) = containing else {
        push(rows, format_args!("{point},0,,,,\n"));
        return;
    };
    push(rows, format_args!("{point},1,"));
    push_text(
        rows,
        &scene.prototypes[containing.prototype.0 as usize].name,
    );
    let (solid, primitive) = (containing.solid.name(), containing.primitive);
    push(rows, format_args!(",{solid},{primitive},"));
    push_path(rows, &containing.instance);
    rows.push('\n');
}

/// Appends the path of placements.
fn push_path(rows: &mut String, instance: &[u32]) {
    for (level, placement) in instance.iter().enumerate() {
        let separator = if level == 0 { "" } else { "/" };
        push(rows, format_args!("{separator}{placement}"));
    }
}

/// Appends a comma and a number.
fn push_number(rows: &mut String, value: f64) {
    rows.push(',');
    super::text::push_number(rows, value);
}

/// Appends a cell, quoted where it has to be.
fn push_text(rows: &mut String, text: &str) {
    if text.contains([',', '"', '\n', '\r']) {
        push(rows, format_args!("\"{}\"", text.replace('"', "\"\"")));
    } else {
        rows.push_str(text);
    }
}

fn push(rows: &mut String, text: std::fmt::Arguments) {
    rows.write_fmt(text).expect("a String takes any text");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn miss_has_as_many_cells_as_the_header() {
        let cells = format!("0,0,{MISS}").split(',').count();
        assert_eq!(cells, HEADER.split(',').count());
    }

    #[test]
    fn text_with_commas_and_quotes_is_quoted() {
        let mut row = String::new();
        push_text(&mut row, "a,\"b\"");
        assert_eq!(row, "\"a,\"\"b\"\"\"");
    }
}
