//! Outlines of groups, before the groups are created: their members, their reach, and which of
//! their placements are instances of Embree's.
//!
//! A group's frame depends on the reach of everything that it places, and its boxes grow for
//! its instances in other prototypes. So outlines are created from children to parents, and
//! grow from parents to children, before groups are created from them.

use std::sync::Arc;

use rayon::prelude::*;

use super::instances::{Image, MOST_INSTANCES, needed_growth};
use super::members::{Boxes, List, Members};
use super::numbers::Numbers;
use super::opened::{MOST_OUTER, OpenedFrames, inner_placements};
use super::parts::Parts;
use super::placement_margin::PlacementMargin;
use crate::math::Bounds;
use crate::scene::{Placement, PrototypeIndex, Scene};
use crate::tracer::frame::Frame;

/// The outline of a group.
pub(crate) struct Outline {
    pub members: Members,
    /// The box of the members.
    pub bounds: Bounds,
    pub(super) placement_margin: PlacementMargin,
    /// Contains every point that a query may report as a hit.
    pub reach: Bounds,
    /// Boxes whose union contains the members.
    pub(super) parts: Parts,
    pub frame: Frame,
    /// The placements that are instances of Embree's, in ascending order.
    pub instances: Vec<u32>,
    /// The placements of prototypes that are opened, in ascending order.
    pub opened: Vec<u32>,
    /// The frames of all opened prototypes of the scene.
    pub opened_frames: OpenedFrames,
}

/// The outlines of the groups of each prototype; none for an empty prototype.
pub(crate) struct Outlines {
    of: Vec<Vec<Outline>>,
    /// The boxes of the groups.
    boxes: Vec<Vec<Bounds>>,
}

impl Outlines {
    /// The outlines of prototypes in an order with children before parents.
    pub fn new(scene: &Arc<Scene>, order: &[PrototypeIndex]) -> Self {
        let mut outlines = Self {
            of: Vec::new(),
            boxes: vec![Vec::new(); scene.prototypes.len()],
        };
        outlines.of.resize_with(scene.prototypes.len(), Vec::new);
        for &index in order {
            let of_one = outlines.of_prototype(scene, index);
            let boxes = of_one.iter().map(|outline| outline.bounds);
            outlines.boxes[index.0 as usize] = boxes.collect();
            outlines.of[index.0 as usize] = of_one;
        }
        let mut opened = Vec::new();
        for &index in order {
            outlines.choose_instances(scene, index);
            opened.extend(outlines.choose_opened(scene, index));
        }
        let frames = OpenedFrames::new(opened);
        for outline in outlines.of.iter_mut().flatten() {
            outline.opened_frames = frames.clone();
        }
        outlines
    }

    /// Removes and returns the outlines of a prototype.
    pub fn take(&mut self, index: PrototypeIndex) -> Vec<Outline> {
        std::mem::take(&mut self.of[index.0 as usize])
    }

    fn of_prototype(&self, scene: &Scene, index: PrototypeIndex) -> Vec<Outline> {
        let prototype = &scene.prototypes[index.0 as usize];
        let boxes_of = |of: PrototypeIndex| &self.boxes[of.0 as usize][..];
        let boxes = Boxes::new(prototype, &boxes_of);
        let groups = boxes.groups().into_iter();
        groups
            .map(|(members, bounds)| {
                let placements = &prototype.placements;
                let mut outline = self.of_group(placements, members, bounds);
                if index != PrototypeIndex::ROOT {
                    outline.parts = self.parts(&boxes, placements, &outline);
                }
                outline
            })
            .collect()
    }

    /// The placements of a group that may be instances of Embree's: those of prototypes without
    /// placements, since Embree has one level of instances. Such a prototype has one group, so
    /// that a placement is one instance with the same number.
    fn innermost(&self, scene: &Scene, placements: &[Placement], outline: &Outline) -> Vec<u32> {
        if placements.len() > MOST_INSTANCES {
            return Vec::new();
        }
        let lists = outline.members.placements();
        let first = lists.filter(|&(group, _)| group == 0);
        let numbers = first.flat_map(|(_, numbers)| numbers.iter());
        numbers
            .filter(|&number| self.is_innermost(scene, placements[number as usize].of))
            .collect()
    }

    /// Whether a prototype has one group, without placements.
    fn is_innermost(&self, scene: &Scene, index: PrototypeIndex) -> bool {
        let index = index.0 as usize;
        self.of[index].len() == 1 && scene.prototypes[index].placements.is_empty()
    }

    /// The growth of the child's boxes if a placement is an instance.
    fn needed_growth(&self, placement: &Placement, parent: &Outline) -> Option<f64> {
        let child = self.of[placement.of.0 as usize].first()?;
        let image = Image::new(&parent.placement_margin, placement);
        needed_growth(&parent.frame, &image, &child.frame)
    }

    /// The growth of the boxes of everything that an opened prototype places.
    fn opened_growths(
        &self,
        scene: &Scene,
        outer: &Placement,
        parent: &Outline,
    ) -> Option<Vec<(PrototypeIndex, f64)>> {
        let [opened] = &self.of[outer.of.0 as usize][..] else {
            return None;
        };
        let inner = inner_placements(scene, outer.of, |index| self.is_innermost(scene, index))?;
        let growths = inner.iter().map(|inner| {
            let child = self.of[inner.of.0 as usize].first()?;
            let image = Image::new(&parent.placement_margin, outer)
                .through(&opened.placement_margin, inner);
            let share = needed_growth(&parent.frame, &image, &child.frame)?;
            Some((inner.of, share))
        });
        growths.collect()
    }

    fn of_group(&self, placements: &[Placement], members: Members, bounds: Bounds) -> Outline {
        let lists: Vec<_> = members.placements().collect();
        let placed = || self.placed(placements, &lists);
        let placement_margin =
            PlacementMargin::new(&bounds, placed().map(|(placement, _)| placement));
        let reach = placed()
            .map(|(placement, child)| placement_margin.placement_reach(placement, &child.reach))
            .reduce(|| bounds, |one, other| one.union(&other));
        Outline {
            frame: Frame::new(&reach),
            members,
            bounds,
            placement_margin,
            reach,
            parts: Parts::default(),
            instances: Vec::new(),
            opened: Vec::new(),
            opened_frames: OpenedFrames::default(),
        }
    }

    /// The placements of a group, each with the group that it places.
    fn placed<'a>(
        &'a self,
        placements: &'a [Placement],
        lists: &'a [(usize, &'a Numbers)],
    ) -> impl ParallelIterator<Item = (&'a Placement, &'a Outline)> {
        lists.par_iter().flat_map(move |&(group, numbers)| {
            numbers.par_iter().filter_map(move |number| {
                let placement = &placements[number as usize];
                let child = self.of[placement.of.0 as usize].get(group)?;
                Some((placement, child))
            })
        })
    }

    /// The parts of a group.
    fn parts(&self, boxes: &Boxes, placements: &[Placement], outline: &Outline) -> Parts {
        let solids: Vec<_> = outline.members.solids().collect();
        let solids = solids.par_iter().flat_map(|&(list, numbers)| {
            numbers
                .par_iter()
                .map(move |number| boxes.entry(List::Solids(list), number))
        });
        let lists: Vec<_> = outline.members.placements().collect();
        let placed = self.placed(placements, &lists).map(|(placement, child)| {
            let (placement_margin, count) = (&outline.placement_margin, placements.len());
            placement_margin.tight_reach(placement, &child.reach, &child.parts, count)
        });
        Parts::new(&outline.bounds, solids.chain(placed))
    }

    /// Chooses the placements of a prototype that are instances of Embree's, and grows the
    /// boxes of what they place.
    fn choose_instances(&mut self, scene: &Scene, index: PrototypeIndex) {
        let placements = &scene.prototypes[index.0 as usize].placements;
        let mut outlines = self.take(index);
        for outline in &mut outlines {
            let innermost = self.innermost(scene, placements, outline);
            let numbers = innermost.par_iter().with_min_len(1 << 8);
            let chosen: Vec<(u32, f64)> = numbers
                .filter_map(|&number| {
                    let growth = self.needed_growth(&placements[number as usize], outline);
                    growth.map(|share| (number, share))
                })
                .collect();
            for (number, share) in chosen {
                outline.instances.push(number);
                let child = placements[number as usize].of;
                self.of[child.0 as usize][0].frame.grow_to(share);
            }
        }
        self.of[index.0 as usize] = outlines;
    }

    /// Chooses the placements of a prototype that are opened, and grows the boxes of what is
    /// placed in these. Returns the frames of the opened prototypes.
    fn choose_opened(
        &mut self,
        scene: &Scene,
        index: PrototypeIndex,
    ) -> Vec<(PrototypeIndex, Frame)> {
        let placements = &scene.prototypes[index.0 as usize].placements;
        let mut frames = Vec::new();
        if placements.len() > MOST_OUTER {
            return frames;
        }
        let mut outlines = self.take(index);
        for outline in &mut outlines {
            let lists = outline.members.placements();
            let first = lists.filter(|&(group, _)| group == 0);
            let numbers: Vec<u32> = first.flat_map(|(_, numbers)| numbers.iter()).collect();
            for number in numbers {
                let placement = &placements[number as usize];
                let Some(growths) = self.opened_growths(scene, placement, outline) else {
                    continue;
                };
                outline.opened.push(number);
                for (child, share) in growths {
                    self.of[child.0 as usize][0].frame.grow_to(share);
                }
                let opened = &self.of[placement.of.0 as usize][0];
                frames.push((placement.of, opened.frame.clone()));
            }
        }
        self.of[index.0 as usize] = outlines;
        frames
    }
}

/// Numbers of placements by their form in Embree.
pub(super) struct Divided {
    /// The instances.
    pub instances: Numbers,
    /// The placements of opened prototypes, whose placements are instances.
    pub opened: Numbers,
    /// The primitives.
    pub called_back: Numbers,
}

impl Divided {
    /// All numbers.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        let instances = self.instances.iter().chain(self.opened.iter());
        instances.chain(self.called_back.iter())
    }
}

impl Outline {
    /// Divides some of the placements.
    pub(super) fn divide(&self, numbers: &Numbers) -> Divided {
        if self.instances.is_empty() && self.opened.is_empty() {
            let none = Numbers::These(Arc::new([]));
            return Divided {
                instances: none.clone(),
                opened: none,
                called_back: numbers.clone(),
            };
        }
        let is_instance = |number: u32| self.instances.binary_search(&number).is_ok();
        let is_opened = |number: u32| self.opened.binary_search(&number).is_ok();
        Divided {
            instances: numbers.filtered(is_instance),
            opened: numbers.filtered(is_opened),
            called_back: numbers.filtered(|number| !is_instance(number) && !is_opened(number)),
        }
    }
}
