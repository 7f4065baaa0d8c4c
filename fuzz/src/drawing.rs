//! Numbers, points and solids that are drawn from a fuzzer's bytes.
//!
//! A scene is drawn in one of three styles. *Whole* numbers are quarters up to 8: sums
//! and products of them are exact, so that faces coincide and rays touch to the last
//! bit. *Fine* numbers are any f64 of a few units. *Mixed* ones are either, scaled by
//! powers of two. Points and lengths that were drawn before come again, so that solids
//! share faces, axes and centers.

use arbitrary::{Result, Unstructured};
use cyltrace::math::{Orientation, power_of_two};
use cyltrace::solid::{
    AnySolid, Caps, Composition, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere,
};
use glam::{DAffine3, DMat3, DVec3};

/// What numbers are like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Quarters from -8 to 8.
    Whole,
    /// Any f64 from -4 to 4.
    Fine,
    /// Both, times powers of two.
    Mixed,
}

/// Draws from bytes, and remembers what it has drawn.
pub struct Drawing<'a, 'b> {
    /// The bytes.
    pub bytes: &'a mut Unstructured<'b>,
    /// What numbers are like.
    pub style: Style,
    points: Vec<DVec3>,
    lengths: Vec<f64>,
}

impl<'a, 'b> Drawing<'a, 'b> {
    /// With a style that is drawn first.
    pub fn new(bytes: &'a mut Unstructured<'b>) -> Result<Self> {
        let style = *bytes.choose(&[Style::Whole, Style::Fine, Style::Mixed])?;
        Ok(Self {
            bytes,
            style,
            points: vec![DVec3::ZERO],
            lengths: vec![1.0],
        })
    }

    /// A number from 0 to `most`.
    pub fn below(&mut self, most: usize) -> Result<usize> {
        self.bytes.int_in_range(0..=most)
    }

    /// Whether something is done that is done one time in `times`.
    pub fn one_in(&mut self, times: u8) -> Result<bool> {
        self.bytes.ratio(1, times)
    }

    /// A power of two, 2^`-most` to 2^`most`.
    pub fn power(&mut self, most: i32) -> Result<f64> {
        Ok(power_of_two(self.bytes.int_in_range(-most..=most)?))
    }

    fn whole(&mut self) -> Result<f64> {
        Ok(f64::from(self.bytes.int_in_range(-32..=32_i8)?) * 0.25)
    }

    /// From -4 to 4.
    fn fine(&mut self) -> Result<f64> {
        Ok(self.bytes.arbitrary::<i64>()? as f64 * power_of_two(-61))
    }

    /// A number of the style.
    pub fn number(&mut self) -> Result<f64> {
        match self.style {
            Style::Whole => self.whole(),
            Style::Fine => self.fine(),
            Style::Mixed => match self.below(3)? {
                0 => self.fine(),
                1 => Ok(self.fine()? * self.power(24)?),
                _ => self.whole(),
            },
        }
    }

    fn new_point(&mut self) -> Result<DVec3> {
        Ok(DVec3::new(self.number()?, self.number()?, self.number()?))
    }

    /// A point, a new one or an old one.
    pub fn point(&mut self) -> Result<DVec3> {
        if self.one_in(2)? {
            return self.old_point();
        }
        let point = self.new_point()?;
        self.points.push(point);
        Ok(point)
    }

    /// A point that was drawn before.
    pub fn old_point(&mut self) -> Result<DVec3> {
        Ok(*self.bytes.choose(&self.points)?)
    }

    /// Remembers a point, to be drawn again.
    pub fn remember(&mut self, point: DVec3) {
        self.points.push(point);
    }

    /// A positive length, a new one or an old one.
    fn length(&mut self) -> Result<f64> {
        if self.one_in(2)? {
            return Ok(*self.bytes.choose(&self.lengths)?);
        }
        let length = self.number()?.abs();
        let length = if length > 0.0 { length } else { 0.25 };
        self.lengths.push(length);
        Ok(length)
    }

    /// A vector that is not zero, every other time along an axis.
    pub fn heading(&mut self) -> Result<DVec3> {
        let along = DVec3::AXES[self.below(2)?];
        let heading = match self.below(3)? {
            0 => along,
            1 => -along,
            2 => self.old_point()? - self.old_point()?,
            _ => self.new_point()?,
        };
        Ok(if heading == DVec3::ZERO {
            along
        } else {
            heading
        })
    }

    fn orientation(&mut self) -> Result<Orientation> {
        if self.style == Style::Whole || self.one_in(2)? {
            return Ok(Orientation::IDENTITY);
        }
        let degrees = match self.below(2)? {
            0 => 45.0,
            1 => 90.0,
            _ => 100.0 * self.fine()?,
        };
        let axis = self.heading()?;
        Ok(Orientation::IDENTITY.rotated(axis.normalize_or(DVec3::Z), degrees))
    }

    /// A solid; `None` where the numbers are those of none.
    fn new_solid(&mut self, is_closed: bool) -> Result<Option<AnySolid>> {
        let caps = match is_closed {
            true => Caps::Both,
            false => *(self.bytes).choose(&[Caps::Both, Caps::None, Caps::P0, Caps::P1])?,
        };
        let kind = self.below(if is_closed { 4 } else { 5 })?;
        let p0 = self.point()?;
        if kind == 3 {
            return Ok(Sphere::new(p0, self.length()?).ok().map(Into::into));
        }
        if kind == 4 {
            let half_widths = DVec3::new(self.length()?, self.length()?, self.length()?);
            let cuboid = Cuboid::new(p0, half_widths, self.orientation()?);
            return Ok(cuboid.ok().map(Into::into));
        }
        let p1 = match self.below(1)? {
            0 => p0 + self.heading()?,
            _ => self.point()?,
        };
        self.remember(p1);
        let radius = self.length()?;
        let other = if self.one_in(4)? { 0.0 } else { self.length()? };
        Ok(match kind {
            0 => (Cylinder::new(p0, p1, radius, caps).ok()).map(Into::into),
            1 => (Cone::new(p0, p1, radius, other, caps).ok()).map(Into::into),
            2 => (RoundedCone::new(p0, p1, radius, other).ok()).map(Into::into),
            _ => Disk::new(p0, p1 - p0, radius).ok().map(Into::into),
        })
    }

    /// Solids, some of them the same or nearly the same as others.
    pub fn solids(&mut self, most: usize) -> Result<Vec<AnySolid>> {
        let mut solids: Vec<AnySolid> = Vec::new();
        for _ in 0..self.below(most)? {
            match self.below(5)? {
                0 if !solids.is_empty() => {
                    let twin = *self.bytes.choose(&solids)?;
                    solids.push(twin);
                }
                1 if !solids.is_empty() => {
                    let copied = *self.bytes.choose(&solids)?;
                    let (step, count) = (self.heading()?, self.below(24)?);
                    solids.extend((1..=count).filter_map(|n| moved(&copied, step * n as f64)));
                }
                2 => {
                    let (solid, factor) = (self.new_solid(false)?, self.power(40)?);
                    solids.extend(solid.and_then(|solid| scaled(&solid, factor)));
                }
                _ => solids.extend(self.new_solid(false)?),
            }
        }
        Ok(solids)
    }

    /// A composition of at most `levels` levels; `None` where numbers are of no solid.
    pub fn composition(&mut self, levels: usize) -> Result<Option<Composition>> {
        if levels == 0 || self.one_in(4)? {
            return Ok(self.new_solid(true)?.map(Composition::Solid));
        }
        let (operation, count) = (self.below(2)?, self.bytes.int_in_range(2..=3)?);
        let mut parts = Vec::new();
        for _ in 0..count {
            match self.composition(levels - 1)? {
                Some(part) => parts.push(part),
                None => return Ok(None),
            }
        }
        Ok(Some(match operation {
            0 => Composition::Union(parts),
            1 => Composition::Intersection(parts),
            _ => Composition::Difference(parts),
        }))
    }

    /// A placement that is not singular. Whole ones are exact.
    pub fn placement(&mut self) -> Result<DAffine3> {
        let mut axes = DVec3::AXES;
        axes.rotate_left(self.below(2)?);
        let mirrored = DVec3::new(self.sign()?, self.sign()?, self.sign()?);
        let matrix = DMat3::from_cols_array_2d(&axes.map(Into::into))
            * DMat3::from_diagonal(mirrored * self.power(8)?);
        let mut translation = self.point()?;
        let matrix = if self.style == Style::Whole {
            matrix
        } else {
            if self.one_in(4)? {
                translation *= self.power(24)?;
            }
            let orientation = self.orientation()?.world_from_object();
            let stretch = match self.one_in(2)? {
                true => DVec3::ONE,
                false => DVec3::new(self.power(6)?, self.power(6)?, self.power(6)?),
            };
            let mut shear = DMat3::IDENTITY;
            shear.y_axis.x = self.fine()?;
            matrix * orientation * DMat3::from_diagonal(stretch) * shear
        };
        Ok(DAffine3::from_mat3_translation(matrix, translation))
    }

    fn sign(&mut self) -> Result<f64> {
        Ok(if self.one_in(4)? { -1.0 } else { 1.0 })
    }
}

/// A solid moved by a vector.
fn moved(solid: &AnySolid, by: DVec3) -> Option<AnySolid> {
    changed(solid, |point| point + by, 1.0)
}

/// A solid seen from the origin as if it were larger by a factor.
fn scaled(solid: &AnySolid, factor: f64) -> Option<AnySolid> {
    changed(solid, |point| point * factor, factor)
}

fn changed(solid: &AnySolid, at: impl Fn(DVec3) -> DVec3, factor: f64) -> Option<AnySolid> {
    Some(match solid {
        AnySolid::Cylinder(one) => {
            let radius = one.radius() * factor;
            let changed = Cylinder::new(at(one.p0()), at(one.p1()), radius, one.caps());
            changed.ok()?.into()
        }
        AnySolid::Cone(one) => {
            let [first, second] = [one.radius0(), one.radius1()].map(|radius| radius * factor);
            let changed = Cone::new(at(one.p0()), at(one.p1()), first, second, one.caps());
            changed.ok()?.into()
        }
        AnySolid::RoundedCone(one) => {
            let [first, second] = [one.radius0(), one.radius1()].map(|radius| radius * factor);
            let changed = RoundedCone::new(at(one.p0()), at(one.p1()), first, second);
            changed.ok()?.into()
        }
        AnySolid::Sphere(one) => {
            let changed = Sphere::new(at(one.center()), one.radius() * factor);
            changed.ok()?.into()
        }
        AnySolid::Cuboid(one) => {
            let half_widths = one.half_widths() * factor;
            let changed = Cuboid::new(at(one.center()), half_widths, one.orientation());
            changed.ok()?.into()
        }
        AnySolid::Disk(one) => {
            let changed = Disk::new(at(one.center()), one.normal(), one.radius() * factor);
            changed.ok()?.into()
        }
    })
}
