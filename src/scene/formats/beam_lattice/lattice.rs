//! The lattice in a mesh: vertices, beams between them, and balls at them.

use std::collections::BTreeMap;

use glam::DVec3;

use super::element::Element;
use super::notes::ObjectNotes;
use crate::scene::error::SceneError;

/// The cap at an end of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cap {
    /// A ball of the end's radius.
    Sphere,
    /// The outer half of that ball.
    Hemisphere,
    /// Flat.
    Butt,
}

/// The ways in which a mesh clips a lattice.
const CLIPPING: [(&str, ()); 3] = [("none", ()), ("inside", ()), ("outside", ())];

const CAPS: [(&str, Cap); 3] = [
    ("sphere", Cap::Sphere),
    ("hemisphere", Cap::Hemisphere),
    ("butt", Cap::Butt),
];

/// A cylinder or truncated cone between two vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    /// The byte at which it begins in the file.
    pub place: usize,
    /// The numbers of its vertices.
    pub vertices: [usize; 2],
    pub radii: [f64; 2],
    pub caps: [Cap; 2],
    /// Whether it is shorter than the lattice's `minlength`: such a beam is ignored.
    pub is_short: bool,
}

/// The solid added at an end of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// Nothing.
    Flat,
    /// The ball of the end's radius.
    Ball,
    /// The half of that ball beyond the end.
    Half,
}

impl Beam {
    /// The solid added at end 0 or 1, for these radii and this length. A whole ball
    /// replaces a half ball if its other half is inside the beam.
    pub fn end(&self, end: usize, radii: [f64; 2], length: f64) -> End {
        let fits = radii[end] <= radii[1 - end] && length >= radii[end];
        match self.caps[end] {
            Cap::Butt => End::Flat,
            _ if radii[end] == 0.0 => End::Flat,
            Cap::Hemisphere if !fits => End::Half,
            Cap::Sphere | Cap::Hemisphere => End::Ball,
        }
    }
}

/// A lattice, in the file's own coordinates and lengths.
pub(super) struct Lattice {
    pub vertices: Vec<DVec3>,
    pub beams: Vec<Beam>,
    /// The radii of the balls, by vertex number.
    pub balls: BTreeMap<usize, f64>,
}

/// Which vertices have balls.
#[derive(Clone, Copy, PartialEq)]
enum BallMode {
    None,
    /// Those with a `<ball>`.
    Mixed,
    /// All ends of beams.
    All,
}

impl Lattice {
    /// The lattice of a `<mesh>`, if it has one. With `skips_meshes` triangles are ignored;
    /// otherwise they are an error.
    pub fn new(
        mesh: &Element,
        skips_meshes: bool,
        notes: &mut ObjectNotes,
    ) -> Result<Option<Self>, SceneError> {
        let mut reject = |what: &Element, message: &str, note: &str| {
            match skips_meshes {
            true => {
                notes.add(note);
                Ok(())
            }
            false => Err(what.error_with_help(
                message,
                "cyltrace does not trace triangles; meshes = \"skip\" in the scene file ignores them",
            )),
        }
        };
        if let Some(triangles) = mesh.first("triangles")
            && triangles.first("triangle").is_some()
        {
            reject(
                &triangles,
                "this object has triangles",
                "its triangles are ignored, although they are part of the object",
            )?;
        }
        mesh.refuse_foreign(&["beamlattice"])?;
        let mut lattices = mesh.all_of_lattice("beamlattice");
        let Some(keys) = lattices.next() else {
            return Ok(None);
        };
        if let Some(second) = lattices.next() {
            return Err(second
                .error("a mesh can have only one <beamlattice>: put its beams into the first"));
        }
        keys.refuse_foreign(&["beams", "balls"])?;
        // Drafts of the extension called it `clipping`, and such files are still in use.
        let clipping = keys.attribute("clippingmode");
        let clipping = clipping.or_else(|| keys.attribute("clipping"));
        if clipping.is_some_and(|mode| mode != "none") {
            keys.choose("clippingmode", &CLIPPING)?;
            reject(
                &keys,
                "this lattice is clipped by a mesh",
                "its lattice is clipped by a mesh: the mesh is ignored and the whole lattice is read",
            )?;
        }
        let vertices = mesh.first("vertices");
        let vertices = vertices.iter().flat_map(|vertices| vertices.all("vertex"));
        let vertices = vertices.map(|vertex| vertex.point());
        let vertices = vertices.collect::<Result<Vec<_>, _>>()?;
        let beams = beams(&keys, &vertices)?;
        let balls = balls(&keys, vertices.len(), &beams, notes)?;
        Ok(Some(Self {
            vertices,
            beams,
            balls,
        }))
    }
}

fn beams(keys: &Element, vertices: &[DVec3]) -> Result<Vec<Beam>, SceneError> {
    let radius = keys.required_length("radius")?;
    let least = keys.required_length("minlength")?;
    let cap = keys.choose("cap", &CAPS)?.unwrap_or(Cap::Sphere);
    let lists = keys.all_of_lattice("beams");
    for list in keys.all_of_lattice("beams") {
        list.refuse_foreign(&["beam"])?;
    }
    let beams = lists.flat_map(|list| list.all_of_lattice("beam"));
    let beam = |element: Element| {
        let vertex = |name| element.vertex(name, vertices.len());
        let ends = [vertex("v1")?, vertex("v2")?];
        if ends[0] == ends[1] {
            let message = format!(
                "v1 and v2 of <beam> are both {}: a beam needs two vertices",
                ends[0]
            );
            return Err(element.error(message));
        }
        let radii = match (element.length("r1")?, element.length("r2")?) {
            (Some(r1), Some(r2)) => [r1, r2],
            (Some(r1), None) => [r1; 2],
            (None, None) => [radius; 2],
            (None, Some(r2)) => {
                return Err(element.error_with_help(
                    "<beam> has an r2 but no r1: give both, only r1, or neither",
                    &format!(
                        "some programs use the lattice's radius as r1: to do the same, write r1=\"{radius}\" r2=\"{r2}\""
                    ),
                ));
            }
        };
        let cap = |name| Ok(element.choose(name, &CAPS)?.unwrap_or(cap));
        Ok(Beam {
            place: element.place(),
            vertices: ends,
            radii,
            caps: [cap("cap1")?, cap("cap2")?],
            is_short: vertices[ends[0]].distance(vertices[ends[1]]) < least,
        })
    };
    beams.map(beam).collect()
}

fn balls(
    keys: &Element,
    vertices: usize,
    beams: &[Beam],
    notes: &mut ObjectNotes,
) -> Result<BTreeMap<usize, f64>, SceneError> {
    const MODES: [(&str, BallMode); 3] = [
        ("none", BallMode::None),
        ("mixed", BallMode::Mixed),
        ("all", BallMode::All),
    ];
    let mode = keys.choose("ballmode", &MODES)?.unwrap_or(BallMode::None);
    let mut balls = BTreeMap::new();
    let mut lists = keys.all_of_lattice("balls").peekable();
    if mode == BallMode::None {
        if lists.peek().is_some() {
            notes.add("its balls are ignored because it has no ballmode: add ballmode=\"mixed\" and a ballradius to read them");
        }
        return Ok(balls);
    }
    let Some(radius) = keys.length("ballradius")? else {
        let message = "<beamlattice> has a ballmode but no ballradius: add one";
        return Err(keys.error(message));
    };
    let mut ends = vec![false; vertices];
    for end in beams.iter().flat_map(|beam| beam.vertices) {
        ends[end] = true;
    }
    if mode == BallMode::All {
        let ends = (0..vertices).filter(|&vertex| ends[vertex]);
        balls.extend(ends.map(|vertex| (vertex, radius)));
    }
    let mut stated = BTreeMap::new();
    for element in lists.flat_map(|list| list.all_of_lattice("ball")) {
        let vertex = element.vertex("vindex", vertices)?;
        if !ends[vertex] {
            return Err(element.error(format!(
                "vindex of <ball> is {vertex}: a ball must be at an end of a beam"
            )));
        }
        let radius = element.length("r")?.unwrap_or(radius);
        if radius == 0.0 {
            return Err(element.error("the ball has the radius 0: it must be positive"));
        }
        // A lattice is the union of its balls, so the larger of two at a vertex remains.
        let greatest = stated.entry(vertex).or_insert(radius);
        *greatest = radius.max(*greatest);
    }
    balls.extend(stated);
    Ok(balls)
}
