//! A scene that several threads build together.
//!
//! `rtcJoinCommitScene` lets a thread take part in a build that another thread has begun. It
//! does not report when all threads have left the build, nor which thread receives an error. So
//! threads are counted in and out here, and the last one out creates the scene or the error
//! that all of them get.

use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};

use super::error::Error;
use super::float_mode::with_default_float_mode;
use super::query::Query;
use super::scene::{Parts, Scene, SceneBuilder};
use super::sys;

/// A scene that is built by the threads that [join](Self::join). Created by
/// [`SceneBuilder::into_joint`](super::SceneBuilder::into_joint).
///
/// It serves scenes that are built when a ray first needs them: threads that arrive during the
/// build join it instead of waiting.
pub struct JointCommit<Q: Query> {
    built: OnceLock<Result<Arc<Scene<Q>>, Error>>,
    work: Mutex<Work>,
    /// Notified when `built` is set.
    finished: Condvar,
    /// Whether Embree supports joining.
    may_join: bool,
}

/// The state of the build.
struct Work {
    /// The parts of the scene, until it is built.
    parts: Option<Parts>,
    /// The number of threads in the build.
    builders: u32,
    /// Whether a thread has left the build, which happens only when the build is over: threads
    /// that arrive now have nothing to do.
    is_over: bool,
    /// The first error that a thread received.
    error: Option<Error>,
}

impl<Q: Query> SceneBuilder<Q> {
    /// Lets several threads take part in building the hierarchy.
    #[must_use]
    pub fn into_joint(self) -> JointCommit<Q> {
        JointCommit::new(self.into_parts())
    }
}

impl<Q: Query> JointCommit<Q> {
    fn new(parts: Parts) -> Self {
        let property = sys::RTC_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED;
        Self {
            may_join: parts.device().property(property) != 0,
            built: OnceLock::new(),
            work: Mutex::new(Work {
                parts: Some(parts),
                builders: 0,
                is_over: false,
                error: None,
            }),
            finished: Condvar::new(),
        }
    }

    /// Returns the scene, built if necessary: the first thread begins the build, others take
    /// part until it is done. If Embree does not support joining, they wait. May be called
    /// within a callback of a query, but not while this same scene calls
    /// [`bounds`](super::UserGeometry::bounds).
    ///
    /// # Errors
    /// As [`SceneBuilder::commit`](super::SceneBuilder::commit); every thread gets the same
    /// error.
    pub fn join(&self) -> Result<&Arc<Scene<Q>>, Error> {
        if self.built.get().is_none() {
            self.build();
        }
        let built = self.built.get().expect("a build ends with an answer");
        built.as_ref().map_err(Clone::clone)
    }

    #[cold]
    fn build(&self) {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let is_needed = work.builders == 0 || self.may_join;
        if let Some(parts) = work.parts.as_ref().filter(|_| is_needed && !work.is_over) {
            let (scene, device) = (parts.raw(), parts.device().clone());
            work.builders += 1;
            drop(work);
            // Embree flushes denormal numbers while it builds; the former mode of this thread
            // is restored in any case.
            with_default_float_mode(|| {
                // SAFETY: invariants 1 and 5: the parts are kept until every builder has left,
                // and nothing else uses the scene.
                unsafe {
                    if self.may_join {
                        sys::rtcJoinCommitScene(scene);
                    } else {
                        sys::rtcCommitScene(scene);
                    }
                }
            });
            let answer = device.check("commit a scene");
            work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
            work.is_over = true;
            work.builders -= 1;
            work.error = work.error.take().or(answer.err());
            if work.builders == 0 {
                self.finish(&mut work);
            }
        }
        let is_unfinished = |_: &mut Work| self.built.get().is_none();
        let _finished = self.finished.wait_while(work, is_unfinished);
    }

    /// Creates the scene or the error for all threads.
    fn finish(&self, work: &mut Work) {
        let parts = work.parts.take().expect("one builder is the last");
        let built = work.error.take().map_or_else(|| parts.into_scene(), Err);
        let built = built.map(Arc::new);
        assert!(self.built.set(built).is_ok(), "one builder is the last");
        self.finished.notify_all();
    }
}
