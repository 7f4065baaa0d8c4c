//! Scenes: loaded, traced, freed.

use std::ffi::{CStr, c_char, c_int};
use std::path::Path;
use std::ptr;
use std::slice;
use std::sync::{Arc, OnceLock};

use super::status::{CYLTRACE_ERROR, CYLTRACE_OK, guarded};
use super::types::{ALL_FIELDS, CyltraceHit, CyltraceRay, fields_of};
use cyltrace::math::Ray;
use cyltrace::scene::{self, Scene};
use cyltrace::tracer::{BuildTime, HitFields, Options, Tracer};

/// `struct cyltrace_scene`: a scene, and its tracer once rays are traced.
pub struct CyltraceScene {
    pub(super) scene: Arc<Scene>,
    tracer: OnceLock<Result<Tracer, String>>,
}

impl CyltraceScene {
    fn tracer(&self) -> Result<&Tracer, String> {
        let build = || {
            // Errors are told here; a ray that comes later could not.
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

/// Loads the scene file `path`; null on failure.
///
/// # Safety
/// `path` is null or a text that ends with a NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_scene_load(path: *const c_char) -> *mut CyltraceScene {
    let loaded = guarded(|| {
        if path.is_null() {
            return Err("cyltrace_scene_load: path is null".to_owned());
        }
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
/// `scene` is null or came from [`cyltrace_scene_load`], was not freed, and no
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

/// The first hit of each of `count` rays.
///
/// # Safety
/// `scene` is null or a live scene; `rays` and `hits` are null or point to
/// `count` values, `hits` to such as nobody else uses.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_closest(
    scene: *const CyltraceScene,
    rays: *const CyltraceRay,
    count: usize,
    hits: *mut CyltraceHit,
) -> c_int {
    let answer = |tracer: &Tracer, ray: &Ray| first_hit(tracer, ray, ALL_FIELDS);
    // SAFETY: the caller makes the promise of the function called here.
    unsafe { for_each_ray("cyltrace_closest", scene, rays, count, hits, answer) }
}

/// The first hit of each of `count` rays, with only some fields worked out: a sum of
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
    let function = "cyltrace_closest_with";
    let Some(fields) =
        guarded(|| fields_of(fields).map_err(|error| format!("{function}: {error}")))
    else {
        return CYLTRACE_ERROR;
    };
    let answer = |tracer: &Tracer, ray: &Ray| first_hit(tracer, ray, fields);
    // SAFETY: the caller makes the promise of the function called here.
    unsafe { for_each_ray(function, scene, rays, count, hits, answer) }
}

fn first_hit(tracer: &Tracer, ray: &Ray, fields: HitFields) -> CyltraceHit {
    let hit = tracer.closest_with(ray, fields);
    hit.as_ref().map_or(CyltraceHit::MISS, CyltraceHit::from)
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
    // SAFETY: the caller makes the promise of the function called here.
    unsafe {
        for_each_ray(
            "cyltrace_occluded",
            scene,
            rays,
            count,
            occluded,
            |tracer, ray| u8::from(tracer.occluded(ray)),
        )
    }
}

/// Writes an answer for each ray.
///
/// # Safety
/// As for [`cyltrace_closest`].
unsafe fn for_each_ray<A>(
    function: &str,
    scene: *const CyltraceScene,
    rays: *const CyltraceRay,
    count: usize,
    answers: *mut A,
    answer: impl Fn(&Tracer, &Ray) -> A,
) -> c_int {
    let done = guarded(|| {
        // SAFETY: invariants 1 and 2: null or a live scene, which is only read.
        let scene = unsafe { scene.as_ref() };
        let scene = scene.ok_or_else(|| format!("{function}: scene is null"))?;
        let tracer = scene.tracer()?;
        if count == 0 {
            return Ok(());
        }
        if rays.is_null() || answers.is_null() {
            return Err(format!(
                "{function}: an array is null, and count is {count}"
            ));
        }
        check_array::<CyltraceRay>(function, rays, count)?;
        check_array::<A>(function, answers, count)?;
        // SAFETY: invariant 1: neither null nor impossible, so `count` rays.
        let rays = unsafe { slice::from_raw_parts(rays, count) };
        for (number, ray) in rays.iter().enumerate() {
            let answer = answer(tracer, &Ray::from(ray));
            // SAFETY: invariant 1: not null, so `count` places, which may hold
            // anything before.
            unsafe { answers.add(number).write(answer) };
        }
        Ok(())
    });
    done.map_or(CYLTRACE_ERROR, |()| CYLTRACE_OK)
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
