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
        hits: Vec<(Ray, FirstHit)>,
    },
    /// Hits with all of their fields.
    Whole(Vec<PartialHit>),
}

/// The slot of a ray without a hit.
pub const MISS: u32 = u32::MAX;

impl Block {
    /// The block of these answers.
    pub fn first(answers: impl Iterator<Item = Option<(Ray, FirstHit)>>) -> Self {
        let (mut slots, mut hits) = (Vec::new(), Vec::new());
        for answer in answers {
            slots.push(if answer.is_some() {
                hits.len() as u32
            } else {
                MISS
            });
            hits.extend(answer);
        }
        Self::First { slots, hits }
    }

    fn len(&self) -> usize {
        match self {
            Self::First { slots, .. } => slots.len(),
            Self::Whole(hits) => hits.len(),
        }
    }

    /// Computes a value of every answer.
    fn values<T: Clone>(
        &self,
        tracer: &Tracer,
        fields: HitFields,
        missing: &T,
        get: &impl Fn(&PartialHit) -> T,
    ) -> Vec<T> {
        match self {
            Self::First { slots, hits } => {
                let value = |&slot: &u32| match hits.get(slot as usize) {
                    Some((ray, first)) => get(&tracer.hit_with(ray, first, fields)),
                    None => missing.clone(),
                };
                slots.iter().map(value).collect()
            }
            Self::Whole(hits) => hits.iter().map(get).collect(),
        }
    }

    /// As [`Block::values`], of what the query itself finds: nothing is computed again.
    fn found_values<T: Clone>(
        &self,
        missing: &T,
        of_first: &impl Fn(&FirstHit) -> T,
        of_whole: &impl Fn(&PartialHit) -> T,
    ) -> Vec<T> {
        match self {
            Self::First { slots, hits } => {
                let value = |&slot: &u32| {
                    let hit = hits.get(slot as usize);
                    hit.map_or_else(|| missing.clone(), |(_, first)| of_first(first))
                };
                slots.iter().map(value).collect()
            }
            Self::Whole(hits) => hits.iter().map(of_whole).collect(),
        }
    }

    /// The answer at a position.
    fn answer(&self, position: usize) -> Answer<'_> {
        match self {
            Self::First { slots, hits } => match hits.get(slots[position] as usize) {
                Some(hit) => Answer::First(hit),
                None => Answer::Miss,
            },
            Self::Whole(hits) => Answer::Whole(&hits[position]),
        }
    }
}

enum Answer<'a> {
    Miss,
    First(&'a (Ray, FirstHit)),
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
        let tracing = &self.tracing;
        py.detach(|| {
            let blocks = self.blocks.par_iter();
            let values = blocks.map(|block| block.values(&tracing.tracer, fields, &missing, &get));
            tracing
                .workers
                .install(|| values.collect::<Vec<_>>())
                .concat()
        })
    }

    /// See [`Block::found_values`].
    fn found_values<T: Clone + Send + Sync>(
        &self,
        py: Python<'_>,
        missing: T,
        of_first: impl Fn(&FirstHit) -> T + Sync,
        of_whole: impl Fn(&PartialHit) -> T + Sync,
    ) -> Vec<T> {
        py.detach(|| {
            let blocks = self.blocks.par_iter();
            let values = blocks.map(|block| block.found_values(&missing, &of_first, &of_whole));
            let values: Vec<_> = self.tracing.workers.install(|| values.collect());
            values.concat()
        })
    }
}

/// An array of numbers, or of rows of numbers one after the other.
fn array<T: numpy::Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyAny> {
    PyArray1::from_vec(py, values).into_any()
}

#[pymethods]
impl Found {
    fn __len__(&self) -> usize {
        self.blocks.iter().map(Block::len).sum()
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
            "point" => {
                let point = |hit: &PartialHit| hit.point().expect("requested").to_array();
                let points = self.values(py, HitFields::POINT, [NAN; 3], point);
                array(py, points.into_flattened())
            }
            "normal" => {
                let normal = |hit: &PartialHit| hit.normal().expect("requested").to_array();
                let normals = self.values(py, HitFields::NORMAL, [NAN; 3], normal);
                array(py, normals.into_flattened())
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
                        Answer::Miss | Answer::First(_) => None,
                    });
                    return Block::Whole(whole.collect());
                }
                Block::first(answers.map(|answer| match answer {
                    Answer::First(hit) => Some(hit.clone()),
                    Answer::Miss | Answer::Whole(_) => None,
                }))
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
                        Answer::First((ray, first)) => tracing
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
