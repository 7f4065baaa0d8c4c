//! The check of a caller's own intersector.

use std::ffi::{c_int, c_void};
use std::num::NonZeroUsize;
use std::slice;
use std::sync::OnceLock;

use super::outcome;
use super::scene::CyltraceScene;
use super::status::{CYLTRACE_ERROR, CYLTRACE_OK, CYLTRACE_VIOLATIONS, guarded};
use super::types::{
    CYLTRACE_AXIAL, CYLTRACE_CAMERA, CYLTRACE_GRAZING, CYLTRACE_INSIDE, CYLTRACE_SPHERE,
    CyltraceCheckOutcome, CyltraceCheckSettings, CyltraceHit, CyltraceRay,
};
use cyltrace::math::Ray;
use cyltrace::scene::{
    GREATEST_RAYS, GREATEST_THREADS, MOST_LISTED_VIOLATIONS, MOST_SEGMENT_NUMBERS,
};
use cyltrace::tracer::workers;
use cyltrace_check::{Class, Intersector, ReportedHit, Settings, compare};

/// `cyltrace_closest_function`: writes the first hit of each of the rays.
pub type CyltraceClosestFunction = unsafe extern "C" fn(
    user: *mut c_void,
    rays: *const CyltraceRay,
    count: usize,
    hits: *mut CyltraceHit,
);

/// Checks a caller's intersector against meshes of the scene.
///
/// # Safety
/// `scene` is null or a live scene; `settings` and its pointers are null or
/// valid; `outcome` is null or may be written to; `closest` may be called as
/// the header requires, with `user`, from the number of threads in the settings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_check(
    scene: *const CyltraceScene,
    settings: *const CyltraceCheckSettings,
    closest: Option<CyltraceClosestFunction>,
    user: *mut c_void,
    outcome: *mut CyltraceCheckOutcome,
) -> c_int {
    if !outcome.is_null() {
        // SAFETY: invariant 1: not null, so it may be written to; its former content
        // is not ours.
        unsafe { outcome.write(CyltraceCheckOutcome::NOTHING) };
    }
    let checked = guarded(|| {
        let null = |what| format!("cyltrace_check: {what} is null");
        if outcome.is_null() {
            return Err(null("outcome"));
        }
        // SAFETY: invariants 1 and 2: null or a live scene, which is only read.
        let scene = unsafe { scene.as_ref() }.ok_or_else(|| null("scene"))?;
        // SAFETY: invariant 1: null or valid settings.
        let (settings, threads) = unsafe { settings.as_ref() }.map_or_else(
            || Ok((Settings::default(), None)),
            // SAFETY: invariant 1: so are the numbers of sides that they point to.
            |settings| unsafe { read(settings) },
        )?;
        let caller = Caller {
            closest: closest.ok_or_else(|| null("closest"))?,
            user,
            fault: OnceLock::new(),
        };
        let workers = workers(threads).map_err(|error| error.to_string())?;
        let found = workers.install(|| compare(&scene.scene, &caller, &settings));
        if let Some(fault) = caller.fault.into_inner() {
            return Err(format!("cyltrace_check: {fault}"));
        }
        found.map_err(|error| error.to_string())
    });
    let Some(found) = checked else {
        return CYLTRACE_ERROR;
    };
    let written = guarded(|| Ok(outcome::of(&found)));
    let Some(written) = written else {
        return CYLTRACE_ERROR;
    };
    // SAFETY: invariant 1: a null outcome was rejected above.
    unsafe { outcome.write(written) };
    if found.holds() {
        CYLTRACE_OK
    } else {
        CYLTRACE_VIOLATIONS
    }
}

/// Frees the texts of an outcome; null, and an outcome without texts, are
/// ignored.
///
/// # Safety
/// `outcome` is null or was written by [`cyltrace_check()`], and nobody else uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cyltrace_check_outcome_free(outcome: *mut CyltraceCheckOutcome) {
    guarded(|| {
        // SAFETY: invariant 1: null or an outcome that is the caller's alone.
        if let Some(outcome) = unsafe { outcome.as_mut() } {
            // SAFETY: invariant 2: the texts are of `outcome::of`, and are
            // forgotten once they are freed.
            unsafe { outcome::free(outcome) };
        }
        Ok(())
    });
}

/// The settings and the number of threads.
///
/// # Safety
/// Unless it is null, `segments` points to `segment_count` numbers.
unsafe fn read(given: &CyltraceCheckSettings) -> Result<(Settings, Option<NonZeroUsize>), String> {
    const CLASSES: [(u32, Class); 5] = [
        (CYLTRACE_CAMERA, Class::Camera),
        (CYLTRACE_SPHERE, Class::Sphere),
        (CYLTRACE_INSIDE, Class::Inside),
        (CYLTRACE_GRAZING, Class::Grazing),
        (CYLTRACE_AXIAL, Class::Axial),
    ];
    let mut settings = Settings {
        seed: given.seed,
        ..Settings::default()
    };
    at_most("rays", given.rays, GREATEST_RAYS)?;
    at_most("threads", given.threads.into(), GREATEST_THREADS as u64)?;
    at_most("most_listed", given.most_listed, MOST_LISTED_VIOLATIONS)?;
    let numbers = given.segment_count as u64;
    at_most("segment_count", numbers, MOST_SEGMENT_NUMBERS as u64)?;
    if given.rays != 0 {
        settings.rays = given.rays;
    }
    if given.max_memory != 0 {
        settings.max_memory = given.max_memory;
    }
    if given.most_listed != 0 {
        settings.most_listed = usize::try_from(given.most_listed).unwrap_or(usize::MAX);
    }
    if !given.segments.is_null() && given.segment_count != 0 {
        if !given.segments.is_aligned() {
            return Err("cyltrace_check: segments is not aligned".to_owned());
        }
        // SAFETY: invariant 1: not null, so that many numbers.
        let segments = unsafe { slice::from_raw_parts(given.segments, given.segment_count) };
        settings.segments = segments.to_vec();
    }
    let all = CLASSES.iter().fold(0, |all, (bit, _)| all | bit);
    if given.classes & !all != 0 {
        let classes = given.classes;
        return Err(format!(
            "cyltrace_check: classes is {classes}: it must be a sum of CYLTRACE_CAMERA to CYLTRACE_AXIAL"
        ));
    }
    if given.classes != 0 {
        let is_wanted = |(bit, _): &(u32, Class)| given.classes & bit != 0;
        let wanted = CLASSES.into_iter().filter(is_wanted);
        settings.classes = wanted.map(|(_, class)| class).collect();
    }
    Ok((settings, NonZeroUsize::new(given.threads as usize)))
}

/// Rejects a setting that is too large.
fn at_most(name: &str, value: u64, greatest: u64) -> Result<(), String> {
    if value > greatest {
        return Err(format!(
            "cyltrace_check: {name} is {value}: it is at most {greatest}"
        ));
    }
    Ok(())
}

/// The caller's intersector.
struct Caller {
    closest: CyltraceClosestFunction,
    user: *mut c_void,
    /// The first invalid answer.
    fault: OnceLock<String>,
}

// SAFETY: the header requires a function that may be called, with `user`, from the number of
// threads in the settings; Rust itself never follows `user`.
unsafe impl Sync for Caller {}

impl Intersector for Caller {
    fn closest(&self, ray: &Ray) -> Option<ReportedHit> {
        self.closest_of_each(slice::from_ref(ray)).pop()?
    }

    fn closest_of_each(&self, rays: &[Ray]) -> Vec<Option<ReportedHit>> {
        let rays: Vec<CyltraceRay> = rays.iter().map(CyltraceRay::from).collect();
        let mut hits = vec![CyltraceHit::MISS; rays.len()];
        // SAFETY: invariants 1 and 3: as many rays as hits that live through the call; the
        // caller promised a function that takes them.
        unsafe { (self.closest)(self.user, rays.as_ptr(), rays.len(), hits.as_mut_ptr()) };
        let finding = |hit: &CyltraceHit| {
            hit.finding().unwrap_or_else(|fault| {
                self.fault.get_or_init(|| fault);
                None
            })
        };
        hits.iter().map(finding).collect()
    }
}
