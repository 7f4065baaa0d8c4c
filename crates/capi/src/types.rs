//! The structures of `include/cyltrace.h`, field by field.

use std::ffi::c_char;
use std::ptr;

use glam::DVec3;

use cyltrace::math::Ray;
use cyltrace::scene::GREATEST_DEPTH;
use cyltrace::solid::{Crossing, Part, SolidKind};
use cyltrace::tracer::{HitFields, PartialHit};
use cyltrace_check::{Place, ReportedHit};

/// Most placements inside each other.
pub const CYLTRACE_GREATEST_DEPTH: usize = 64;

const _: () = assert!(CYLTRACE_GREATEST_DEPTH == GREATEST_DEPTH);

/// [`CyltraceHit::tells`]: `normal` is told.
pub const CYLTRACE_TELLS_NORMAL: u32 = 1;
/// [`CyltraceHit::tells`]: `primitive`, `part` and `instance` are told.
pub const CYLTRACE_TELLS_PLACE: u32 = 2;

/// [`cyltrace_closest_with`](super::cyltrace_closest_with): `point`.
pub const CYLTRACE_FIELD_POINT: u32 = 1;
/// [`cyltrace_closest_with`](super::cyltrace_closest_with): `normal`.
pub const CYLTRACE_FIELD_NORMAL: u32 = 2;
/// [`cyltrace_closest_with`](super::cyltrace_closest_with): `u` and `v`.
pub const CYLTRACE_FIELD_UV: u32 = 4;
/// [`cyltrace_closest_with`](super::cyltrace_closest_with): `error`.
pub const CYLTRACE_FIELD_ERROR: u32 = 8;
/// [`cyltrace_closest_with`](super::cyltrace_closest_with): `instance_count` and `instance`.
pub const CYLTRACE_FIELD_PATH: u32 = 16;
/// [`cyltrace_closest_with`](super::cyltrace_closest_with): all of them.
pub const CYLTRACE_FIELD_ALL: u32 = 31;

/// The fields and their codes.
const FIELDS: [(HitFields, u32); 5] = [
    (HitFields::POINT, CYLTRACE_FIELD_POINT),
    (HitFields::NORMAL, CYLTRACE_FIELD_NORMAL),
    (HitFields::UV, CYLTRACE_FIELD_UV),
    (HitFields::ERROR, CYLTRACE_FIELD_ERROR),
    (HitFields::PATH, CYLTRACE_FIELD_PATH),
];

/// The fields of a sum of their codes. The error is a message: another number is in it.
pub(super) fn fields_of(codes: u32) -> Result<HitFields, String> {
    if codes & !CYLTRACE_FIELD_ALL != 0 {
        return Err(format!(
            "fields is {codes}: it is a sum of CYLTRACE_FIELD_..., at most {CYLTRACE_FIELD_ALL}"
        ));
    }
    let is_in = |(_, code): &&(HitFields, u32)| codes & code != 0;
    let fields = FIELDS.iter().filter(is_in).map(|(field, _)| *field);
    Ok(fields.collect())
}

/// [`CyltraceHit::part`]: the curved wall.
pub const CYLTRACE_SIDE: u32 = 0;
/// [`CyltraceHit::part`]: the disk at `p0`.
pub const CYLTRACE_CAP0: u32 = 1;
/// [`CyltraceHit::part`]: the disk at `p1`.
pub const CYLTRACE_CAP1: u32 = 2;
/// [`CyltraceHit::part`]: the face of a cuboid where its own x is least.
pub const CYLTRACE_X_MIN: u32 = 3;
/// [`CyltraceHit::part`]: where x is greatest.
pub const CYLTRACE_X_MAX: u32 = 4;
/// [`CyltraceHit::part`]: where y is least.
pub const CYLTRACE_Y_MIN: u32 = 5;
/// [`CyltraceHit::part`]: where y is greatest.
pub const CYLTRACE_Y_MAX: u32 = 6;
/// [`CyltraceHit::part`]: where z is least.
pub const CYLTRACE_Z_MIN: u32 = 7;
/// [`CyltraceHit::part`]: where z is greatest.
pub const CYLTRACE_Z_MAX: u32 = 8;

/// The parts and their codes.
const PARTS: [(Part, u32); 9] = [
    (Part::Side, CYLTRACE_SIDE),
    (Part::Cap0, CYLTRACE_CAP0),
    (Part::Cap1, CYLTRACE_CAP1),
    (Part::XMin, CYLTRACE_X_MIN),
    (Part::XMax, CYLTRACE_X_MAX),
    (Part::YMin, CYLTRACE_Y_MIN),
    (Part::YMax, CYLTRACE_Y_MAX),
    (Part::ZMin, CYLTRACE_Z_MIN),
    (Part::ZMax, CYLTRACE_Z_MAX),
];

/// [`CyltraceHit::solid`]: a cylinder.
pub const CYLTRACE_SOLID_CYLINDER: u32 = 0;
/// [`CyltraceHit::solid`]: a cone.
pub const CYLTRACE_SOLID_CONE: u32 = 1;
/// [`CyltraceHit::solid`]: a rounded cone.
pub const CYLTRACE_SOLID_ROUNDED_CONE: u32 = 2;
/// [`CyltraceHit::solid`]: a sphere.
pub const CYLTRACE_SOLID_SPHERE: u32 = 3;
/// [`CyltraceHit::solid`]: a cuboid.
pub const CYLTRACE_SOLID_CUBOID: u32 = 4;
/// [`CyltraceHit::solid`]: a disk.
pub const CYLTRACE_SOLID_DISK: u32 = 5;
/// [`CyltraceHit::solid`]: a union of solids; the part is that of the one met.
pub const CYLTRACE_SOLID_UNION: u32 = 6;
/// [`CyltraceHit::solid`]: an intersection of solids.
pub const CYLTRACE_SOLID_INTERSECTION: u32 = 7;
/// [`CyltraceHit::solid`]: a solid without others.
pub const CYLTRACE_SOLID_DIFFERENCE: u32 = 8;

/// [`CyltraceHit::crossing`]: the ray goes into the solid.
pub const CYLTRACE_ENTER: u32 = 0;
/// [`CyltraceHit::crossing`]: the ray goes out of it.
pub const CYLTRACE_LEAVE: u32 = 1;

/// `struct cyltrace_ray`: see [`Ray`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CyltraceRay {
    /// The point at `t = 0`.
    pub origin: [f64; 3],
    /// Any direction of any length.
    pub direction: [f64; 3],
    /// Least `t` that counts.
    pub t_min: f64,
    /// Greatest `t` that counts.
    pub t_max: f64,
}

impl From<&Ray> for CyltraceRay {
    fn from(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            t_min: ray.t_min,
            t_max: ray.t_max,
        }
    }
}

impl From<&CyltraceRay> for Ray {
    fn from(ray: &CyltraceRay) -> Self {
        Self {
            origin: ray.origin.into(),
            direction: ray.direction.into(),
            t_min: ray.t_min,
            t_max: ray.t_max,
        }
    }
}

/// `struct cyltrace_hit`: see [`Hit`](cyltrace::tracer::Hit); all zeros is a miss.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CyltraceHit {
    /// The ray's parameter.
    pub t: f64,
    /// The hit point.
    pub point: [f64; 3],
    /// The outward unit normal.
    pub normal: [f64; 3],
    /// Bounds the distance of `point` from the true surface.
    pub error: f64,
    /// Angle around the axis over 2π.
    pub u: f64,
    /// Position along the axis.
    pub v: f64,
    /// 1 for a hit, 0 for a miss; then nothing else counts.
    pub is_hit: u32,
    /// Which fields beyond `t` are told, where a caller answers.
    pub tells: u32,
    /// The prototype that holds the solid; 0 is the scene itself.
    pub prototype: u32,
    /// The solid's number in its prototype.
    pub primitive: u32,
    /// The part of the surface.
    pub part: u32,
    /// Into the solid or out of it.
    pub crossing: u32,
    /// The material's number.
    pub material: u32,
    /// How many of `instance` count.
    pub instance_count: u32,
    /// The placements from the scene inward.
    pub instance: [u32; CYLTRACE_GREATEST_DEPTH],
    /// The kind of solid.
    pub solid: u32,
}

impl CyltraceHit {
    /// No hit.
    pub const MISS: Self = Self {
        t: 0.0,
        point: [0.0; 3],
        normal: [0.0; 3],
        error: 0.0,
        u: 0.0,
        v: 0.0,
        is_hit: 0,
        tells: 0,
        prototype: 0,
        primitive: 0,
        part: 0,
        crossing: 0,
        material: 0,
        instance_count: 0,
        instance: [0; CYLTRACE_GREATEST_DEPTH],
        solid: CYLTRACE_SOLID_CYLINDER,
    };

    /// What a caller's intersector tells; `None` for a miss. The error is a
    /// message: a place is told that cannot be.
    pub(super) fn finding(&self) -> Result<Option<ReportedHit>, String> {
        if self.is_hit == 0 {
            return Ok(None);
        }
        let tells = |what| self.tells & what != 0;
        let place = tells(CYLTRACE_TELLS_PLACE).then(|| self.place());
        Ok(Some(ReportedHit {
            t: self.t,
            normal: tells(CYLTRACE_TELLS_NORMAL).then(|| DVec3::from(self.normal)),
            place: place.transpose()?,
        }))
    }

    fn place(&self) -> Result<Place, String> {
        let known = PARTS.iter().find(|(_, code)| *code == self.part);
        let Some(&(part, _)) = known else {
            let part = self.part;
            return Err(format!("a hit's part is {part}: there is no such part"));
        };
        let count = self.instance_count;
        let instance = self.instance.get(..count as usize).ok_or_else(|| {
            format!("a hit's instance_count is {count}: it is at most {CYLTRACE_GREATEST_DEPTH}")
        })?;
        Ok(Place {
            instance: instance.to_vec(),
            primitive: self.primitive,
            part,
        })
    }
}

fn part_code(part: Part) -> u32 {
    let known = PARTS.iter().find(|(known, _)| *known == part);
    known.expect("every part has a code").1
}

/// Fields that were not requested are NaN; without its path, a hit has no instances.
impl From<&PartialHit> for CyltraceHit {
    fn from(hit: &PartialHit) -> Self {
        let (u, v) = hit.uv().unwrap_or((f64::NAN, f64::NAN));
        let path = hit.instance().unwrap_or_default();
        let mut instance = [0; CYLTRACE_GREATEST_DEPTH];
        instance[..path.len()].copy_from_slice(path);
        let tells_normal = hit.normal().map_or(0, |_| CYLTRACE_TELLS_NORMAL);
        let tells_place = hit.instance().map_or(0, |_| CYLTRACE_TELLS_PLACE);
        Self {
            t: hit.t(),
            point: hit.point().unwrap_or(DVec3::NAN).to_array(),
            normal: hit.normal().unwrap_or(DVec3::NAN).to_array(),
            error: hit.error().unwrap_or(f64::NAN),
            u,
            v,
            is_hit: 1,
            tells: tells_normal | tells_place,
            prototype: hit.prototype().0,
            primitive: hit.primitive(),
            part: part_code(hit.part()),
            crossing: match hit.crossing() {
                Crossing::Enter => CYLTRACE_ENTER,
                Crossing::Leave => CYLTRACE_LEAVE,
            },
            material: hit.material().0.into(),
            instance_count: path.len() as u32,
            instance,
            solid: match hit.solid() {
                SolidKind::Cylinder => CYLTRACE_SOLID_CYLINDER,
                SolidKind::Cone => CYLTRACE_SOLID_CONE,
                SolidKind::RoundedCone => CYLTRACE_SOLID_ROUNDED_CONE,
                SolidKind::Sphere => CYLTRACE_SOLID_SPHERE,
                SolidKind::Cuboid => CYLTRACE_SOLID_CUBOID,
                SolidKind::Disk => CYLTRACE_SOLID_DISK,
                SolidKind::Union => CYLTRACE_SOLID_UNION,
                SolidKind::Intersection => CYLTRACE_SOLID_INTERSECTION,
                SolidKind::Difference => CYLTRACE_SOLID_DIFFERENCE,
            },
        }
    }
}

/// [`CyltraceCheckSettings::classes`]: rays of the scene's camera.
pub const CYLTRACE_CAMERA: u32 = 1;
/// [`CyltraceCheckSettings::classes`]: from around the scene into it.
pub const CYLTRACE_SPHERE: u32 = 2;
/// [`CyltraceCheckSettings::classes`]: from inside solids.
pub const CYLTRACE_INSIDE: u32 = 4;
/// [`CyltraceCheckSettings::classes`]: aimed at silhouettes and rims.
pub const CYLTRACE_GRAZING: u32 = 8;
/// [`CyltraceCheckSettings::classes`]: parallel to axes.
pub const CYLTRACE_AXIAL: u32 = 16;

/// `struct cyltrace_check_settings`: zero or null in a field is its default.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct CyltraceCheckSettings {
    /// Rays of each class.
    pub rays: u64,
    /// Chooses the rays.
    pub seed: u64,
    /// Bytes that meshes may take.
    pub max_memory: u64,
    /// Violations that are listed.
    pub most_listed: u64,
    /// Sides of the prisms.
    pub segments: *const u32,
    /// How many numbers of sides there are.
    pub segment_count: usize,
    /// Bits of the classes to check.
    pub classes: u32,
    /// Threads that call the intersector.
    pub threads: u32,
}

/// `struct cyltrace_check_outcome`.
#[repr(C)]
#[derive(Debug)]
pub struct CyltraceCheckOutcome {
    /// Rays, counted once for each row of the table.
    pub rays: u64,
    /// Wrong answers.
    pub violations: u64,
    /// Rows of which more than half of the rays had no witness.
    pub unwitnessed_rows: u64,
    /// The outcome for people.
    pub text: *mut c_char,
    /// The outcome for programs.
    pub json: *mut c_char,
}

impl CyltraceCheckOutcome {
    /// Of a check that could not run.
    pub const NOTHING: Self = Self {
        rays: 0,
        violations: 0,
        unwitnessed_rows: 0,
        text: ptr::null_mut(),
        json: ptr::null_mut(),
    };
}
