//! Cylinders as geometry that Embree intersects by itself: the cone curve with equal
//! radii, and inscribed triangle meshes.

use glam::DVec3;

use super::shape::Shape;
use super::spaced::Spaced;
use super::{CYLINDERS_TIMED, Rival, Row, measured_cylinders};
use crate::formulations::{Answer, Batch, Precision, Problem};
use cyltrace::embree::{
    Device, DeviceOptions, Error, GREATEST_COORDINATE, NativeHit, Ray32, Scene, SceneBuilder,
};
use cyltrace::math::Ray;
use cyltrace::solid::{Cylinder, Part};

/// The meshes, by the number of their sides.
pub const SIDES: [(u32, &str); 11] = [
    (6, "mesh-6"),
    (8, "mesh-8"),
    (12, "mesh-12"),
    (16, "mesh-16"),
    (24, "mesh-24"),
    (32, "mesh-32"),
    (64, "mesh-64"),
    (128, "mesh-128"),
    (256, "mesh-256"),
    (512, "mesh-512"),
    (1024, "mesh-1024"),
];

/// Cylinders as Embree's own geometry.
#[derive(Debug)]
pub struct Native {
    device: Device,
    shape: Shape,
    name: &'static str,
    bytes: usize,
}

impl Native {
    /// The name of [`Shape::Cone`] in tables.
    pub const CONE_NAME: &str = "cone-curve";

    /// Makes ready to ask Embree, and measures what it keeps for a cylinder. The shape
    /// is one that represents cylinders.
    ///
    /// # Errors
    /// When Embree cannot be set up.
    pub fn new(shape: Shape, name: &'static str, options: &DeviceOptions) -> Result<Self, Error> {
        let mut native = Self {
            device: Device::new(options)?,
            shape,
            name,
            bytes: 0,
        };
        let before = native.device.memory_bytes();
        let scene = native.build(&measured_cylinders())?;
        native.bytes = (native.device.memory_bytes() - before) / CYLINDERS_TIMED;
        drop(scene);
        Ok(native)
    }

    /// A scene of these cylinders and nothing else.
    fn build(&self, cylinders: &[Cylinder]) -> Result<Scene<()>, Error> {
        let mut builder = SceneBuilder::new(&self.device)?;
        let solids = cylinders.iter().map(|&cylinder| cylinder.into());
        self.shape.attach(&mut builder, solids)?;
        builder.commit()
    }

    /// A mesh has its walls first and its disks after them, in the order of
    /// the ends. A curve does not say; its normal is along the axis on the
    /// disks and across it on the wall.
    fn part(&self, cylinder: &Cylinder, hit: &NativeHit, normal: DVec3) -> Part {
        let at_p1 = match self.shape {
            Shape::Mesh(sides) if hit.primitive < 2 * sides => return Part::Side,
            Shape::Mesh(sides) => !cylinder.caps().at_p0() || hit.primitive >= 3 * sides,
            Shape::Cone | Shape::Round | Shape::Sphere | Shape::Disk | Shape::Faces => {
                let axis = cylinder.p1() - cylinder.p0();
                let along = normal.dot(axis);
                if along * along < 0.5 * normal.length_squared() * axis.length_squared() {
                    return Part::Side;
                }
                along > 0.0
            }
        };
        if at_p1 { Part::Cap1 } else { Part::Cap0 }
    }
}

impl Rival for Native {
    fn row(&self) -> Row {
        Row {
            name: self.name,
            precision: Precision::F32,
            bytes: self.bytes,
        }
    }

    fn answer(&self, problem: &Problem) -> Option<Answer> {
        let ray = ray_for_embree(&problem.ray)?;
        let scene = self.build(&[problem.cylinder]).ok()?;
        let hit = scene.closest_native(&ray, &mut ())?;
        let normal = DVec3::from_array(hit.normal.map(f64::from));
        Some(Answer {
            t: f64::from(hit.t),
            part: self.part(&problem.cylinder, &hit, normal),
            normal: normal.normalize(),
        })
    }

    fn timed(&self, spaced: Spaced) -> Box<dyn Batch> {
        Box::new(NativeBatch {
            scene: self
                .build(&spaced.cylinders)
                .expect("Embree takes a scene of cylinders of usual size"),
            rays: spaced.rays.iter().filter_map(ray_for_embree).collect(),
        })
    }
}

/// One scene and rays into it.
struct NativeBatch {
    scene: Scene<()>,
    rays: Vec<Ray32>,
}

impl Batch for NativeBatch {
    fn run(&self) -> u64 {
        self.rays.iter().fold(0, |sum, ray| {
            let hit = self.scene.closest_native(ray, &mut ());
            sum + hit.map_or(0, |hit| u64::from(hit.t.to_bits()))
        })
    }
}

/// The ray in f32, if Embree takes it. What lies behind the origin is out of
/// its reach.
pub(crate) fn ray_for_embree(ray: &Ray) -> Option<Ray32> {
    let (origin, direction) = (ray.origin.as_vec3(), ray.direction.as_vec3());
    let greatest = origin
        .abs()
        .max_element()
        .max(direction.abs().max_element());
    let is_legal = greatest < GREATEST_COORDINATE && direction.abs().max_element() > 0.0;
    let (t_near, t_far) = (ray.t_min.max(0.0) as f32, ray.t_max as f32);
    (is_legal && t_near.is_finite()).then_some(Ray32 {
        origin: origin.to_array(),
        direction: direction.to_array(),
        t_near,
        t_far,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formulations::Formulation;
    use crate::samples::{self, Shifted};
    use cyltrace::solid::Caps;
    use cyltrace::solid::tessellation::sagitta;

    const SEED: u64 = 6;
    const CASES: u64 = 300;

    fn native(shape: Shape) -> Native {
        Native::new(shape, "tested", &DeviceOptions::default()).unwrap()
    }

    /// Wherever both hit, parts agree but for a few at rims, and points are
    /// within `most` along the normal.
    fn agrees(native: &Native, most: impl Fn(&Cylinder) -> f64) {
        let problems = samples::problems(SEED, CASES);
        let found = native.answers(&problems);
        let expected = Shifted(0.0).answers(&problems);
        let (mut both, mut differ, mut other_part) = (0, 0, 0);
        for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let (Some(found), Some(expected)) = (found, expected) else {
                differ += usize::from(found.is_some() != expected.is_some());
                continue;
            };
            both += 1;
            if found.part != expected.part {
                other_part += 1;
                continue;
            }
            let Problem { cylinder, ray } = &problems[index];
            let slope = found.normal.dot(ray.direction).abs();
            let off = (found.t - expected.t).abs() * slope;
            assert!(
                off <= most(cylinder) + 1e-4,
                "seed {SEED}, case {index}: off by {off:e}, {cylinder:?}, {ray:?}"
            );
        }
        assert!(
            both > 100 && differ < 10 && other_part < 10,
            "{both} both hit, {differ} differ, {other_part} on another part"
        );
    }

    #[test]
    fn cone_curve_unit_directions_agrees_with_the_solver() {
        agrees(&native(Shape::Cone), |_| 0.0);
    }

    #[test]
    fn mesh_of_64_sides_agrees_within_its_sagitta() {
        agrees(&native(Shape::Mesh(64)), |cylinder| {
            // A ray may hit a facet where the cylinder's slope is less than its
            // own by a sixteenth of a turn's sine.
            3.0 * sagitta(cylinder, 64)
        });
    }

    #[test]
    fn bytes_grow_with_the_sides() {
        let [cone, coarse, fine] =
            [Shape::Cone, Shape::Mesh(6), Shape::Mesh(64)].map(|shape| native(shape).bytes());
        assert!(cone > 30 && coarse > cone, "{cone} {coarse}");
        assert!(fine > 6 * coarse && fine < 30 * coarse, "{coarse} {fine}");
    }

    #[test]
    fn problem_beyond_embree_s_limit_is_a_miss() {
        let far = DVec3::X * 1e19;
        let problem = Problem {
            cylinder: Cylinder::new(far, far + DVec3::Z * 1e18, 1e18, Caps::Both).unwrap(),
            ray: Ray::new(DVec3::Z * 5e17, DVec3::X),
        };
        let mut aimed_from_far = samples::problems(SEED, 1)[0];
        aimed_from_far.ray.origin = far;
        for shape in [Shape::Cone, Shape::Mesh(6)] {
            let answers = native(shape).answers(&[problem, aimed_from_far]);
            assert_eq!(answers, [None, None]);
        }
    }

    #[test]
    fn batch_run_depends_on_the_hits() {
        let problems = samples::problems(SEED, 50);
        let cone = native(Shape::Cone);
        let (first, second) = (cone.batch(&problems), cone.batch(&problems[..20]));
        assert!(first.run() > second.run() && second.run() > 0);
        assert_eq!(first.run(), first.run());
    }
}
