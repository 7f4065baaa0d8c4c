//! External hits: of another program, or of a mesh.

use anyhow::{anyhow, bail};
use cyltrace::math::Ray;
use cyltrace::meshes::{MeshFile, read_mesh_within};
use cyltrace::scene::{GivenHit, GivenHits};
use cyltrace::tracer::Tracer;
use cyltrace_check::{
    Deviation, F32_TOLERANCE, Outcome, Progress, TracedMesh, compare_hits, compare_mesh,
    rays_around,
};

use super::MOST_LISTED;
use crate::arguments::{CheckArguments, Rays};
use crate::interrupt::Interrupted;
use crate::memory::readable;
use crate::number_rows::NumberRows;
use crate::print;

/// At least the bytes of a triangle with its vertices and in the tree. In STL
/// each has three vertices of its own, which are stored twice. 32 are for building the tree.
const TRIANGLE_BYTES: u64 = 290;

/// Why the segments and the fit in a file's comments are not used.
const NOT_AS_STATED: &str = "the mesh is not what `cyltrace tessellate` makes of this scene with the segments and fit in its comments: the deviation in the comments applies to every solid";

/// What is compared with the exact hits.
pub enum ExternalInput {
    /// The rays, and a hit for each.
    Hits(Vec<Ray>, Vec<GivenHit>, String),
    /// The rays if they are given, the mesh, and its deviation if an argument states it.
    Mesh(Option<Vec<Ray>>, MeshFile, Option<f64>),
}

impl ExternalInput {
    /// Reads the files that the arguments name; `None` if they name none.
    pub fn read(arguments: &CheckArguments) -> anyhow::Result<Option<Self>> {
        if let Some(path) = &arguments.mesh {
            let file = read_mesh_within(path, arguments.max_memory)?;
            if arguments.deviation.or(file.deviation).is_none() {
                bail!(
                    "{}: no comment states the deviation, as those of `cyltrace tessellate` do: use --deviation X",
                    path.display()
                );
            }
            let made_rays = match arguments.rays {
                Rays::Count(count) => count,
                Rays::Table(_) => 0,
            };
            let needed = file.mesh.triangles.len() as u64 * TRIANGLE_BYTES
                + made_rays * size_of::<Ray>() as u64;
            if needed > arguments.max_memory {
                bail!(
                    "{}: the mesh and the rays take about {}, more than the {} of --max-memory",
                    path.display(),
                    readable(needed),
                    readable(arguments.max_memory)
                );
            }
            return Ok(Some(Self::Mesh(
                given_rays(arguments)?,
                file,
                arguments.deviation,
            )));
        }
        let Some(path) = &arguments.hits else {
            return Ok(None);
        };
        let rays = given_rays(arguments)?.unwrap_or_default();
        let format = arguments.format.format();
        let GivenHits { hits, unread } =
            GivenHits::open(path, format, rays.len()).map_err(|error| anyhow!("{error}"))?;
        if let Some(note) = unread {
            print::note(arguments.common.quiet, &note);
        }
        if hits.is_empty() {
            bail!(
                "{}: the table has no rows, so there is nothing to compare",
                path.display()
            );
        }
        if hits.len() != rays.len() {
            let more = match hits.len() > rays.len() {
                true => "more than ",
                false => "",
            };
            bail!(
                "{}: the table has {more}{} rows for {} rays; it needs one row per ray, in order",
                path.display(),
                hits.len().min(rays.len()),
                rays.len()
            );
        }
        let name = path.display().to_string();
        Ok(Some(Self::Hits(rays, hits, name)))
    }

    /// Compares them with the exact hits.
    pub fn compare(
        &self,
        tracer: &Tracer,
        arguments: &CheckArguments,
        progress: &Progress,
    ) -> anyhow::Result<Outcome> {
        let outcome = match self {
            Self::Hits(rays, hits, name) => {
                let reported: Vec<Option<f64>> = hits.iter().map(|hit| hit.t).collect();
                let tolerance = arguments.tolerance.unwrap_or(F32_TOLERANCE);
                let mut outcome =
                    compare_hits(tracer, rays, &reported, tolerance, MOST_LISTED, progress);
                let wrong = outcome.iter_mut().flat_map(|found| &mut found.violations);
                for violation in wrong {
                    let line = hits[violation.index as usize].line;
                    violation.source = Some((name.clone(), line));
                }
                outcome
            }
            Self::Mesh(rays, file, deviation) => {
                let mesh = TracedMesh::new(&file.mesh);
                let made;
                let (class, rays) = match (rays, &arguments.rays) {
                    (Some(rays), _) => ("given", rays),
                    (None, Rays::Count(count)) => {
                        made = rays_around(tracer, arguments.seed, *count);
                        ("around", &made)
                    }
                    (None, Rays::Table(_)) => unreachable!("a table of rays has been read"),
                };
                let rays = (class, rays.as_slice());
                let deviation = match deviation {
                    Some(length) => Deviation::Everywhere(*length),
                    None => Deviation::stated(file, tracer.scene())
                        .expect("the argument or the file states a deviation"),
                };
                let is_local = matches!(deviation, Deviation::Tessellated { .. });
                if arguments.deviation.is_none() && file.made.is_some() && !is_local {
                    print::note(arguments.common.quiet, NOT_AS_STATED);
                }
                let off = (deviation, file.rounding);
                compare_mesh(tracer, &mesh, rays, off, MOST_LISTED, progress)
            }
        };
        Ok(outcome.ok_or(Interrupted::NothingWritten)?)
    }
}

/// The rays of the table; `None` if the argument is a number of rays.
fn given_rays(arguments: &CheckArguments) -> anyhow::Result<Option<Vec<Ray>>> {
    let Rays::Table(path) = &arguments.rays else {
        return Ok(None);
    };
    // The rays and their hits. A growing list is in memory twice.
    let bytes = 2 * (size_of::<Ray>() + size_of::<GivenHit>()) as u64;
    let mut rays = Vec::new();
    let table = NumberRows {
        path,
        format: &arguments.format,
        range: None,
    };
    let note = table.for_each_batch(|blocks: Vec<Vec<Ray>>| {
        rays.extend(blocks.into_iter().flatten());
        if rays.len() as u64 * bytes > arguments.max_memory {
            bail!(
                "{}: {} rays take more than the {} of --max-memory",
                path.display(),
                rays.len(),
                readable(arguments.max_memory)
            );
        }
        Ok(())
    })?;
    if let Some(note) = note {
        print::note(arguments.common.quiet, &note);
    }
    Ok(Some(rays))
}
