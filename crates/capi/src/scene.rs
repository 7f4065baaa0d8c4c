//! Scenes: loaded, traced, freed.

use std::ffi::{CStr, c_char, c_int};
use std::mem::MaybeUninit;
use std::path::Path;
use std::ptr;
use std::slice;
use std::sync::{Arc, OnceLock};

use super::status::{CYLTRACE_ERROR, CYLTRACE_OK, guarded};
use super::types::{CYLTRACE_FIELD_ALL, CyltraceHit, CyltraceRay, fields_of};
use super::version::{CyltraceLayout, check_size};
use cyltrace::math::Ray;
use cyltrace::scene::{self, Scene};
use cyltrace::tracer::{BuildTime, FirstHit, HitFields, Options, Tracer};

/// `struct cyltrace_scene`: a scene, and its tracer once rays are traced.
pub struct CyltraceScene {
    pub(super) scene: Arc<Scene>,
    tracer: OnceLock<Result<Tracer, String>>,
}

impl CyltraceScene {
    fn tracer(&self) -> Result<&Tracer, String> {
        let build = || {
            // An error is returned here; a later ray could not return it.
            let options = Options {
                build: BuildTime::AtOnce,
                ..Options::default()
            };
            let built = Tracer::new(Arc::clone(&self.scene), &options);
            built.map_err(|error| error.to_string())
        };
        let built = self.tracer.get_or_init(build);
        built.as_ref().map_err(String::clone)
    }
}

/// Loads the scene file `path` for a program with the layout `program`; null on failure.
///
/// # Safety
/// `path` is null or a text that ends with a NUL; `program` is null or points to as many
/// bytes as its first field says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_scene_load_checked(
    path: *const c_char,
    program: *const CyltraceLayout,
) -> *mut CyltraceScene {
    let loaded = guarded(|| {
        let fault = |fault: String| format!("cyltrace_scene_load: {fault}");
        if path.is_null() {
            return Err(fault("path is null".to_owned()));
        }
        if program.is_null() {
            return Err(fault("program is null".to_owned()));
        }
        // SAFETY: invariant 1: not null, and the first field is there in every version.
        let size = unsafe { program.cast::<u32>().read() };
        check_size(size).map_err(fault)?;
        // SAFETY: invariant 1: not null, and of the size that was just checked.
        unsafe { program.read() }.check().map_err(fault)?;
        // SAFETY: invariant 1: not null, so a text with its NUL.
        let path = unsafe { CStr::from_ptr(path) };
        let scene = scene::load(&native_path(path)?).map_err(|error| error.to_string())?;
        Ok(Box::new(CyltraceScene {
            scene: Arc::new(scene),
            tracer: OnceLock::new(),
        }))
    });
    loaded.map_or(ptr::null_mut(), Box::into_raw)
}

/// Frees a scene; null is ignored.
///
/// # Safety
/// `scene` is null or came from [`cyltrace_scene_load_checked`], was not freed, and no
/// call uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_scene_free(scene: *mut CyltraceScene) {
    guarded(|| {
        if !scene.is_null() {
            // SAFETY: invariant 2: it came from `Box::into_raw`, and comes back once.
            drop(unsafe { Box::from_raw(scene) });
        }
        Ok(())
    });
}

/// The most rays that are traced together: enough for packets of neighbors, few enough that
/// a call needs at most 2 MB beside the caller's arrays.
const BATCH: usize = 4096;

/// Fewer rays than a packet are traced one by one: with its own few rays, a call cannot find
/// out whether packets pay.
const LEAST_BATCH: usize = 16;

/// The first hit of each of `count` rays.
///
/// # Safety
/// `scene` is null or a live scene; `rays` and `hits` are null or point to
/// `count` values; nothing else uses `hits` during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_closest(
    scene: *const CyltraceScene,
    rays: *const CyltraceRay,
    count: usize,
    hits: *mut CyltraceHit,
) -> c_int {
    let fields = CYLTRACE_FIELD_ALL;
    // SAFETY: the caller makes the promise of the function called here.
    unsafe { closest("cyltrace_closest", scene, rays, count, fields, hits) }
}

/// The first hit of each of `count` rays, with only the fields in `fields`, a sum of
/// `CYLTRACE_FIELD_...`.
///
/// # Safety
/// As for [`cyltrace_closest`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_closest_with(
    scene: *const CyltraceScene,
    rays: *const CyltraceRay,
    count: usize,
    fields: u32,
    hits: *mut CyltraceHit,
) -> c_int {
    // SAFETY: the caller makes the promise of the function called here.
    unsafe { closest("cyltrace_closest_with", scene, rays, count, fields, hits) }
}

/// Both functions for closest hits; `function` is the name in messages.
///
/// # Safety
/// As for [`cyltrace_closest`].
unsafe fn closest(
    function: &str,
    scene: *const CyltraceScene,
    rays: *const CyltraceRay,
    count: usize,
    fields: u32,
    hits: *mut CyltraceHit,
) -> c_int {
    let done = guarded(|| {
        let fields = fields_of(fields).map_err(|error| format!("{function}: {error}"))?;
        let single = |tracer: &Tracer, ray: &Ray| {
            let first = tracer.first_hit(ray);
            first.map_or(CyltraceHit::MISS, |first| in_c(tracer, ray, &first, fields))
        };
        let mut found = Vec::new();
        let batch = |tracer: &Tracer, rays: &[Ray], hits: &mut [MaybeUninit<CyltraceHit>]| {
            tracer.first_hits(rays, &mut found);
            for ((ray, first), hit) in rays.iter().zip(&found).zip(hits) {
                match first {
                    Some(first) => hit.write(in_c(tracer, ray, first, fields)),
                    None => hit.write(CyltraceHit::MISS),
                };
            }
        };
        // SAFETY: the caller makes the promise of the function called here.
        unsafe { for_each_ray(function, scene, rays, count, hits, single, batch) }
    });
    done.map_or(CYLTRACE_ERROR, |()| CYLTRACE_OK)
}

/// The hit with only those fields. The path is copied from the first hit, as that of a
/// [`Hit`](cyltrace::tracer::Hit) is allocated.
fn in_c(tracer: &Tracer, ray: &Ray, first: &FirstHit, fields: HitFields) -> CyltraceHit {
    let path = fields.contains(HitFields::PATH).then(|| first.instance());
    let hit = tracer.hit_with(ray, first, fields.difference(HitFields::PATH));
    CyltraceHit::new(&hit, path)
}

/// Whether each of `count` rays hits anything: 1 or 0.
///
/// # Safety
/// As for [`cyltrace_closest`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_occluded(
    scene: *const CyltraceScene,
    rays: *const CyltraceRay,
    count: usize,
    occluded: *mut u8,
) -> c_int {
    let done = guarded(|| {
        let function = "cyltrace_occluded";
        let single = |tracer: &Tracer, ray: &Ray| u8::from(tracer.occluded(ray));
        let mut found = Vec::new();
        let batch = |tracer: &Tracer, rays: &[Ray], occluded: &mut [MaybeUninit<u8>]| {
            tracer.occluded_batch(rays, &mut found);
            for (&found, occluded) in found.iter().zip(occluded) {
                occluded.write(found.into());
            }
        };
        // SAFETY: the caller makes the promise of the function called here.
        unsafe { for_each_ray(function, scene, rays, count, occluded, single, batch) }
    });
    done.map_or(CYLTRACE_ERROR, |()| CYLTRACE_OK)
}

/// Writes a result for each ray: of a few rays by `single`, of a batch by `batch`.
///
/// # Safety
/// As for [`cyltrace_closest`].
unsafe fn for_each_ray<A>(
    function: &str,
    scene: *const CyltraceScene,
    rays: *const CyltraceRay,
    count: usize,
    results: *mut A,
    single: impl Fn(&Tracer, &Ray) -> A,
    mut batch: impl FnMut(&Tracer, &[Ray], &mut [MaybeUninit<A>]),
) -> Result<(), String> {
    // SAFETY: invariants 1 and 2: null or a live scene, which is only read.
    let scene = unsafe { scene.as_ref() };
    let scene = scene.ok_or_else(|| format!("{function}: scene is null"))?;
    let tracer = scene.tracer()?;
    if count == 0 {
        return Ok(());
    }
    if rays.is_null() || results.is_null() {
        return Err(format!(
            "{function}: an array is null, and count is {count}"
        ));
    }
    check_array::<CyltraceRay>(function, rays, count)?;
    check_array::<A>(function, results, count)?;
    // SAFETY: invariant 1: neither null nor impossible, so `count` rays.
    let rays = unsafe { slice::from_raw_parts(rays, count) };
    // SAFETY: invariant 1: likewise `count` places, whose bytes may be anything before.
    let results = unsafe { slice::from_raw_parts_mut(results.cast::<MaybeUninit<A>>(), count) };
    let mut converted = Vec::new();
    for (rays, results) in rays.chunks(BATCH).zip(results.chunks_mut(BATCH)) {
        if rays.len() < LEAST_BATCH {
            for (ray, result) in rays.iter().zip(results) {
                result.write(single(tracer, &Ray::from(ray)));
            }
        } else {
            converted.clear();
            converted.extend(rays.iter().map(Ray::from));
            batch(tracer, &converted, results);
        }
    }
    Ok(())
}

/// Refuses an array that no program can have: one that is not aligned, or that takes
/// more than half of the address space.
fn check_array<T>(function: &str, array: *const T, count: usize) -> Result<(), String> {
    if !array.is_aligned() {
        return Err(format!("{function}: an array is not aligned"));
    }
    let greatest = isize::MAX as usize / size_of::<T>();
    if count > greatest {
        return Err(format!(
            "{function}: count is {count}: an array has at most {greatest} elements"
        ));
    }
    Ok(())
}

/// A file's name as the system has it.
#[cfg(unix)]
fn native_path(path: &CStr) -> Result<std::path::PathBuf, String> {
    use std::os::unix::ffi::OsStrExt;
    Ok(Path::new(std::ffi::OsStr::from_bytes(path.to_bytes())).to_owned())
}

/// A file's name in UTF-8.
#[cfg(not(unix))]
fn native_path(path: &CStr) -> Result<std::path::PathBuf, String> {
    let path = path.to_str();
    let path = path.map_err(|_| "cyltrace_scene_load: path is not UTF-8".to_owned())?;
    Ok(Path::new(path).to_owned())
}
