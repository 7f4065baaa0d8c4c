//! Stanford PLY: the elements `vertex` and `face`, as text or binary in either byte order.
//!
//! The reader uses the properties `x`, `y` and `z` of a vertex and the list `vertex_indices`
//! (or `vertex_index`) of a face, with numbers of any kind. It skips other properties and
//! other elements without storing them. It rejects triangle strips, because faces would be
//! missing.

use glam::DVec3;

use super::data::Data;
use super::header::{Element, Header, Kind};
use crate::meshes::error::{MeshError, MeshPlace};
use crate::meshes::reading::builder::{Builder, too_many_corners};
use crate::meshes::reading::text::without_mark;
use crate::meshes::reading::{MeshFile, ROUNDING_32};
use crate::scene::MOST_FACE_CORNERS;

/// Reads a mesh from the bytes of a PLY file.
///
/// # Errors
/// If the header or a number is malformed or out of range, the file ends early, a face
/// names a vertex that does not exist, or the mesh has no faces.
pub(super) fn parse(bytes: &[u8]) -> Result<MeshFile, MeshError> {
    let bytes = without_mark(bytes)?;
    let header = Header::new(bytes)?;
    let needed = |name: &str| {
        let found = header.elements.iter().find(|one| one.name == name);
        found.ok_or_else(|| {
            MeshError::in_line(
                header.lines,
                format!("the header has no element \"{name}\""),
            )
        })
    };
    let (vertex, face) = (needed("vertex")?, needed("face")?);
    if let Some(strips) = header.elements.iter().find(|one| one.name == "tristrips") {
        let message = "triangle strips are not supported: write the mesh with faces";
        return Err(MeshError::in_line(strips.line, message));
    }
    let [x, y, z] = ["x", "y", "z"].map(|name| coordinate_of(vertex, name));
    let coordinates = [x?, y?, z?];
    // The numbers of a record are in the order of the properties.
    let ranks = coordinates.map(|at| coordinates.iter().filter(|&&other| other < at).count());
    let corners = corners_of(face)?;

    let mut builder = Builder::default();
    let mut data = Data::new(&header, bytes);
    for element in &header.elements {
        data.check_length(element)?;
        for _ in 0..element.count {
            if element.name == vertex.name {
                let (place, numbers) =
                    data.record(element, |at, _| Ok(coordinates.contains(&at)))?;
                let [x, y, z] = ranks.map(|rank| numbers[rank]);
                builder.push_vertex(DVec3::new(x, y, z), place)?;
            } else if element.name == face.name {
                let (place, numbers) = data.record(element, |at, length| match at == corners {
                    true if length > MOST_FACE_CORNERS => Err(too_many_corners()),
                    is_wanted => Ok(is_wanted),
                })?;
                let corners = numbers.iter().map(|&number| index(number, place));
                builder.push_face(&corners.collect::<Result<Vec<_>, _>>()?, place)?;
            } else {
                data.record(element, |_, _| Ok(false))?;
            }
        }
    }
    data.check_end()?;
    let is_single = |at: &usize| vertex.properties[*at].kind == Kind::F32;
    Ok(MeshFile {
        mesh: builder.finish()?,
        deviation: header.remarks.deviation,
        made: header.remarks.made(),
        rounding: match coordinates.iter().any(is_single) {
            true => ROUNDING_32,
            false => 0.0,
        },
    })
}

/// The position of a coordinate among the properties of vertices.
fn coordinate_of(vertex: &Element, name: &str) -> Result<usize, MeshError> {
    let found = vertex.position(name);
    found
        .filter(|&at| vertex.properties[at].length.is_none())
        .ok_or_else(|| {
            let message = format!("the element \"vertex\" has no scalar property \"{name}\"");
            MeshError::in_line(vertex.line, message)
        })
}

/// The position of the list of corners among the properties of faces.
fn corners_of(face: &Element) -> Result<usize, MeshError> {
    let names = ["vertex_indices", "vertex_index"].iter();
    let mut found = names.filter_map(|name| face.position(name));
    found
        .find(|&at| face.properties[at].length.is_some())
        .ok_or_else(|| {
            let message = "the element \"face\" has no list \"vertex_indices\"";
            MeshError::in_line(face.line, message)
        })
}

/// The number of a vertex.
fn index(number: f64, place: MeshPlace) -> Result<u64, MeshError> {
    match number >= 0.0 && number.fract() == 0.0 {
        // Numbers beyond u64 become `u64::MAX`, which is beyond all vertices.
        true => Ok(number as u64),
        false => Err(MeshError::new(
            place,
            format!(
                "a corner of the face is {number:?}: it must be a vertex number, counted from 0"
            ),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VERTICES: &str =
        "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
    const FACES: &str = "element face 1\nproperty list uchar uint vertex_indices\n";

    fn ascii(elements: &str, data: &str) -> Vec<u8> {
        format!("ply\nformat ascii 1.0\n{elements}end_header\n{data}").into_bytes()
    }

    fn good() -> String {
        format!("{VERTICES}{FACES}")
    }

    fn error(bytes: &[u8]) -> MeshError {
        parse(bytes).expect_err("an error")
    }

    #[test]
    fn text_and_both_byte_orders_are_the_same_mesh() {
        let header = |format: &str, end: &str| {
            format!(
                "ply\nformat {format} 1.0\ncomment deviation = 1e-3\n{}end_header\n",
                good()
            )
            .replace('\n', end)
            .into_bytes()
        };
        let coordinates = [0.0_f64, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.1, 0.0];
        let mut files = Vec::new();
        for end in ["\n", "\r\n"] {
            let mut text = header("ascii", end);
            text.extend(format!("0 0 0{end}1 0 0{end}0 0.1 0{end}3 0 1 2{end}").bytes());
            let mut little = header("binary_little_endian", end);
            little.extend(coordinates.iter().flat_map(|x| x.to_le_bytes()));
            little.push(3);
            little.extend([0_u32, 1, 2].iter().flat_map(|i| i.to_le_bytes()));
            let mut big = header("binary_big_endian", end);
            big.extend(coordinates.iter().flat_map(|x| x.to_be_bytes()));
            big.push(3);
            big.extend([0_u32, 1, 2].iter().flat_map(|i| i.to_be_bytes()));
            files.extend([text, little, big]);
        }
        files.push([b"\xef\xbb\xbf".as_slice(), &files[0]].concat());
        for bytes in files {
            let file = parse(&bytes).unwrap();
            assert_eq!(file.deviation, Some(1e-3));
            assert_eq!(file.mesh.triangles, [[0, 1, 2]]);
            assert_eq!(file.mesh.vertices[2], DVec3::new(0.0, 0.1, 0.0));
            assert_eq!(file.rounding, 0.0);
            // Cut anywhere, it is an error and never a panic.
            for length in 0..bytes.len() - 2 {
                let _ = parse(&bytes[..length]);
            }
        }
    }

    #[test]
    fn other_elements_and_properties_are_skipped() {
        let elements = "element camera 2 { two of them }\nproperty list uchar float what\nproperty int n\n\
            element vertex 3\nproperty float z # last first\nproperty uchar red\nproperty float y\nproperty list uchar int more\nproperty float x\n\
            element nothing 0\n\
            element face 2\nproperty uchar flags\nproperty list int16 float32 vertex_index\n";
        let data = "2 0.5 0.5 7\n0 7\n9 255 0 2 1 1 0 { the first }\n9 255 0 0 1\n9 255 1 0 \\\n1 # over two lines\n\n1 4 0 1 2 0\n1 2 0 1\n";
        let file = parse(&ascii(elements, data)).unwrap();
        assert_eq!(file.mesh.vertices[2], DVec3::new(1.0, 1.0, 9.0));
        assert_eq!(file.mesh.triangles, [[0, 1, 2], [0, 2, 0]]);
        assert_eq!(file.rounding, ROUNDING_32);
    }

    #[test]
    fn errors_name_the_line() {
        let good = good();
        for (elements, data, line, message) in [
            (
                good.as_str(),
                "0 0 0\n1 0 0\n0 1\n3 0 1 2",
                13,
                "unexpected \"0\"",
            ),
            (&good, "0 0 0\n1 0 0 5\n", 11, "unexpected \"5\""),
            (&good, "0 0 0\n1 0,5 0\n", 11, "\"0,5\" is not a number"),
            (&good, "0 0 0\n1 0 1e160\n", 11, "at most 1.4e45"),
            (&good, "0 0 0\n1 nan 0\n", 11, "finite"),
            (&good, "0 0 0\n1 0 0\n", 11, "ends"),
            (
                &good,
                "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                13,
                "vertex 3 (4 if counted from 1)",
            ),
            (
                &good,
                "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
                13,
                "a corner of the face is -1",
            ),
            (
                &good,
                "0 0 0\n1 0 0\n0 1 0\n3 0 1 0.5\n",
                13,
                "a corner of the face is 0.5",
            ),
            (&good, "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", 13, "length"),
            (
                &good,
                "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n",
                14,
                "after the last element",
            ),
            (&good, "0 0 0\n1 0 0\n0 1 0\n9999999 0 1 2\n", 13, "corners"),
            (VERTICES, "", 7, "no element \"face\""),
            (
                "element face 0\nproperty int a\n",
                "",
                5,
                "no element \"vertex\"",
            ),
            (
                &good.replace("uint", "uint64"),
                "",
                8,
                "\"uint64\" is not a number type",
            ),
            (&good.replace("uchar", "float"), "", 8, "whole number"),
            (
                &good.replace("property double z\n", ""),
                "",
                3,
                "no scalar property \"z\"",
            ),
            (&good.replace("vertex_indices", "corners"), "", 7, "no list"),
            (
                &good.replace("vertex 3", "vertex many"),
                "",
                3,
                "the number of records is \"many\"",
            ),
            (&good.replace("vertex 3", "vertex"), "", 3, "needs a number"),
            (
                &format!("{good}{FACES}"),
                "",
                9,
                "line 7 already declares an element \"face\"",
            ),
            (
                &good.replace("double y", "double x"),
                "",
                5,
                "already has a property \"x\"",
            ),
            (
                &format!("{good}elements 3\n"),
                "",
                9,
                "\"elements\" is not a header keyword",
            ),
            (
                &format!("property int a\n{good}"),
                "",
                3,
                "needs an element before it",
            ),
            (
                &format!("{good}element tristrips 1\nproperty list int int vertex_indices\n"),
                "",
                9,
                "triangle strips",
            ),
            (
                &format!("{good}element foo 1000000000\n"),
                "",
                9,
                "has 1000000000 records but no properties",
            ),
        ] {
            let error = error(&ascii(elements, data));
            assert_eq!(error.place, MeshPlace::Line(line), "{data:?} {error}");
            assert!(error.message.contains(message), "{message:?}: {error}");
        }
        for (bytes, line, message) in [
            (&b"plyx\n"[..], 1, "\"ply\""),
            (b"ply\nformat text 1.0\n", 2, "\"text\" is not a PLY format"),
            (b"ply\nend_header\n", 2, "no line \"format\""),
            (b"ply\nformat ascii 1.0", 2, "end_header is missing"),
        ] {
            let error = error(bytes);
            assert_eq!(error.place, MeshPlace::Line(line), "{error}");
            assert!(error.message.contains(message), "{error}");
        }
    }

    #[test]
    fn declared_sizes_are_compared_with_the_length_of_a_binary_file() {
        let header = |elements: &str| {
            format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n").into_bytes()
        };
        let many = good().replace("vertex 3", "vertex 18446744073709551615");
        let error_of_many = error(&header(&many));
        assert_eq!(error_of_many.place, MeshPlace::Line(3));
        assert!(
            error_of_many.message.contains("at least"),
            "{error_of_many}"
        );
        // A list of 4 billion numbers.
        let mut bytes = header(
            "element foo 1\nproperty list uint double a\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_index\n",
        );
        bytes.extend(u32::MAX.to_le_bytes());
        let error_of_list = error(&bytes);
        assert_eq!(error_of_list.place, MeshPlace::Record("record", 0));
        assert!(error_of_list.message.contains("ends"), "{error_of_list}");
    }
}
