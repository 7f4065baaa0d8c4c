//! What Embree intersects by itself, and what solids become of it.
//!
//! The geometry is given in the form that Embree takes; it is the same solid except for f32:
//!
//! - a cone curve is flat at its ends, each of which has a disk or is open;
//! - a round linear curve is the two balls and the cone that touches them;
//! - a sphere point is a ball; a ray that starts within it hits it from inside;
//! - an oriented disk point is hit from both sides.

use glam::DVec3;

use cyltrace::embree::{Error, SceneBuilder};
use cyltrace::solid::tessellation::{Fit, LEAST_SEGMENTS, mesh_of, mesh_size_of};
use cyltrace::solid::{AnySolid, Caps, SolidKind};

/// A geometry that Embree intersects by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A segment of `CONE_LINEAR_CURVE`: cylinders and cones.
    Cone,
    /// A segment of `ROUND_LINEAR_CURVE`: rounded cones.
    Round,
    /// A `SPHERE_POINT`: spheres.
    Sphere,
    /// An `ORIENTED_DISC_POINT`: disks.
    Disk,
    /// The inscribed mesh with this number of sides: all solids of revolution.
    Mesh(u32),
    /// The triangles of a cuboid's faces.
    Faces,
}

impl Shape {
    /// Whether it represents solids of a kind.
    #[must_use]
    pub fn represents(self, kind: SolidKind) -> bool {
        match self {
            Self::Cone => matches!(kind, SolidKind::Cylinder | SolidKind::Cone),
            Self::Round => kind == SolidKind::RoundedCone,
            Self::Sphere => kind == SolidKind::Sphere,
            Self::Disk => kind == SolidKind::Disk,
            Self::Mesh(_) => matches!(
                kind,
                SolidKind::Cylinder
                    | SolidKind::Cone
                    | SolidKind::RoundedCone
                    | SolidKind::Sphere
                    | SolidKind::Disk
            ),
            Self::Faces => kind == SolidKind::Cuboid,
        }
    }

    /// The reason why it does not represent a scene with solids of a kind.
    #[must_use]
    pub fn refusal(self, kind: SolidKind) -> String {
        format!(
            "the scene has solids of the kind {}, which this geometry does not represent",
            kind.name()
        )
    }

    /// Attaches one geometry of all these solids, in their order.
    ///
    /// # Errors
    /// If Embree rejects one.
    ///
    /// # Panics
    /// If a solid is of a kind that this does not [represent](Self::represents).
    pub fn attach(
        self,
        builder: &mut SceneBuilder<()>,
        solids: impl Iterator<Item = AnySolid>,
    ) -> Result<(), Error> {
        match self {
            Self::Cone => {
                let segments = Segments::new(solids);
                let (vertices, first) = (&segments.vertices, &segments.first);
                builder.attach_cone_curves(vertices, first, Some(&segments.neighbours))?;
            }
            Self::Round => {
                let segments = Segments::new(solids);
                builder.attach_round_curves(&segments.vertices, &segments.first, None)?;
            }
            Self::Sphere => {
                let spheres: Vec<[f32; 4]> = solids.map(|solid| sphere(&solid)).collect();
                builder.attach_spheres(&spheres)?;
            }
            Self::Disk => {
                let (disks, normals): (Vec<_>, Vec<_>) = solids.map(|solid| disk(&solid)).unzip();
                builder.attach_disks(&disks, &normals)?;
            }
            Self::Mesh(sides) => attach_meshes(builder, solids, sides)?,
            Self::Faces => attach_meshes(builder, solids, ANY_SIDES)?,
        }
        Ok(())
    }

    /// How many of Embree's primitives a solid becomes.
    #[must_use]
    pub fn primitives(self, solid: &AnySolid) -> u64 {
        match self {
            Self::Cone | Self::Round | Self::Sphere | Self::Disk => 1,
            Self::Mesh(sides) => mesh_size_of(solid, sides).1,
            Self::Faces => mesh_size_of(solid, ANY_SIDES).1,
        }
    }
}

/// The argument for the mesh of a cuboid, which has no sides around an axis.
const ANY_SIDES: u32 = LEAST_SEGMENTS;

/// Straight curves.
#[derive(Default)]
struct Segments {
    vertices: Vec<[f32; 4]>,
    first: Vec<u32>,
    neighbours: Vec<u8>,
}

impl Segments {
    fn new(solids: impl Iterator<Item = AnySolid>) -> Self {
        let mut segments = Self::default();
        for solid in solids {
            let (ends, radii, caps) = match solid {
                AnySolid::Cylinder(one) => ([one.p0(), one.p1()], [one.radius(); 2], one.caps()),
                AnySolid::Cone(one) => (
                    [one.p0(), one.p1()],
                    [one.radius0(), one.radius1()],
                    one.caps(),
                ),
                AnySolid::RoundedCone(one) => (
                    [one.p0(), one.p1()],
                    [one.radius0(), one.radius1()],
                    Caps::Both,
                ),
                other => stray(&other, "segment"),
            };
            segments.first.push(segments.vertices.len() as u32);
            let vertices = ends.into_iter().zip(radii);
            segments
                .vertices
                .extend(vertices.map(|(end, radius)| vertex(end, radius)));
            // An end without disk is one that a neighbour continues.
            segments.neighbours.push(match caps {
                Caps::Both => 0,
                Caps::P1 => 1,
                Caps::P0 => 2,
                Caps::None => 3,
            });
        }
        segments
    }
}

fn sphere(solid: &AnySolid) -> [f32; 4] {
    match solid {
        AnySolid::Sphere(one) => vertex(one.center(), one.radius()),
        other => stray(other, "sphere"),
    }
}

/// The disk and its normal.
fn disk(solid: &AnySolid) -> ([f32; 4], [f32; 3]) {
    match solid {
        AnySolid::Disk(one) => {
            let normal = one.normal().as_vec3().to_array();
            (vertex(one.center(), one.radius()), normal)
        }
        other => stray(other, "disk"),
    }
}

/// A point and a radius, as Embree has them.
fn vertex(point: DVec3, radius: f64) -> [f32; 4] {
    let [x, y, z] = point.as_vec3().to_array();
    [x, y, z, radius as f32]
}

/// Panics for a solid that the geometry does not represent.
fn stray(solid: &AnySolid, wanted: &str) -> ! {
    panic!(
        "Embree's {wanted} cannot represent a {}",
        solid.kind().name()
    )
}

fn attach_meshes(
    builder: &mut SceneBuilder<()>,
    solids: impl Iterator<Item = AnySolid>,
    sides: u32,
) -> Result<(), Error> {
    // In f32 from the start: a million prisms in f64 are gigabytes.
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for solid in solids {
        let mesh = mesh_of(&solid, sides, Fit::Inscribed);
        let first = vertices.len() as u32;
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| first + corner);
        triangles.extend(mesh.triangles.iter().map(corners));
        let narrow = |vertex: &DVec3| vertex.as_vec3().to_array();
        vertices.extend(mesh.vertices.iter().map(narrow));
    }
    builder.attach_triangles(&vertices, &triangles)?;
    Ok(())
}
