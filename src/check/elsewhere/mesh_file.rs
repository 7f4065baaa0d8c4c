//! Meshes of triangles from OBJ and PLY files.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use glam::DVec3;
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{DefaultElement, Property};

use crate::solid::tessellation::Mesh;

/// A mesh as a file holds it.
#[derive(Clone, Debug)]
pub struct MeshFile {
    /// The triangles; a polygon is a fan of them.
    pub mesh: Mesh,
    /// How far the mesh may be from the solids' surface, in scene units, where a
    /// comment says `deviation X`, as those of `cyltrace tessellate` do.
    pub deviation: Option<f64>,
}

/// Why there is no mesh.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// Neither kind of file.
    #[error("{path:?}: the name of a mesh must end in .obj or .ply")]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("cannot read {path:?}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// What the file holds is no mesh.
    #[error("{path:?}: {what}")]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
}

/// Reads a mesh; the file's name says which kind it is.
///
/// # Errors
/// When the name ends in neither `.obj` nor `.ply`, the file cannot be read or is
/// malformed, a face names a vertex that is not there, or there is no face.
pub fn read_mesh(path: &Path) -> Result<MeshFile, MeshFileError> {
    let extension = path.extension().map(|e| e.to_ascii_lowercase());
    let parse: fn(&[u8]) -> Result<MeshFile, String> =
        match extension.as_ref().and_then(|e| e.to_str()) {
            Some("obj") => parse_obj,
            Some("ply") => parse_ply,
            _ => return Err(MeshFileError::Extension { path: path.into() }),
        };
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|mut file| file.read_to_end(&mut bytes))
        .map_err(|source| MeshFileError::Read {
            path: path.into(),
            source,
        })?;
    let wrong = |what| MeshFileError::Content {
        path: path.into(),
        what,
    };
    let file = parse(&bytes).map_err(wrong)?;
    check(&file.mesh).map_err(wrong)?;
    Ok(file)
}

/// Refuses what no ray can be traced through.
fn check(mesh: &Mesh) -> Result<(), String> {
    if let Some(vertex) = mesh.vertices.iter().position(|point| !point.is_finite()) {
        return Err(format!("vertex {vertex} is not finite"));
    }
    if mesh.triangles.is_empty() {
        return Err("there is no face".to_owned());
    }
    let count = mesh.vertices.len();
    let corners = mesh.triangles.as_flattened();
    match corners.iter().find(|&&corner| corner as usize >= count) {
        Some(corner) => Err(format!(
            "a face names vertex {corner}, counted from 0, and there are {count}"
        )),
        None => Ok(()),
    }
}

fn parse_obj(bytes: &[u8]) -> Result<MeshFile, String> {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    // Colours are not looked at, so that material files are not read.
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut &bytes[..], &options, no_materials)
        .map_err(|error| error.to_string())?;
    let mut mesh = Mesh::default();
    for model in models {
        let positions = model.mesh.positions.chunks_exact(3);
        let corners = model.mesh.indices.chunks_exact(3);
        mesh.append(&Mesh {
            vertices: positions.map(DVec3::from_slice).collect(),
            triangles: corners.map(|c| [c[0], c[1], c[2]]).collect(),
        });
    }
    let comments = bytes
        .lines()
        .map_while(Result::ok)
        .filter(|line| line.starts_with('#'));
    Ok(MeshFile {
        mesh,
        deviation: comments.into_iter().find_map(|line| deviation(&line)),
    })
}

fn parse_ply(bytes: &[u8]) -> Result<MeshFile, String> {
    let parser = Parser::<DefaultElement>::new();
    let mut reader = Reader::new(BufReader::new(bytes));
    let header = parser
        .read_header(&mut reader)
        .map_err(|error| error.to_string())?;
    let mut payload = parser
        .read_payload(&mut reader, &header)
        .map_err(|error| error.to_string())?;
    let mut take = |name: &str| {
        let elements = payload.shift_remove(name);
        elements.ok_or_else(|| format!("there is no element {name:?}"))
    };
    let mut mesh = Mesh::default();
    for vertex in take("vertex")? {
        let coordinate = |name: &str| {
            let number = vertex.get(name).and_then(number);
            number.ok_or_else(|| format!("a vertex has no number {name:?}"))
        };
        let point = DVec3::new(coordinate("x")?, coordinate("y")?, coordinate("z")?);
        mesh.vertices.push(point);
    }
    for face in take("face")? {
        let corners = ["vertex_indices", "vertex_index"]
            .iter()
            .find_map(|name| face.get(*name))
            .and_then(Property::to_u32_list)
            .ok_or("a face has no list \"vertex_indices\"")?;
        let [first, rest @ ..] = corners.as_slice() else {
            continue;
        };
        let fan = rest.windows(2).map(|pair| [*first, pair[0], pair[1]]);
        mesh.triangles.extend(fan);
    }
    let mut comments = header.comments.iter();
    Ok(MeshFile {
        mesh,
        deviation: comments.find_map(|line| deviation(line)),
    })
}

/// A coordinate of any kind of number.
fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(x) => f64::from(x),
        Property::UChar(x) => f64::from(x),
        Property::Short(x) => f64::from(x),
        Property::UShort(x) => f64::from(x),
        Property::Int(x) => f64::from(x),
        Property::UInt(x) => f64::from(x),
        Property::Float(x) => f64::from(x),
        Property::Double(x) => x,
        _ => return None,
    })
}

/// The number after the word `deviation`.
fn deviation(comment: &str) -> Option<f64> {
    let (_, after) = comment.split_once("deviation")?;
    let mut words = after.split(|c: char| c.is_whitespace() || matches!(c, ':' | '=' | ','));
    let number: f64 = words.find_map(|word| word.parse().ok())?;
    (number.is_finite() && number >= 0.0).then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn obj_quads_are_split_and_the_deviation_read() {
        let text = "# scene, deviation 0.25 scene units\ng one\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1e-17\nf 1 2 3 4\ng two\nf 1 3 4\n";
        let file = parse_obj(text.as_bytes()).unwrap();
        assert_eq!(file.deviation, Some(0.25));
        assert_eq!(file.mesh.triangles.len(), 3);
        assert!(file.mesh.vertices.contains(&DVec3::new(0.0, 1.0, 1e-17)));
        assert_eq!(check(&file.mesh), Ok(()));
    }

    #[test]
    fn ply_ascii_and_binary_hold_the_same() {
        let header = |format: &str| {
            format!(
                "ply\nformat {format} 1.0\ncomment deviation = 1e-3\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n"
            )
        };
        let ascii = header("ascii") + "0 0 0\n1 0 0\n0 0.1 0\n3 0 1 2\n";
        let mut binary = header("binary_little_endian").into_bytes();
        for x in [0.0_f64, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.1, 0.0] {
            binary.extend(x.to_le_bytes());
        }
        binary.push(3);
        for corner in [0_u32, 1, 2] {
            binary.extend(corner.to_le_bytes());
        }
        for bytes in [ascii.as_bytes(), &binary] {
            let file = parse_ply(bytes).unwrap();
            assert_eq!(file.deviation, Some(1e-3));
            assert_eq!(file.mesh.triangles, [[0, 1, 2]]);
            assert_eq!(file.mesh.vertices[2], DVec3::new(0.0, 0.1, 0.0));
        }
    }

    #[test]
    fn broken_meshes_are_refused_with_their_reason() {
        let mut mesh = Mesh::default();
        assert_eq!(check(&mesh), Err("there is no face".to_owned()));
        mesh.triangles.push([0, 0, 3]);
        mesh.vertices.push(DVec3::ZERO);
        assert!(
            check(&mesh).unwrap_err().contains("vertex 0, counted")
                || check(&mesh).unwrap_err().contains("vertex 3")
        );
        mesh.vertices[0].x = f64::NAN;
        assert!(check(&mesh).unwrap_err().contains("not finite"));
        assert!(parse_ply(b"plyx\n").is_err());
    }
}
