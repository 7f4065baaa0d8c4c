//! The structures of `include/cyltrace.h`, field by field.

use std::ffi::c_char;
use std::ptr;

use glam::DVec3;

use cyltrace::math::Ray;
use cyltrace::scene::GREATEST_DEPTH;
use cyltrace::solid::{Crossing, Part};
use cyltrace::tracer::{HitFields, PartialHit};
use cyltrace_check::{Place, ReportedHit};

/// Most placements inside each other.
pub const CYLTRACE_GREATEST_DEPTH: usize = 64;

const _: () = assert!(CYLTRACE_GREATEST_DEPTH == GREATEST_DEPTH);

/// [`CyltraceHit::valid_fields`]: `normal`.
pub const CYLTRACE_VALID_NORMAL: u32 = 1;
/// [`CyltraceHit::valid_fields`]: `primitive`, `part` and `instance`.
pub const CYLTRACE_VALID_PLACE: u32 = 2;

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

/// `struct cyltrace_hit`: see [`Hit`](cyltrace::tracer::Hit); a miss is all zeros.
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
    /// 1 for a hit, 0 for a miss, whose other fields have no meaning.
    pub is_hit: u32,
    /// Which fields beyond `t` are valid: a sum of `CYLTRACE_VALID_...`.
    pub valid_fields: u32,
    /// The prototype that contains the solid; 0 is the scene itself.
    pub prototype: u32,
    /// The solid's number in its prototype.
    pub primitive: u32,
    /// The part of the surface.
    pub part: u32,
    /// Into the solid or out of it.
    pub crossing: u32,
    /// The material's number.
    pub material: u32,
    /// How many of `instance` are valid.
    pub instance_count: u32,
    /// The placements from the scene inward.
    pub instance: [u32; CYLTRACE_GREATEST_DEPTH],
    /// The kind of solid: [`SolidKind::code`](cyltrace::solid::SolidKind::code).
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
        valid_fields: 0,
        prototype: 0,
        primitive: 0,
        part: 0,
        crossing: 0,
        material: 0,
        instance_count: 0,
        instance: [0; CYLTRACE_GREATEST_DEPTH],
        solid: 0,
    };

    /// The hit of a caller's intersector; `None` for a miss. The error is a message: the
    /// hit is in an impossible place.
    pub(super) fn finding(&self) -> Result<Option<ReportedHit>, String> {
        if self.is_hit == 0 {
            return Ok(None);
        }
        let is_valid = |fields| self.valid_fields & fields != 0;
        let place = is_valid(CYLTRACE_VALID_PLACE).then(|| self.place());
        Ok(Some(ReportedHit {
            t: self.t,
            normal: is_valid(CYLTRACE_VALID_NORMAL).then(|| DVec3::from(self.normal)),
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

impl CyltraceHit {
    /// A hit and its path. Fields that were not requested are NaN; without a path, the hit
    /// has no instances.
    pub(super) fn new(hit: &PartialHit, requested_path: Option<&[u32]>) -> Self {
        let (u, v) = hit.uv().unwrap_or((f64::NAN, f64::NAN));
        let path = requested_path.unwrap_or_default();
        let mut instance = [0; CYLTRACE_GREATEST_DEPTH];
        instance[..path.len()].copy_from_slice(path);
        let has_normal = hit.normal().map_or(0, |_| CYLTRACE_VALID_NORMAL);
        let has_place = requested_path.map_or(0, |_| CYLTRACE_VALID_PLACE);
        Self {
            t: hit.t(),
            point: hit.point().unwrap_or(DVec3::NAN).to_array(),
            normal: hit.normal().unwrap_or(DVec3::NAN).to_array(),
            error: hit.error().unwrap_or(f64::NAN),
            u,
            v,
            is_hit: 1,
            valid_fields: has_normal | has_place,
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
            solid: hit.solid().code(),
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
    /// Rows in which more than half of the rays had no witness.
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
