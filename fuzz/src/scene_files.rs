//! Scene files, and the tables, neurons and lattices that they name.
//!
//! Bytes become a file in a folder of their own, which the library reads as it reads
//! a user's. Whatever they are, it returns a scene or an error with a message. Of a
//! scene, no more is made than was counted before anything was read, and it is traced
//! without Embree and with it.

use std::io::{Cursor, Write};
use std::num::NonZeroUsize;
use std::path::{Component, Path};
use std::sync::Arc;

use cyltrace::math::Ray;
use cyltrace::scene::{ExpectedCounts, Scene, SceneFile};
use cyltrace::tracer::{Options, Tracer};
use glam::DVec3;
use tempfile::TempDir;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// The most solids and placements of a scene that is loaded; a larger one is only
/// counted. The program compares the counts with `--max-memory` likewise.
const MOST_RECORDS: u128 = 20_000;

/// The most solids and placements, with all nesting, that a ray tries one by one.
const MOST_TRIED: u128 = 2_000;

/// A scene file. Files that it names are the small ones of [`companions`].
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn scene_file(bytes: &[u8]) {
    let folder = folder();
    for (name, text) in companions() {
        write(&folder, name, &text);
    }
    write(&folder, "scene.toml", bytes);
    load(&folder);
}

/// A table of cylinders; the first byte chooses what the scene file says of it.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn cylinder_table(bytes: &[u8]) {
    const SCENES: [&str; 6] = [
        "[[cylinder_table]]\nfile = \"table\"\n\
         columns = { p0 = [\"x0\", \"y0\", \"z0\"], p1 = [\"x1\", \"y1\", \"z1\"], radius = \"r\" }",
        "records = \"f32\"\n[[cylinder_table]]\nfile = \"table\"\ndegenerate = \"skip\"\n\
         columns = { p0 = [\"x0\", \"y0\", \"z0\"], p1 = [\"x1\", \"y1\", \"z1\"], radius = \"r\" }",
        "[[cylinder_table]]\nfile = \"table\"\ncaps = \"none\"\ndegenerate = \"skip\"\n\
         columns = { p0 = [\"x0\", \"y0\", \"z0\"], p1 = [\"x1\", \"y1\", \"z1\"], diameter = \"r\" }",
        "[[cylinder_table]]\nfile = \"table\"\ndelimiter = \";\"\ndecimal = \",\"\n\
         columns = { p0 = [\"x0\", \"y0\", \"z0\"], p1 = [\"x1\", \"y1\", \"z1\"], radius = \"r\" }",
        "[[cylinder_table]]\nfile = \"table\"\ndegenerate = \"skip\"\n\
         columns = { p0 = [0, 1, 2], p1 = [3, 4, 5], radius = 6 }",
        "[[prototype]]\nname = \"a\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
         [[instance_table]]\nof = \"a\"\nfile = \"table\"\n\
         columns = { position = [\"x\", \"y\", \"z\"], quaternion = [\"qx\", \"qy\", \"qz\", \"qw\"], \
         scale = \"s\" }",
    ];
    of_file(bytes, "table", &SCENES);
}

/// A neuron in SWC; the first byte chooses what the scene file says of it.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn swc(bytes: &[u8]) {
    const SCENES: [&str; 4] = [
        "[[swc]]\nfile = \"neuron.swc\"",
        "[[swc]]\nfile = \"neuron.swc\"\njoints = \"round\"\ndegenerate = \"skip\"",
        "[[swc]]\nfile = \"neuron.swc\"\njoints = \"flat\"\ndegenerate = \"skip\"",
        "[[swc]]\nfile = \"neuron.swc\"\nsoma = \"none\"\njoints = \"round\"",
    ];
    of_file(bytes, "neuron.swc", &SCENES);
}

/// A 3MF package; the first byte chooses what the scene file says of it.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn three_mf_package(bytes: &[u8]) {
    of_file(bytes, "lattice.3mf", &LATTICES);
}

/// The model within a 3MF package that is otherwise as it should be.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn three_mf_model(bytes: &[u8]) {
    let Some((choice, model)) = bytes.split_first() else {
        return;
    };
    let mut chosen = vec![*choice];
    chosen.extend(package(model));
    of_file(&chosen, "lattice.3mf", &LATTICES);
}

const LATTICES: [&str; 2] = [
    "[[beam_lattice]]\nfile = \"lattice.3mf\"",
    "[[beam_lattice]]\nfile = \"lattice.3mf\"\nmeshes = \"skip\"\nunit = \"inch\"\n\
     degenerate = \"skip\"",
];

/// A file of all bytes but the first, which chooses the scene that names it.
fn of_file(bytes: &[u8], name: &str, scenes: &[&str]) {
    let Some((choice, content)) = bytes.split_first() else {
        return;
    };
    let folder = folder();
    write(&folder, name, content);
    let scene = scenes[usize::from(*choice) % scenes.len()];
    write(&folder, "scene.toml", scene.as_bytes());
    load(&folder);
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn write(folder: &TempDir, name: &str, bytes: &[u8]) {
    std::fs::write(folder.path().join(name), bytes).expect("a temporary file");
}

/// Small files of each kind that a scene may name.
fn companions() -> [(&'static str, Vec<u8>); 4] {
    let model = "<model unit=\"millimeter\" \
        xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
        xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\">\
        <resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
        <vertex x=\"1\" y=\"0\" z=\"0\"/></vertices><b:beamlattice minlength=\"0.1\" radius=\"1\">\
        <b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams></b:beamlattice></mesh></object>\
        </resources><build><item objectid=\"1\"/></build></model>";
    [
        ("a.csv", b"x0,y0,z0,x1,y1,z1,r\n0,0,0,1,0,0,0.5\n".to_vec()),
        ("i.csv", b"x,y,z\n1,2,3\n".to_vec()),
        ("a.swc", b"1 1 0 0 0 1 -1\n2 3 4 0 0 1 1\n".to_vec()),
        ("a.3mf", package(model.as_bytes())),
    ]
}

/// A 3MF package of a model.
fn package(model: &[u8]) -> Vec<u8> {
    const RELATIONSHIPS: &[u8] = b"<Relationships \
        xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\
        <Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" \
        Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, part) in [("_rels/.rels", RELATIONSHIPS), ("3D/3dmodel.model", model)] {
        zip.start_file(name, options).expect("a part");
        zip.write_all(part).expect("its bytes");
    }
    zip.finish().expect("an archive").into_inner()
}

/// Loads the scene of a folder as the program does, and tries a few rays on it.
fn load(folder: &TempDir) {
    let file = match SceneFile::read(&folder.path().join("scene.toml")) {
        Ok(file) => file,
        Err(error) => return said(&error),
    };
    // Nothing outside of the folder is read.
    if file
        .files()
        .iter()
        .any(|path| !is_within(path, folder.path()))
    {
        return;
    }
    let counted = file.contents();
    let records = counted.iter().map(|contents| {
        let own = contents.solids.counts.total();
        own.saturating_add(contents.placements().into())
    });
    if records.fold(0, u128::saturating_add) > MOST_RECORDS {
        return;
    }
    let scene = match file.load() {
        Ok(scene) => Arc::new(scene),
        Err(error) => return said(&error),
    };
    for (counted, held) in counted.iter().zip(&scene.contents()) {
        // A neuron's segments and somata are counted together: which are balls is not
        // known by its lines.
        let solids = |contents: &ExpectedCounts| contents.solids.counts.total();
        let is_enough =
            solids(counted) >= solids(held) && counted.placements() >= held.placements();
        assert!(is_enough, "counted {counted:?}, loaded {held:?}");
    }
    trace(&scene);
}

fn is_within(path: &Path, folder: &Path) -> bool {
    let is_plain = |part| matches!(part, Component::Normal(_));
    (path.strip_prefix(folder)).is_ok_and(|rest| rest.components().all(is_plain))
}

/// An error says something, in lines that a terminal can show.
///
/// # Panics
/// When it does not.
pub fn said(error: &impl std::error::Error) {
    let text = error.to_string();
    assert!(!text.trim().is_empty(), "an error without a message");
    let is_plain = |c: char| !c.is_control() || c == '\n';
    assert!(text.chars().all(is_plain), "control characters in {text:?}");
}

fn trace(scene: &Arc<Scene>) {
    let options = Options {
        threads: NonZeroUsize::new(1),
        ..Options::default()
    };
    let tracer = match Tracer::new(scene.clone(), &options) {
        Ok(tracer) => tracer,
        Err(error) => return said(&error),
    };
    let statistics = tracer.statistics();
    let tried = statistics.instanced.total();
    if tried.saturating_add(statistics.instances) > MOST_TRIED {
        return;
    }
    let bounds = tracer.bounds();
    if bounds.is_empty() {
        return;
    }
    for direction in [DVec3::X, DVec3::new(-0.5, 0.25, 1.0)] {
        let back = direction * (bounds.upper - bounds.lower).length();
        let ray = Ray::new(bounds.center() - back, direction);
        let (found, expected) = (tracer.closest(&ray), tracer.closest_exhaustive(&ray));
        assert_eq!(found, expected, "{ray:?}");
    }
}
