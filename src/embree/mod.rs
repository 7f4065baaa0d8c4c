//! A safe interface to Embree: devices, scenes, user geometry, triangle meshes, straight
//! curves, spheres, disks and instances; queries of single rays and of packets of up to
//! sixteen; all hits of a ray with triangles or curves.
//!
//! This layer knows neither solids nor scene files. A geometry written in Rust implements
//! [`UserGeometry`]. Its results are stored in a [`Query`], a value of the caller's type that
//! every callback of one ray receives, or in the corresponding value of a packet. Embree 3 and
//! 4 have the same interface here; `shim.c` contains their differences.
//!
//! Rays must be finite: distributions build Embree with assertions, which end the process on a
//! NaN, an infinity or a coordinate beyond [`GREATEST_COORDINATE`]. Callers guarantee it;
//! [`Ray32`] has the exact conditions.
//!
//! # Invariants
//! Every `unsafe` block of this layer relies on one or more of these:
//!
//! 1. **Handles are live.** A handle newtype owns one reference of Embree's and releases it in
//!    its `Drop`, so a handle in scope is valid.
//! 2. **Scenes are dropped first.** [`Scene`] and [`SceneBuilder`] drop the Embree scene (with
//!    it, its geometries), then the user data, then the scenes that it has instances of, then
//!    the device. A device releases its handle before its memory counters. So every pointer
//!    that Embree stores outlives the Embree object that stores it.
//! 3. **User data has one type and is shared.** The data pointer of a geometry and its
//!    callbacks are set together, for the same type, from an `Arc` that is never written to.
//!    `UserGeometry` is `Send + Sync`, so any thread may read it.
//! 4. **A query pointer is a `&mut Q` of the running query,** or the `&mut Q::Packet` if the
//!    context is marked as a packet's. [`Scene`] creates it, and Embree passes it on unchanged
//!    in the context of that query. The callbacks of a query run on the calling thread, one at
//!    a time. A geometry's `Query` is its scene's `Q`. The filter function that collects hits
//!    `H` is set only in scenes whose `Q` is `Vec<H>`, and their `Packet` has no values. An
//!    instanced scene has the `Q` of the scene that it is placed in, so callbacks in an
//!    instance get the same pointer. A nested query borrows from the reference that its
//!    callback received, and ends before it.
//! 5. **Builders write, scenes read.** Until [`SceneBuilder::commit`] one owner has the Embree
//!    scene and no query can run. Afterwards nothing is written, and queries may run on any
//!    number of threads.
//! 6. **Bindings match the library.** `build.rs` generates them from the installed headers, and
//!    [`Device::new`] rejects a library that writes another hit layout. It tests a single ray:
//!    libraries may differ in the number of instance words at the end of a hit, and packets
//!    have the same words, one per lane.
//! 7. **Callback arguments are valid.** Embree passes a structure that is valid for the call,
//!    in the layout of its headers. Rays and hits in it are arrays by component, with `N` lanes
//!    each.
//! 8. **No unwinding.** A panic in a callback ends the process with the callback's name, so no
//!    frame of Embree's is ever unwound.
//! 9. **The processor supports the instructions.** Code for an instruction set is called only
//!    where [`MaxIsa`] detected every feature that the code is compiled with.
//!
//! # Not wrapped, and why
//! | Embree | why |
//! |---|---|
//! | instances of more than one level, instance arrays | further levels are user geometry, with f64 transforms and any depth |
//! | ray streams | removed in Embree 4 |
//! | filter functions except the collecting one, ray masks | a user geometry accepts or rejects hits itself; all mask bits are set |
//! | motion blur, subdivision, grids, ray-facing disks, other curves | not used: nothing here moves or consists of them |
//! | point queries, collision | not queries of rays |
//! | updates of a committed scene | a committed scene is read-only, which is what makes it shareable |

#![allow(
    unsafe_code,
    reason = "calls into C; each block names the invariants it rests on"
)]

mod abort;
mod attach_user;
mod callback;
mod callback_lanes;
mod collect;
mod device;
mod error;
mod float_mode;
mod geometry;
mod instance;
mod isa;
mod joint;
mod kernel;
mod native;
mod packet;
mod prefetch;
mod probe;
mod query;
mod ray;
mod ray_set;
mod scene;
mod sys;
mod types;
mod user;

pub use collect::MeshHit;
pub use device::{Device, DeviceOptions};
pub use error::Error;
pub use float_mode::with_flushed_denormals;
pub use isa::{MaxIsa, UnknownIsa};
pub use joint::JointCommit;
pub use kernel::{Instructions, Kernel};
pub use packet::{Coherence, Rays32};
pub(crate) use prefetch::prefetch;
pub use query::{NoPackets, Query};
pub use ray::{Box32, NativeHit, Ray32};
pub use ray_set::{GREATEST_PACKET, RayNumbers, RaySet};
pub use scene::{Scene, SceneBuilder};
pub use types::{GREATEST_COORDINATE, GeometryId, PacketWidth, Version};
pub use user::{Reached, UserGeometry};
