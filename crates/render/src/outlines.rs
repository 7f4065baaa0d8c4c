//! Lines round solids, between them and along their edges.
//!
//! Rays of the camera on a regular grid, [`GRID`] by [`GRID`] a pixel, see points with normals.
//! Between two neighbors of the grid there is a line if
//!
//! - only one of them sees a surface (a silhouette),
//! - they see different solids or placements,
//! - the angle between their normals is greater than the crease angle `κ`, or
//! - the chord from one point to the other leaves both tangent planes at angles greater than
//!   `κ/2`: a jump of depth. On a surface that curves by `κ` or less between the two, the angles
//!   add up to that at most, so one is at most `κ/2`, however steeply the surface is seen.
//!
//! Normals count on the side of the viewer. The line is centered on the middle between the two
//! neighbors, which is within half a step of the grid of the place where the surface changes. A
//! place of the grid is covered by the line if it is within half of the width of such a middle;
//! the cover falls from 1 to 0 over a step of the grid. A line thinner than two steps is drawn
//! with two, and covers less.
//!
//! A tile decides alone: its grid extends beyond it by as much as a line may reach. Nothing is
//! random, and nothing depends on other tiles.

use std::collections::HashMap;

use cyltrace::math::Ray;
use cyltrace::scene::{Outlines, PrototypeIndex};
use cyltrace::tracer::{HitFields, PartialHit};
use glam::{DVec2, DVec3};

use super::RayCounts;
use super::channels::Channels;
use super::integrator::View;
use super::place::Place;

/// Places of the grid across a pixel, and down.
const GRID: usize = 4;

/// Rays that are traced together: rays and hits stay in a core's cache.
const RAYS_AT_ONCE: usize = 1024;

/// The least width that lines are drawn with, in steps of the grid.
const LEAST_STEPS: f64 = 2.0;

/// Draws the lines of a tile over its finished pixels, if the scene has outlines.
pub(super) fn draw(place: &mut Place, channels: &Channels, view: &View, rays: &mut RayCounts) {
    let Some(outlines) = view.tracer.scene().illustration.outlines else {
        return;
    };
    let steps = (outlines.width * GRID as f64).max(LEAST_STEPS);
    let thinness = (outlines.width * GRID as f64 / steps) as f32;
    let reach = 0.5 * steps + 0.5;
    let grid = Grid::around(place, (reach / GRID as f64).ceil() as usize);
    let seen = grid.seen(view, rays);
    let mut cover = Cover::new(place, grid.margin);
    let rule = Rule::new(&outlines);
    for row in 0..grid.height {
        for column in 0..grid.width {
            let at = row * grid.width + column;
            let (x, y) = (column as f64, row as f64);
            if column + 1 < grid.width && rule.separates(seen[at].as_ref(), seen[at + 1].as_ref()) {
                cover.line_at(DVec2::new(x + 1.0, y + 0.5), reach);
            }
            if row + 1 < grid.height
                && rule.separates(seen[at].as_ref(), seen[at + grid.width].as_ref())
            {
                cover.line_at(DVec2::new(x + 0.5, y + 1.0), reach);
            }
        }
    }
    let color = outlines.color.as_vec3().to_array();
    let each = place.words.len() / place.colors.len();
    for (pixel, below) in place.colors.iter_mut().enumerate() {
        let part = thinness * cover.of_pixel(pixel, place.tile.width as usize, reach);
        if part > 0.0 {
            *below = std::array::from_fn(|channel| {
                below[channel] * (1.0 - part) + color[channel] * part
            });
            if channels.has_opacity() {
                // Opacity is the first channel.
                let word = &mut place.words[pixel * each];
                *word = (f32::from_bits(*word) * (1.0 - part) + part).to_bits();
            }
        }
    }
}

/// The places of a tile and round it.
struct Grid {
    /// Pixels on each side of the tile.
    margin: usize,
    /// The pixel of the first place; it may be outside the picture.
    first: DVec2,
    /// Places across and down.
    width: usize,
    height: usize,
}

/// A surface that a ray of the camera sees.
struct Seen {
    point: DVec3,
    /// The unit normal on the side of the viewer.
    normal: DVec3,
    /// Prototype, primitive, and the number of the path of placements in the tile.
    solid: (PrototypeIndex, u32, u32),
}

impl Grid {
    fn around(place: &Place, margin: usize) -> Self {
        let tile = place.tile;
        let first = DVec2::new(f64::from(tile.x), f64::from(tile.y));
        Self {
            margin,
            first: first - margin as f64,
            width: (tile.width as usize + 2 * margin) * GRID,
            height: (tile.height as usize + 2 * margin) * GRID,
        }
    }

    /// What the places see, row by row.
    fn seen(&self, view: &View, rays: &mut RayCounts) -> Vec<Option<Seen>> {
        let step = 1.0 / GRID as f64;
        let ray = |number: usize| {
            let (column, row) = (number % self.width, number / self.width);
            let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
            view.camera.ray(self.first + place * step)
        };
        let count = self.width * self.height;
        rays.camera += count as u64;
        let (mut all, mut hits) = (Vec::new(), Vec::new());
        let (mut seen, mut paths) = (Vec::with_capacity(count), HashMap::new());
        for first in (0..count).step_by(RAYS_AT_ONCE) {
            all.clear();
            all.extend((first..count.min(first + RAYS_AT_ONCE)).map(ray));
            first_hits(view, &mut all, &mut hits);
            let surfaces = all.iter().zip(&hits);
            seen.extend(surfaces.map(|(ray, hit)| Some(Seen::new(ray, hit.as_ref()?, &mut paths))));
        }
        seen
    }
}

/// The surfaces that rays of the camera see. A light with a place hides those behind it.
fn first_hits(view: &View, rays: &mut [Ray], hits: &mut Vec<Option<PartialHit>>) {
    let fields = HitFields::POINT | HitFields::NORMAL | HitFields::PATH;
    view.first_hits(rays, fields, hits);
    for (ray, hit) in rays.iter().zip(hits) {
        hit.take_if(|hit| view.is_hidden(ray, hit));
    }
}

impl Seen {
    /// `paths` numbers the paths of placements.
    fn new(ray: &Ray, hit: &PartialHit, paths: &mut HashMap<Vec<u32>, u32>) -> Self {
        let requested = "points, normals and paths are requested";
        let normal = hit.normal().expect(requested);
        let path = hit.instance().expect(requested);
        let next = paths.len() as u32 + 1;
        let number = match path {
            [] => 0,
            // Few rays are the first of their path.
            path => paths.get(path).copied().unwrap_or_else(|| {
                paths.insert(path.to_owned(), next);
                next
            }),
        };
        Self {
            point: hit.point().expect(requested),
            normal: match normal.dot(ray.direction) > 0.0 {
                true => -normal,
                false => normal,
            },
            solid: (hit.prototype(), hit.primitive(), number),
        }
    }
}

/// Where lines are.
struct Rule {
    between_solids: bool,
    /// The cosine of the crease angle, and the sine of half of it.
    crease_cosine: f64,
    jump_sine: f64,
}

impl Rule {
    fn new(outlines: &Outlines) -> Self {
        let crease = outlines.crease_degrees.to_radians();
        Self {
            between_solids: outlines.between_solids,
            crease_cosine: libm::cos(crease),
            jump_sine: libm::sin(0.5 * crease),
        }
    }

    /// Whether a line is between two neighbors.
    fn separates(&self, one: Option<&Seen>, other: Option<&Seen>) -> bool {
        let (Some(one), Some(other)) = (one, other) else {
            return one.is_some() != other.is_some();
        };
        if self.between_solids && one.solid != other.solid {
            return true;
        }
        if one.normal.dot(other.normal) < self.crease_cosine {
            return true;
        }
        let chord = other.point - one.point;
        let limit = self.jump_sine * chord.length();
        let normals = [one.normal, other.normal];
        normals.iter().all(|normal| normal.dot(chord).abs() > limit)
    }
}

/// How near the places of a tile are to lines.
struct Cover {
    margin: f64,
    /// Places across and down the tile.
    width: usize,
    height: usize,
    /// The squares of the distances to the nearest line, in steps of the grid.
    squares: Vec<f64>,
}

impl Cover {
    fn new(place: &Place, margin: usize) -> Self {
        let [width, height] =
            [place.tile.width, place.tile.height].map(|side| side as usize * GRID);
        Self {
            margin: (margin * GRID) as f64,
            width,
            height,
            squares: vec![f64::INFINITY; width * height],
        }
    }

    /// A line passes at a position of the grid with its margin; it is of use up to `reach`.
    fn line_at(&mut self, position: DVec2, reach: f64) {
        let position = position - self.margin;
        let range = |middle: f64, count: usize| {
            let first = (middle - reach - 0.5).ceil().max(0.0) as usize;
            let end = (middle + reach + 0.5).floor().max(0.0) as usize;
            first..end.min(count)
        };
        for row in range(position.y, self.height) {
            for column in range(position.x, self.width) {
                let place = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let square = &mut self.squares[row * self.width + column];
                *square = square.min(place.distance_squared(position));
            }
        }
    }

    /// The part of a pixel of a tile of some width that is covered.
    fn of_pixel(&self, pixel: usize, across: usize, reach: f64) -> f32 {
        let (column, row) = (pixel % across * GRID, pixel / across * GRID);
        let mut sum = 0.0;
        for line in row..row + GRID {
            for square in &self.squares[line * self.width + column..][..GRID] {
                sum += (reach - square.sqrt()).clamp(0.0, 1.0);
            }
        }
        (sum / (GRID * GRID) as f64) as f32
    }
}
