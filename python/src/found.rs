//! What a query found, from which the columns of `Hits` are computed on request.

use std::sync::Arc;

use cyltrace::math::Ray;
use cyltrace::solid::{Crossing, Part, SolidKind};
use cyltrace::tracer::{FirstHit, HitFields, PartialHit, Tracer};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rayon::prelude::*;

use crate::arrays::{Vectors, value_error};
use crate::tracer::Tracing;

/// The parts of surfaces in the order of their codes.
pub const PARTS: [Part; 9] = [
    Part::Side,
    Part::Cap0,
    Part::Cap1,
    Part::XMin,
    Part::XMax,
    Part::YMin,
    Part::YMax,
    Part::ZMin,
    Part::ZMax,
];

/// The code of a kind of solid, the position in [`kinds`].
fn kind_code(kind: SolidKind) -> i8 {
    position(kinds(), &kind)
}

/// The kinds of solids in the order of their codes.
pub fn kinds() -> impl Iterator<Item = SolidKind> {
    let simple = SolidKind::SIMPLE.iter();
    simple.chain(SolidKind::OPERATIONS).copied()
}

/// Codes are few: -1 says that there is none.
fn position<T: PartialEq>(mut all: impl Iterator<Item = T>, one: &T) -> i8 {
    let position = all.position(|other| other == *one);
    position.map_or(-1, |position| position as i8)
}

/// Some answers in a row.
pub enum Block {
    /// The first hits of rays. A ray has the number of its hit, or [`MISS`].
    First {
        slots: Vec<u32>,
        rays: Vec<Ray>,
        hits: Vec<FirstHit>,
    },
    /// Hits with all of their fields.
    Whole(Vec<PartialHit>),
}

/// The slot of a ray without a hit.
pub const MISS: u32 = u32::MAX;

impl Block {
    /// The block of the first hits of rays. Only rays that hit are kept.
    pub fn first(mut rays: Vec<Ray>, hits: Vec<Option<FirstHit>>) -> Self {
        let mut next = 0;
        let slot = |hit: &Option<FirstHit>| {
            let slot = if hit.is_some() { next } else { MISS };
            next += u32::from(hit.is_some());
            slot
        };
        let slots = hits.iter().map(slot).collect();
        let mut each = hits.iter();
        rays.retain(|_| each.next().is_some_and(Option::is_some));
        rays.shrink_to_fit();
        let mut hits: Vec<FirstHit> = hits.into_iter().flatten().collect();
        hits.shrink_to_fit();
        Self::First { slots, rays, hits }
    }

    fn len(&self) -> usize {
        match self {
            Self::First { slots, .. } => slots.len(),
            Self::Whole(hits) => hits.len(),
        }
    }

    /// Computes `write` of every hit and its target, of the targets of all answers.
    fn write<T>(
        &self,
        tracer: &Tracer,
        fields: HitFields,
        targets: impl Iterator<Item = T>,
        write: &impl Fn(&PartialHit, T),
    ) {
        match self {
            Self::First { slots, rays, hits } => {
                for (&slot, target) in slots.iter().zip(targets) {
                    if slot != MISS {
                        let (ray, first) = (&rays[slot as usize], &hits[slot as usize]);
                        write(&tracer.hit_with(ray, first, fields), target);
                    }
                }
            }
            Self::Whole(hits) => hits
                .iter()
                .zip(targets)
                .for_each(|(hit, target)| write(hit, target)),
        }
    }

    /// As [`Block::write`], of what the query itself finds: nothing is computed again.
    fn write_found<T>(
        &self,
        targets: &mut [T],
        of_first: &impl Fn(&FirstHit) -> T,
        of_whole: &impl Fn(&PartialHit) -> T,
    ) {
        match self {
            Self::First { slots, hits, .. } => {
                for (slot, target) in slots.iter().zip(targets) {
                    if let Some(first) = hits.get(*slot as usize) {
                        *target = of_first(first);
                    }
                }
            }
            Self::Whole(hits) => {
                for (hit, target) in hits.iter().zip(targets) {
                    *target = of_whole(hit);
                }
            }
        }
    }

    /// The answer at a position.
    fn answer(&self, position: usize) -> Answer<'_> {
        match self {
            Self::First { slots, rays, hits } => match slots[position] {
                MISS => Answer::Miss,
                slot => Answer::First(&rays[slot as usize], &hits[slot as usize]),
            },
            Self::Whole(hits) => Answer::Whole(&hits[position]),
        }
    }
}

enum Answer<'a> {
    Miss,
    First(&'a Ray, &'a FirstHit),
    Whole(&'a PartialHit),
}

/// Answers to rays, in their order.
#[pyclass(frozen, module = "cyltrace._core")]
pub struct Found {
    tracing: Arc<Tracing>,
    blocks: Vec<Block>,
}

/// Answers a block holds at most, but for the hits of one ray.
pub const BLOCK: usize = 1 << 14;

impl Found {
    /// These answers.
    pub fn new(tracing: Arc<Tracing>, blocks: Vec<Block>) -> Self {
        Self { tracing, blocks }
    }

    fn values<T: Clone + Send + Sync>(
        &self,
        py: Python<'_>,
        fields: HitFields,
        missing: T,
        get: impl Fn(&PartialHit) -> T + Sync,
    ) -> Vec<T> {
        let tracer = &self.tracing.tracer;
        let write = |hit: &PartialHit, target: &mut T| *target = get(hit);
        py.detach(|| {
            let mut values = vec![missing; self.len()];
            self.for_each_block(self.targets(&mut values), |block, targets| {
                block.write(tracer, fields, targets.iter_mut(), &write);
            });
            values
        })
    }

    /// See [`Block::write_found`].
    fn found_values<T: Clone + Send + Sync>(
        &self,
        py: Python<'_>,
        missing: T,
        of_first: impl Fn(&FirstHit) -> T + Sync,
        of_whole: impl Fn(&PartialHit) -> T + Sync,
    ) -> Vec<T> {
        py.detach(|| {
            let mut values = vec![missing; self.len()];
            self.for_each_block(self.targets(&mut values), |block, targets| {
                block.write_found(targets, &of_first, &of_whole);
            });
            values
        })
    }

    /// How many answers there are.
    fn len(&self) -> usize {
        self.blocks.iter().map(Block::len).sum()
    }

    /// The targets of each block, of those of all answers.
    fn targets<'a, T>(&self, mut all: &'a mut [T]) -> Vec<&'a mut [T]> {
        let targets = self.blocks.iter().map(|block| {
            let (targets, rest) = std::mem::take(&mut all).split_at_mut(block.len());
            all = rest;
            targets
        });
        targets.collect()
    }

    /// Calls `write` for each block and its targets, on all threads.
    fn for_each_block<T: Send>(&self, targets: Vec<T>, write: impl Fn(&Block, T) + Sync) {
        let blocks = self.blocks.par_iter().zip(targets);
        let each = || blocks.for_each(|(block, targets)| write(block, targets));
        self.tracing.workers.install(each);
    }
}

/// An array of numbers, or of rows of numbers one after the other.
fn array<T: numpy::Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyAny> {
    PyArray1::from_vec(py, values).into_any()
}

#[pymethods]
impl Found {
    fn __len__(&self) -> usize {
        self.len()
    }

    /// The columns `point` and `normal`, the rows of each one after the other. Most of the work
    /// is to find the hit again, so that both cost little more than one.
    fn vectors<'py>(&self, py: Python<'py>) -> (Bound<'py, PyAny>, Bound<'py, PyAny>) {
        let tracer = &self.tracing.tracer;
        let fields = HitFields::POINT | HitFields::NORMAL;
        let write = |hit: &PartialHit, target: (&mut [f64; 3], &mut [f64; 3])| {
            *target.0 = hit.point().expect("requested").to_array();
            *target.1 = hit.normal().expect("requested").to_array();
        };
        let (points, normals) = py.detach(|| {
            let mut points = vec![[f64::NAN; 3]; self.len()];
            let mut normals = points.clone();
            let both = self
                .targets(&mut points)
                .into_iter()
                .zip(self.targets(&mut normals));
            self.for_each_block(both.collect(), |block, (points, normals)| {
                let targets = points.iter_mut().zip(normals);
                block.write(tracer, fields, targets, &write);
            });
            (points, normals)
        });
        (
            array(py, points.into_flattened()),
            array(py, normals.into_flattened()),
        )
    }

    /// A column by its name; the rows of `point` and the like one after the other.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        const NAN: f64 = f64::NAN;
        let nothing = HitFields::empty();
        Ok(match name {
            "t" => {
                let t = self.found_values(py, f64::INFINITY, |first| first.t, PartialHit::t);
                array(py, t)
            }
            "uv" => {
                let uv = |hit: &PartialHit| <[f64; 2]>::from(hit.uv().expect("requested"));
                let uvs = self.values(py, HitFields::UV, [NAN; 2], uv);
                array(py, uvs.into_flattened())
            }
            "error" => {
                let error = |hit: &PartialHit| hit.error().expect("requested");
                array(py, self.values(py, HitFields::ERROR, NAN, error))
            }
            "solid" => {
                let first = |first: &FirstHit| kind_code(first.solid());
                array(
                    py,
                    self.found_values(py, -1, first, |hit| kind_code(hit.solid())),
                )
            }
            "primitive" => {
                let scene = self.tracing.tracer.scene();
                let first = |first: &FirstHit| i64::from(first.primitive(scene));
                let whole = |hit: &PartialHit| i64::from(hit.primitive());
                array(py, self.found_values(py, -1, first, whole))
            }
            "part" => {
                let part = |hit: &PartialHit| position(PARTS.into_iter(), &hit.part());
                array(py, self.values(py, nothing, -1, part))
            }
            "entering" => {
                let entering = |hit: &PartialHit| hit.crossing() == Crossing::Enter;
                array(py, self.values(py, nothing, false, entering))
            }
            "prototype" => {
                let first = |first: &FirstHit| i64::from(first.prototype().0);
                let whole = |hit: &PartialHit| i64::from(hit.prototype().0);
                array(py, self.found_values(py, -1, first, whole))
            }
            "material" => array(
                py,
                self.values(py, nothing, -1_i64, |hit| i64::from(hit.material().0)),
            ),
            "instance" => {
                let whole = |hit: &PartialHit| hit.instance().expect("requested").to_vec();
                let first = |first: &FirstHit| first.instance().to_vec();
                ragged(py, &self.found_values(py, Vec::new(), first, whole))?.into_any()
            }
            _ => return Err(value_error(format!("hits have no column \"{name}\""))),
        })
    }

    /// The answers at some positions, which may repeat.
    fn take(&self, py: Python<'_>, positions: PyReadonlyArray1<'_, i64>) -> PyResult<Self> {
        let positions = positions.as_slice()?;
        let ends: Vec<usize> = self
            .blocks
            .iter()
            .scan(0, |end, block| {
                *end += block.len();
                Some(*end)
            })
            .collect();
        let answer = |&position: &i64| {
            let position = position as usize;
            let block = ends.partition_point(|&end| end <= position);
            let before = if block == 0 { 0 } else { ends[block - 1] };
            self.blocks[block].answer(position - before)
        };
        let is_whole = matches!(self.blocks.first(), Some(Block::Whole(_)));
        let blocks = py.detach(|| {
            let blocks = positions.par_chunks(BLOCK).map(|positions| {
                let answers = positions.iter().map(answer);
                if is_whole {
                    let whole = answers.filter_map(|answer| match answer {
                        Answer::Whole(hit) => Some(hit.clone()),
                        Answer::Miss | Answer::First(..) => None,
                    });
                    return Block::Whole(whole.collect());
                }
                let (mut slots, mut rays, mut hits) = (Vec::new(), Vec::new(), Vec::new());
                for answer in answers {
                    let Answer::First(ray, hit) = answer else {
                        slots.push(MISS);
                        continue;
                    };
                    slots.push(hits.len() as u32);
                    rays.push(*ray);
                    hits.push(hit.clone());
                }
                Block::First { slots, rays, hits }
            });
            blocks.collect()
        });
        Ok(Self::new(Arc::clone(&self.tracing), blocks))
    }

    /// The origins of rays that leave the surfaces in these directions; NaN for misses.
    fn spawn<'py>(
        &self,
        py: Python<'py>,
        directions: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let directions = Vectors::of(&directions)?;
        let tracing = &self.tracing;
        let origins: Vec<[f64; 3]> = py.detach(|| {
            let mut next = 0;
            let firsts: Vec<usize> = self
                .blocks
                .iter()
                .map(|block| {
                    let first = next;
                    next += block.len();
                    first
                })
                .collect();
            let blocks = self.blocks.par_iter().zip(firsts).map(|(block, first)| {
                let origin = |position: usize| {
                    let direction = directions.row(first + position);
                    let ray = match block.answer(position) {
                        Answer::Miss => None,
                        Answer::First(ray, first) => tracing
                            .tracer
                            .hit_with(ray, first, HitFields::SPAWN)
                            .spawn(direction),
                        Answer::Whole(hit) => hit.spawn(direction),
                    };
                    ray.map_or([f64::NAN; 3], |ray| ray.origin.to_array())
                };
                (0..block.len()).map(origin).collect::<Vec<_>>()
            });
            tracing
                .workers
                .install(|| blocks.collect::<Vec<_>>())
                .concat()
        });
        Ok(array(py, origins.into_flattened()))
    }
}

/// Lists of numbers as one array of values, and the offsets at which each begins, with the
/// end.
pub fn ragged<'py>(py: Python<'py>, lists: &[Vec<u32>]) -> PyResult<Bound<'py, PyTuple>> {
    let values: Vec<i64> = lists.iter().flatten().map(|&value| value.into()).collect();
    let mut end = 0_i64;
    let ends = lists.iter().map(|list| {
        end += list.len() as i64;
        end
    });
    let offsets: Vec<i64> = std::iter::once(0).chain(ends).collect();
    PyTuple::new(py, [array(py, values), array(py, offsets)])
}
