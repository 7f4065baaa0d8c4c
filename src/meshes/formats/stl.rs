//! STL, binary and ASCII: the corners of the facets. Normals, attributes and the names of
//! solids are ignored; the facets of all solids form one mesh.
//!
//! A binary file has 80 arbitrary bytes, the number of facets in 32 bits, and 50 bytes for
//! each facet. The 80 bytes may begin with `solid`, as an ASCII file does. So a file whose
//! length matches its number of facets is binary, even if its first word is `solid`. An ASCII
//! file never has such a length: its bytes are 9 or more, so the four bytes at that place are
//! the number of facets of a file larger than [`MOST_MESH_BYTES`] (`crate::scene`).

use glam::DVec3;

use super::{MeshFormat, Writer};
use crate::meshes::error::{MeshError, MeshPlace};
use crate::meshes::reading::MeshFile;
use crate::meshes::reading::ROUNDING_32;
use crate::meshes::reading::builder::Builder;
use crate::meshes::reading::remarks::Remarks;
use crate::meshes::reading::text::{lines, number, shown, without_mark, words};

/// Bytes of a binary file before its facets.
const HEADER: usize = 84;
/// Bytes of a binary facet: a normal and three corners in f32, and 16 bits.
const FACET: usize = 50;
/// The first bytes, which decide whether a file is ASCII.
const SAMPLE: usize = 1024;

/// Facets; read only.
pub(super) struct Stl;

impl MeshFormat for Stl {
    const NAME: &'static str = "STL";
    const EXTENSION: &'static str = "stl";
    const WRITER: Option<Writer> = None;

    fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError> {
        parse(bytes)
    }
}

fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError> {
    let claimed = bytes.get(80..HEADER).map(|count| {
        let count = [count[0], count[1], count[2], count[3]];
        u64::from(u32::from_le_bytes(count))
    });
    let expected = claimed.map(|count| HEADER as u64 + FACET as u64 * count);
    if expected == Some(bytes.len() as u64) {
        return binary(bytes);
    }
    let text = without_mark(bytes)?;
    let sample = &text[..text.len().min(SAMPLE)];
    let begins = words(sample).next().unwrap_or_default();
    if begins.eq_ignore_ascii_case(b"solid") && !sample.contains(&0) {
        return ascii(text);
    }
    Err(MeshError::in_file(match (claimed, expected) {
        (Some(count), Some(expected)) => format!(
            "a binary STL file of {count} facets has {expected} bytes, but this file has {}; an ASCII STL file begins with \"solid\"",
            bytes.len()
        ),
        _ => format!(
            "an STL file begins with \"solid\" (ASCII), or has at least {HEADER} bytes (binary)"
        ),
    }))
}

/// Reads a binary file whose length is right.
fn binary(bytes: &[u8]) -> Result<MeshFile, MeshError> {
    let (header, facets) = bytes.split_at(HEADER);
    let mut builder = Builder::default();
    for (number, facet) in (0..).zip(facets.chunks_exact(FACET)) {
        let place = MeshPlace::Record("facet", number);
        let coordinates: Vec<f64> = facet[12..48]
            .chunks_exact(4)
            .map(|x| f64::from(f32::from_le_bytes([x[0], x[1], x[2], x[3]])))
            .collect();
        for corner in coordinates.chunks_exact(3) {
            builder.push_vertex(DVec3::from_slice(corner), place)?;
        }
        push_facet(&mut builder, place)?;
    }
    let mut remarks = Remarks::default();
    remarks.read(&String::from_utf8_lossy(&header[..80]));
    finished(builder, remarks)
}

/// What must come next in an ASCII file.
#[derive(Clone, Copy, PartialEq)]
enum Due {
    /// A solid, or the end of the file.
    Solid,
    /// A facet, or the end of the solid.
    Facet,
    Loop,
    /// One of the three corners, by its number.
    Corner(u8),
    EndLoop,
    EndFacet,
}

impl Due {
    /// The keyword for messages.
    fn name(self) -> &'static str {
        match self {
            Self::Solid => "solid",
            Self::Facet => "facet or endsolid",
            Self::Loop => "outer loop",
            Self::Corner(_) => "vertex (a facet has three)",
            Self::EndLoop => "endloop (a facet has three vertices)",
            Self::EndFacet => "endfacet",
        }
    }
}

/// Reads an ASCII file: words in any case, between any white space. The rest of a line
/// after `solid` or `endsolid` is a name.
fn ascii(text: &[u8]) -> Result<MeshFile, MeshError> {
    let mut builder = Builder::default();
    let mut remarks = Remarks::default();
    let mut due = Due::Solid;
    let mut last = 1;
    let mut words = words_of(text);
    while let Some((line, word)) = words.next() {
        last = line;
        let keyword = word.to_ascii_lowercase();
        due = match (due, keyword.as_slice()) {
            (Due::Solid, b"solid") => {
                remarks.read(&String::from_utf8_lossy(words.rest_of_line()));
                Due::Facet
            }
            (Due::Facet, b"facet") => {
                if words.skip_if(b"normal") {
                    for _ in 0..3 {
                        words.next();
                    }
                }
                Due::Loop
            }
            (Due::Facet, b"endsolid") => {
                words.rest_of_line();
                Due::Solid
            }
            (Due::Loop, b"outer") => {
                words.skip_if(b"loop");
                Due::Corner(0)
            }
            (Due::Corner(corner), b"vertex") => {
                let point = point(&mut words).map_err(|what| MeshError::in_line(line, what))?;
                builder.push_vertex(point, MeshPlace::Line(line))?;
                if corner == 2 {
                    push_facet(&mut builder, MeshPlace::Line(line))?;
                    Due::EndLoop
                } else {
                    Due::Corner(corner + 1)
                }
            }
            (Due::EndLoop, b"endloop") => Due::EndFacet,
            (Due::EndFacet, b"endfacet") => Due::Facet,
            (Due::Corner(_) | Due::EndLoop, _) if number(word).is_some() => {
                return Err(MeshError::in_line(line, COORDINATES));
            }
            (due, _) => {
                let message = format!("expected {}, found {}", due.name(), shown(word));
                return Err(MeshError::in_line(line, message));
            }
        };
    }
    // Some programs leave the last line out.
    if !matches!(due, Due::Solid | Due::Facet) {
        let message = format!("expected {}, found the end of the file", due.name());
        return Err(MeshError::in_line(last, message));
    }
    finished(builder, remarks)
}

/// The words of a text with their lines.
struct Words<'a, L> {
    lines: L,
    line: u64,
    rest: &'a [u8],
}

fn words_of(text: &[u8]) -> Words<'_, impl Iterator<Item = (u64, &[u8])>> {
    Words {
        lines: lines(text),
        line: 1,
        rest: &[],
    }
}

impl<'a, L: Iterator<Item = (u64, &'a [u8])>> Words<'a, L> {
    fn next(&mut self) -> Option<(u64, &'a [u8])> {
        loop {
            self.rest = self.rest.trim_ascii_start();
            if !self.rest.is_empty() {
                let end = self.rest.iter().position(u8::is_ascii_whitespace);
                let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
                self.rest = rest;
                return Some((self.line, word));
            }
            (self.line, self.rest) = self.lines.next()?;
        }
    }

    /// Skips the next word of the line if it is this one.
    fn skip_if(&mut self, word: &[u8]) -> bool {
        let next = words(self.rest).next().unwrap_or_default();
        let is_it = next.eq_ignore_ascii_case(word);
        if is_it {
            self.next();
        }
        is_it
    }

    /// Skips the rest of the line and returns it.
    fn rest_of_line(&mut self) -> &'a [u8] {
        std::mem::take(&mut self.rest)
    }
}

/// The error of a vertex with fewer or more numbers.
const COORDINATES: &str = "a vertex has three coordinates: vertex x y z";

/// The coordinates after `vertex`.
fn point<'a>(
    words: &mut Words<'a, impl Iterator<Item = (u64, &'a [u8])>>,
) -> Result<DVec3, String> {
    let mut coordinate = || {
        let (_, word) = words.next().ok_or(COORDINATES)?;
        number(word).ok_or_else(|| format!("the coordinate {} is not a number", shown(word)))
    };
    Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
}

/// Adds the facet of the last three vertices.
fn push_facet(builder: &mut Builder, place: MeshPlace) -> Result<(), MeshError> {
    let end = builder.vertices();
    builder.push_face(&[end - 3, end - 2, end - 1], place)
}

fn finished(builder: Builder, remarks: Remarks) -> Result<MeshFile, MeshError> {
    Ok(MeshFile {
        mesh: builder.finish()?,
        deviation: remarks.deviation,
        made: remarks.made(),
        // ASCII files are usually written from f32 numbers.
        rounding: ROUNDING_32,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACET_TEXT: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n";

    fn binary_file(header: &[u8], facets: &[[f32; 9]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            bytes.extend([0; 12]);
            bytes.extend(facet.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    const ONE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

    fn corners(bytes: &[u8]) -> Vec<[DVec3; 3]> {
        let file = parse(bytes).unwrap_or_else(|error| panic!("{error:?}"));
        let triangles = file.mesh.triangles.iter();
        let triangles = triangles.map(|one| one.map(|i| file.mesh.vertices[i as usize]));
        triangles.collect()
    }

    #[test]
    fn text_and_binary_are_the_same_mesh_whatever_the_first_word() {
        let expected = [[DVec3::ZERO, DVec3::X, DVec3::Y]];
        let text = format!("solid a deviation 0.5\n{FACET_TEXT}endsolid a\n");
        for text in [
            text.clone(),
            text.replace('\n', "\r\n"),
            text.to_uppercase(),
            text.replace("endsolid a\n", ""),
            format!("\u{feff}  {text}"),
            text.replace('\n', "\n\n\t"),
            // Any white space separates words.
            text.replace("\nouter", " outer")
                .replace("\nvertex", "\t vertex"),
            text.replace("vertex 1 0 0", "vertex 1\n0 0")
                .replace("outer loop", "outer  loop"),
        ] {
            assert_eq!(corners(text.as_bytes()), expected, "{text:?}");
        }
        let file = parse(text.as_bytes()).unwrap();
        assert_eq!((file.deviation, file.rounding), (Some(0.5), ROUNDING_32));
        for header in [&b"solid deviation 0.5"[..], b"", b"anything"] {
            assert_eq!(corners(&binary_file(header, &[ONE])), expected);
        }
        let two = format!("{text}solid b\n{FACET_TEXT}{FACET_TEXT}endsolid\n");
        assert_eq!(corners(two.as_bytes()).len(), 3);
    }

    #[test]
    fn errors_name_the_line_or_the_facet() {
        let text = |body: &str| format!("solid a\n{body}");
        for (text, line, message) in [
            (
                text("facet\nouter loop\nvertex 0 0\n"),
                4,
                "three coordinates",
            ),
            (
                text("facet\nouter loop\nvertex 0 0 0 0\n"),
                4,
                "three coordinates",
            ),
            (
                text("facet\nouter loop\nvertex 0 0 a\n"),
                4,
                "\"a\" is not a number",
            ),
            (
                text("facet\nouter loop\nvertex 0 0 1e46\n"),
                4,
                "at most 1.4e45",
            ),
            (
                text("facet\nouter loop\nvertex 0 0 0\nendloop\n"),
                5,
                "expected vertex (a facet has three), found \"endloop\"",
            ),
            (
                text(&FACET_TEXT.replace("endloop", "vertex 1 1 1")),
                7,
                "expected endloop (a facet has three vertices), found \"vertex\"",
            ),
            (
                text("facet\nvertex 0 0 0\n"),
                3,
                "expected outer loop, found \"vertex\"",
            ),
            (
                text("facet\nouter loop\n\n"),
                3,
                "expected vertex (a facet has three), found the end",
            ),
            (
                text(&format!("{FACET_TEXT}endsolid\n{FACET_TEXT}")),
                10,
                "expected solid, found \"facet\"",
            ),
        ] {
            let error = parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.place, MeshPlace::Line(line), "{text:?}: {error}");
            assert!(error.message.contains(message), "{text:?}: {error}");
        }
        let mut infinite = ONE;
        infinite[4] = f32::INFINITY;
        let error = parse(&binary_file(b"", &[ONE, infinite])).unwrap_err();
        assert_eq!(error.place, MeshPlace::Record("facet", 1));
        let whole = binary_file(b"solid", &[ONE]);
        let longer = [&whole[..], &[0]].concat();
        for (bytes, message) in [
            (
                &whole[..whole.len() - 1],
                "of 1 facets has 134 bytes, but this file has 133",
            ),
            (&longer, "but this file has 135"),
            (&binary_file(b"", &[])[..40], "begins with \"solid\""),
            (b"", "begins with \"solid\""),
            (b"solid", "has no faces"),
            (&binary_file(b"", &[]), "has no faces"),
        ] {
            let error = parse(bytes).unwrap_err();
            assert!(error.message.contains(message), "{error}");
        }
    }
}
