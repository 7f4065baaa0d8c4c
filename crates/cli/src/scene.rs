//! Reading, loading and building scenes, for all commands.

use std::path::Path;
use std::sync::Arc;

use anyhow::anyhow;
use cyltrace::embree::MaxIsa;
use cyltrace::scene::{Scene, SceneFile};
use cyltrace::tracer::{Options, Tracer};
use rayon::ThreadPool;

use super::arguments::Common;
use super::limit::{MemoryLimit, Need};
use super::progress;

/// Reads a scene file, but not yet the files that it names, within the memory that
/// `limit` allows.
pub fn read(path: &Path, limit: MemoryLimit) -> anyhow::Result<SceneFile> {
    let _limit = limit.while_reading(path);
    // The error's text is the whole message; its source would repeat a part.
    SceneFile::read(path).map_err(|error| anyhow!("{error}"))
}

/// Loads the files that a scene file names and validates everything; rejects a scene that
/// needs more memory than the limit.
pub fn load(
    common: &Common,
    file: SceneFile,
    need: Need,
    limit: MemoryLimit,
) -> anyhow::Result<Scene> {
    let workers = workers(common)?;
    let spinner = progress::spinner(common, "loading the scene");
    let reading = limit.while_reading(file.path());
    let scene = within(file, &workers, need, limit, common.max_isa);
    drop(reading);
    spinner.finish_and_clear();
    scene
}

/// Loads within a limit: checks the counts that are known beforehand, then the loaded
/// records, as rows of pipes are not counted beforehand.
fn within(
    file: SceneFile,
    workers: &ThreadPool,
    need: Need,
    limit: MemoryLimit,
    max_isa: Option<MaxIsa>,
) -> anyhow::Result<Scene> {
    let path = file.path().to_owned();
    let reading = file.reading_bytes(workers.current_num_threads());
    let left = limit.check(&path, &file.contents(), reading, need, max_isa)?;
    let scene = workers.install(|| file.load_within(left));
    let scene = scene.map_err(|error| anyhow!("{error}"))?;
    let contents = workers.install(|| scene.contents());
    limit.check(&path, &contents, 0, need, max_isa)?;
    Ok(scene)
}

/// Builds the tracer, with options that are the command's own.
pub fn build(common: &Common, scene: &Arc<Scene>, options: Options) -> anyhow::Result<Tracer> {
    let spinner = progress::spinner(common, "building the scene");
    let options = Options {
        threads: common.threads,
        max_isa: common.max_isa,
        ..options
    };
    // Within the pool: rayon's global pool panics if its threads cannot be started.
    let tracer = workers(common)?.install(|| Tracer::new(Arc::clone(scene), &options));
    spinner.finish_and_clear();
    Ok(tracer?)
}

/// The threads that trace.
pub fn workers(common: &Common) -> anyhow::Result<ThreadPool> {
    // The error's source has the same text as the error.
    cyltrace::tracer::workers(common.threads).map_err(|error| match common.threads {
        Some(threads) => anyhow!("cannot start {threads} threads: {error}; try fewer"),
        None => anyhow!("cannot start threads: {error}"),
    })
}
