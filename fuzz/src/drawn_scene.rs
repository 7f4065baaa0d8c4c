//! A scene of prototypes with solids of all kinds, and rays and points to try on it,
//! drawn from a fuzzer's bytes.

use std::sync::Arc;

use arbitrary::{Result, Unstructured};
use cyltrace::embree::MaxIsa;
use cyltrace::math::Ray;
use cyltrace::scene::{MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, SolidRecord};
use cyltrace::solid::{AnySolid, Composition};
use cyltrace_oracle::ExactAffine;
use glam::{DAffine3, DVec3};

use super::drawing::{Drawing, Style};

/// The most placed solids that are compared one by one.
const MOST_PLACED: usize = 64;

/// A scene, and what is tried on it.
#[derive(Debug)]
pub struct DrawnScene {
    /// The scene; none of its rules for files applies.
    pub scene: Arc<Scene>,
    /// The instruction set to trace with.
    pub max_isa: Option<MaxIsa>,
    /// Whether hits are decided exactly.
    pub is_exact: bool,
    /// Rays in bundles of those that may be traced together.
    pub rays: Vec<Ray>,
    /// Points that may be in solids.
    pub points: Vec<DVec3>,
}

/// A solid somewhere in the scene.
#[derive(Clone, Debug)]
pub struct PlacedSolid {
    /// The placements from the root, by their numbers.
    pub path: Vec<u32>,
    /// The same as maps, outermost first.
    pub levels: Vec<DAffine3>,
    /// All of them together, exactly.
    pub world_from_object: ExactAffine,
    /// The number in its prototype.
    pub primitive: u32,
    /// The solid.
    pub solid: AnySolid,
}

impl DrawnScene {
    /// Draws until the bytes run out; then everything is at its least.
    pub fn new(bytes: &mut Unstructured) -> Result<Self> {
        let mut drawing = Drawing::new(bytes)?;
        let count = 1 + drawing.below(5)?;
        let mut prototypes = Vec::new();
        for index in 0..count {
            let later = (index + 1) as u32..count as u32;
            prototypes.push(prototype(&mut drawing, later)?);
        }
        let max_isa = match drawing.one_in(4)? {
            true => MaxIsa::available().first().copied(),
            false => None,
        };
        let scene = Arc::new(Scene::new(prototypes));
        for placed in placed_solids(&scene) {
            let map = placed.world_from_object.rounded();
            drawing.remember(map.transform_point3(placed.solid.center()));
        }
        let mut rays = Vec::new();
        for _ in 0..=drawing.below(3)? {
            add_bundle(&mut drawing, &mut rays)?;
        }
        let points = (0..4).map(|_| drawing.old_point());
        let points = points.collect::<Result<_>>()?;
        // Last, and optional, so that committed inputs stay what they were.
        let is_exact = drawing.one_in(3).unwrap_or(false);
        Ok(Self {
            points,
            is_exact,
            scene,
            max_isa,
            rays,
        })
    }
}

fn prototype(drawing: &mut Drawing, later: std::ops::Range<u32>) -> Result<Prototype> {
    let mut prototype = Prototype::default();
    let mut number = 0..;
    let mut next = || number.next().expect("numbers do not end");
    let material = MaterialIndex(0);
    for solid in drawing.solids(8)? {
        let record = SolidRecord::new(solid, next(), material);
        prototype.solids.push(record).expect("f64 keeps it");
    }
    for _ in 0..drawing.below(2)? {
        if let Some(
            solid @ (Composition::Union(_)
            | Composition::Intersection(_)
            | Composition::Difference(_)),
        ) = drawing.composition(3)?
        {
            let record = SolidRecord::new(solid, next(), material);
            prototype.solids.compositions.push(record);
        }
    }
    if !later.is_empty() {
        let least = usize::from(prototype.solids.is_empty());
        for _ in 0..least.max(drawing.below(2)?) {
            let of = drawing.bytes.int_in_range(later.start..=later.end - 1)?;
            prototype.placements.push(Placement {
                of: PrototypeIndex(of),
                parent_from_child: drawing.placement()?,
            });
        }
    }
    Ok(prototype)
}

/// Adds a ray, and up to sixteen that have much in common with it.
fn add_bundle(drawing: &mut Drawing, rays: &mut Vec<Ray>) -> Result<()> {
    let first = ray(drawing)?;
    rays.push(first);
    for _ in 0..drawing.below(16)? {
        let mut next = first;
        let aside = drawing.heading()? * if drawing.one_in(2)? { 1.0 } else { 0.0625 };
        next.origin += aside;
        if drawing.style != Style::Whole && drawing.one_in(2)? {
            let length = next.direction.length();
            next.direction += drawing.heading()?.normalize_or_zero() * (0.0625 * length);
        }
        rays.push(next);
    }
    Ok(())
}

fn ray(drawing: &mut Drawing) -> Result<Ray> {
    let through = drawing.point()?;
    let mut direction = drawing.heading()?;
    // Whole steps back keep whole origins whole.
    let back = if drawing.one_in(4)? {
        0.0
    } else {
        (drawing.power(12)? * 16.0).max(1.0)
    };
    let origin = through - direction * back;
    let mut range = [0.0, f64::INFINITY];
    match drawing.below(5)? {
        0 => range[0] = f64::NEG_INFINITY,
        1 => range[1] = back,
        2 => range[0] = back,
        3 => range = [back, back],
        _ => {}
    }
    if drawing.one_in(4)? {
        let factor = drawing.power(40)?;
        direction *= factor;
        range = range.map(|t| t / factor);
    }
    Ok(Ray {
        origin,
        direction,
        t_min: range[0],
        t_max: range[1],
    })
}

/// The solids that are not composed of others wherever they are placed, up to
/// [`MOST_PLACED`].
pub fn placed_solids(scene: &Scene) -> Vec<PlacedSolid> {
    let mut placed = Vec::new();
    let mut steps = vec![(0, Vec::new(), Vec::new(), ExactAffine::identity())];
    while let Some((index, path, levels, map)) = steps.pop() {
        let prototype: &Prototype = &scene.prototypes[index];
        for (primitive, solid) in prototype.singles() {
            if placed.len() == MOST_PLACED {
                return placed;
            }
            placed.push(PlacedSolid {
                path: path.clone(),
                levels: levels.clone(),
                world_from_object: map.clone(),
                primitive,
                solid,
            });
        }
        for (number, placement) in (0..).zip(&prototype.placements) {
            let (mut path, mut levels) = (path.clone(), levels.clone());
            path.push(number);
            levels.push(placement.parent_from_child);
            let child = map.after(&ExactAffine::new(&placement.parent_from_child));
            steps.push((placement.of.0 as usize, path, levels, child));
        }
    }
    placed
}
