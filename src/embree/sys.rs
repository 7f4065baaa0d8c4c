//! The bindings that `build.rs` generated from the installed headers.
//!
//! C enumerations are newtypes over integers: a Rust enum with a value of another version of
//! Embree would be undefined behavior.

#![allow(
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals,
    reason = "the names are Embree's"
)]
#![allow(
    clippy::allow_attributes_without_reason,
    reason = "bindgen writes such attributes"
)]

use std::mem::offset_of;

include!(concat!(env!("OUT_DIR"), "/embree.rs"));

/// The value of `geomID` without a hit. It is a cast macro, which bindgen skips.
pub const INVALID_ID: u32 = u32::MAX;

/// The components of a ray and hit of any number of lanes are 32-bit words;
/// component `c` of lane `i` is word `c * lanes + i`.
pub mod word {
    pub const RAY_ORIGIN: usize = 0;
    pub const RAY_T_NEAR: usize = 3;
    pub const RAY_DIRECTION: usize = 4;
    pub const RAY_T_FAR: usize = 8;
    pub const RAY_ID: usize = 10;
    pub const HIT_NORMAL_X: usize = 12;
    pub const HIT_V: usize = 16;
    pub const HIT_PRIMITIVE: usize = 17;
    pub const HIT_GEOMETRY: usize = 18;
    pub const HIT_INSTANCE: usize = 19;
}

// For one lane the words are the fields of the single-ray structures.
const _: () = {
    let hit = offset_of!(RTCRayHit, hit);
    assert!(offset_of!(RTCRay, org_x) == 4 * word::RAY_ORIGIN);
    assert!(offset_of!(RTCRay, dir_x) == 4 * word::RAY_DIRECTION);
    assert!(offset_of!(RTCRay, tnear) == 4 * word::RAY_T_NEAR);
    assert!(offset_of!(RTCRay, tfar) == 4 * word::RAY_T_FAR);
    assert!(offset_of!(RTCRay, id) == 4 * word::RAY_ID);
    assert!(hit + offset_of!(RTCHit, Ng_x) == 4 * word::HIT_NORMAL_X);
    assert!(hit + offset_of!(RTCHit, v) == 4 * word::HIT_V);
    assert!(hit + offset_of!(RTCHit, primID) == 4 * word::HIT_PRIMITIVE);
    assert!(hit + offset_of!(RTCHit, geomID) == 4 * word::HIT_GEOMETRY);
    assert!(hit + offset_of!(RTCHit, instID) == 4 * word::HIT_INSTANCE);
    assert!(offset_of!(RTCRayHit, ray) == 0);
    // The structure of one hit is what filter functions get for one lane.
    assert!(hit == 4 * word::HIT_NORMAL_X && offset_of!(RTCHit, Ng_x) == 0);
    assert!(offset_of!(cyltrace_context, embree) == 0);
};
