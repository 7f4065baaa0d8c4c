//! Wavefront OBJ: vertices (`v`) and faces (`f`).
//!
//! A line that ends in `\` continues in the next one, and `#` begins a comment anywhere; a `\`
//! at the end of a comment belongs to the comment. The reader ignores values after the three
//! coordinates (a weight, a color) and all other keywords, except those of free-form surfaces:
//! it rejects these because a part of the object would be missing.

use glam::DVec3;

use crate::meshes::error::{MeshError, MeshPlace};
use crate::meshes::reading::MeshFile;
use crate::meshes::reading::builder::{Builder, too_many_corners};
use crate::meshes::reading::remarks::Remarks;
use crate::meshes::reading::text::{before, lines, number, shown, without_mark, words};
use crate::scene::MOST_FACE_CORNERS;

/// Keywords whose geometry is not triangles.
const FREE_FORM: [&[u8]; 8] = [
    b"curv", b"curv2", b"surf", b"bzp", b"bsp", b"cdc", b"cdp", b"call",
];

/// Reads a mesh from the bytes of an OBJ file.
///
/// # Errors
/// If a line is malformed, a number is out of range, a face names a vertex that does not
/// exist, or the mesh has no faces.
pub(super) fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError> {
    let mut builder = Builder::default();
    let mut remarks = Remarks::default();
    let mut statement = Statement::default();
    for (line, text) in lines(without_mark(bytes)?) {
        let content = before(text, b"#");
        if content.len() < text.len() {
            remarks.read(&String::from_utf8_lossy(&text[content.len() + 1..]));
        }
        if statement.is_empty() {
            statement.line = line;
        }
        match content.trim_ascii_end().strip_suffix(b"\\") {
            Some(part) if content.len() == text.len() => {
                statement.text.extend_from_slice(part);
                statement.text.push(b' ');
                continue;
            }
            _ => {}
        }
        if statement.is_empty() {
            add(&mut builder, line, content)?;
        } else {
            statement.text.extend_from_slice(content);
            add(&mut builder, statement.line, &statement.text)?;
            statement.text.clear();
        }
    }
    add(&mut builder, statement.line, &statement.text)?;
    Ok(MeshFile {
        mesh: builder.finish()?,
        deviation: remarks.deviation,
        made: remarks.made(),
        rounding: 0.0,
    })
}

/// A statement over several lines.
#[derive(Default)]
struct Statement {
    /// The first line.
    line: u64,
    text: Vec<u8>,
}

impl Statement {
    fn is_empty(&self) -> bool {
        self.text.is_empty()
    }
}

/// Adds the vertex or the face of a statement.
fn add(builder: &mut Builder, line: u64, text: &[u8]) -> Result<(), MeshError> {
    let mut words = words(text);
    match words.next() {
        Some(b"v") => {
            let point = point(&mut words).map_err(|message| MeshError::in_line(line, message))?;
            builder.push_vertex(point, MeshPlace::Line(line))
        }
        // The first versions of the format called it `fo`.
        Some(b"f" | b"fo") => {
            let vertices = builder.vertices();
            let corners = words.zip(0..).map(|(word, number)| match number {
                MOST_FACE_CORNERS => Err(too_many_corners()),
                _ => corner(word, vertices),
            });
            let corners = corners.collect::<Result<Vec<_>, _>>();
            let corners = corners.map_err(|message| MeshError::in_line(line, message))?;
            builder.push_face(&corners, MeshPlace::Line(line))
        }
        Some(keyword) if FREE_FORM.contains(&keyword) => Err(MeshError::in_line(
            line,
            format!(
                "{} begins free-form geometry, which is not supported: export the object as polygons",
                shown(keyword)
            ),
        )),
        _ => Ok(()),
    }
}

/// The three coordinates of a vertex.
fn point<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Result<DVec3, String> {
    let mut coordinate = || {
        let word = words
            .next()
            .ok_or("a vertex needs three coordinates: v x y z")?;
        let coordinate = number(word);
        coordinate.ok_or_else(|| format!("the coordinate {} is not a number", shown(word)))
    };
    Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
}

/// The vertex, from 0, that a corner `i`, `i/t`, `i//n` or `i/t/n` names. A positive `i`
/// counts from 1, a negative one backwards from the last vertex so far.
fn corner(word: &[u8], vertices: u64) -> Result<u64, String> {
    let index = before(word, b"/");
    let index = std::str::from_utf8(index).ok();
    let Some(index) = index.and_then(|index| index.parse::<i64>().ok()) else {
        return Err(format!(
            "the corner {} of the face does not begin with a vertex number",
            shown(word)
        ));
    };
    match index {
        0 => Err("a corner of the face is 0: vertex numbers begin at 1".to_owned()),
        1.. => Ok(index as u64 - 1),
        _ => vertices.checked_sub(index.unsigned_abs()).ok_or_else(|| {
            format!("a corner of the face is {index}, but only {vertices} vertices precede it")
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1e-17\n";

    fn triangles(text: &str) -> Vec<[u32; 3]> {
        let file = parse(text.as_bytes()).unwrap_or_else(|error| panic!("{text:?} {error:?}"));
        file.mesh.triangles
    }

    #[test]
    fn quads_are_split_and_the_deviation_read() {
        let text = format!(
            "# scene, deviation 0.25 scene units\ng one\n{CORNERS}f 1 2 3 4\ng two\nf 1 3 4\n"
        );
        let file = parse(text.as_bytes()).unwrap();
        assert_eq!(file.deviation, Some(0.25));
        assert_eq!(file.mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
        assert_eq!(file.mesh.vertices[3], DVec3::new(0.0, 1.0, 1e-17));
    }

    #[test]
    fn every_way_to_write_a_face_is_the_same_face() {
        for faces in [
            "f 1 2 3",
            "f 1 2 3 # a comment",
            "f 1 2 3#8",
            "f 1 \\\n2 \\\n3",
            "f 1 \\\r\n2 3\r\n",
            "f 1 2 3\\",
            "\t f\t1  2 3 \r",
            "f 1/7 2/8 3/9",
            "f 1//7 2//8 3//9",
            "f 1/1/1 2/2/2 3/3/3",
            "f -4 -3 -2",
            "f +1 -3/2 3",
            "fo 1 2 3",
            "f 1 2\nf\nf 1 2 3",
            "# a comment does not continue \\\nf 1 2 3",
            "usemtl caf\u{e9}\nvt 0 0\nvn 0 0 1\ns off\nf 1 2 3",
        ] {
            assert_eq!(
                triangles(&format!("{CORNERS}{faces}")),
                [[0, 1, 2]],
                "{faces:?}"
            );
        }
        // A mark, colors, weights, and vertices after the faces that name them.
        let text = "\u{feff}f 1 2 3\nv 0 0 0 1 0.5 0.5\nv 1 0 0 1.0\nv 1 1 0 255 0 0";
        assert_eq!(triangles(text), [[0, 1, 2]]);
        assert_eq!(
            triangles("o \u{1f600}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").len(),
            1
        );
    }

    #[test]
    fn errors_name_the_line_and_the_word() {
        for (text, line, message) in [
            ("v 0 0", 5, "three coordinates"),
            ("v 0 0 \\\n\nf 1 2 3", 5, "three coordinates"),
            ("\nv 0 0,5 0", 6, "\"0,5\" is not a number"),
            ("v 0 nan 0", 5, "finite"),
            ("v 0 inf 0", 5, "finite"),
            (
                "v 0 1e160 0",
                5,
                "1e160, 0.0): every coordinate must be finite and at most 1.4e45",
            ),
            ("f 1 2 x", 5, "\"x\" of the face"),
            ("f 1 2 /3", 5, "\"/3\" of the face"),
            ("f 1 2 0", 5, "begin at 1"),
            ("f 1 2 -5", 5, "only 4 vertices precede it"),
            (
                "f 1 2 3\nf 1 2 9\nf 1 2 7",
                6,
                "vertex 8 (9 if counted from 1), but the mesh has 4 vertices",
            ),
            ("f 1 2 5\nf 1 2 9\nv 0 0 0", 6, "9 if counted from 1"),
            (
                "f 1 2 99999999999999999999",
                5,
                "does not begin with a vertex number",
            ),
            ("f 1 2 9999999999", 5, "names vertex 9999999998"),
            ("surf 0 1 0 1 1 2", 5, "free-form"),
        ] {
            let text = format!("{CORNERS}{text}");
            let error = parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.place, MeshPlace::Line(line), "{text:?}: {error}");
            assert!(error.message.contains(message), "{text:?}: {error}");
        }
        for (bytes, message) in [(&b""[..], "has no faces"), (b"\xff\xfev\0", "UTF-16")] {
            let error = parse(bytes).unwrap_err();
            assert!(error.message.contains(message), "{error}");
        }
    }
}
