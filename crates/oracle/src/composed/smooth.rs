//! Witnesses beside sheets that have a tangent plane at the point.
//!
//! Sheets with the same tangent plane T are a group. Directions `v` in T are cut into
//! sectors by the tangent planes of other groups, by the rulings in T of cones whose apex
//! is the point, and where two sheets of the group change their order. On the curve
//! `p + s v + s² λ n`, with `n` normal to T and `κ = g·n`, a sheet of the group has the
//! sign of `2 κ λ + v·M v`. So along `v` the sheets of the group are at the heights
//!
//! ```text
//! λ = -v·M v / (2 κ)
//! ```
//!
//! in exact order, those of equal height coincide to second order, and there is a cell
//! above and below each: one with `v` in the middle of each sector, and `λ` in the middle
//! between heights. The vectors `v` are in T exactly; where in its sector and between
//! heights a witness is does not matter, so angles and middles are rounded.
//!
//! Sectors between tangent planes can be narrower than f64 can say. The sum of the
//! directions of two planes is between them, so at stated points the sums of all pairs that are nearly
//! parallel are witnesses too, in exact numbers.
//!
//! Cells and faces with a cusp, along a line that several planes have in common, are in
//! `edge.rs`.

use std::cmp::Ordering;
use std::f64::consts::TAU;

use crate::number::{Exact, exact, to_f64};
use cyltrace::math::power_of_two;

use super::edge;
use super::ring::{Number, Vector};
use super::survey::{Curve, Survey};

/// Sectors of less are taken for none. Where numbers are whole and below 2^10, lines
/// in a plane that differ do so by more than 2^-30.
const LEAST_ANGLE: f64 = 1e-10;

/// The sectors between tangent planes that have a witness in exact numbers: all up to
/// this width, which is above [`LEAST_ANGLE`] by far more than angles are rounded.
const THIN: f64 = 2.0 * LEAST_ANGLE;

/// A tangent plane and the sheets that have it.
struct Group {
    members: Vec<usize>,
    n: Vector,
    axes: [Vector; 2],
}

/// A sheet of a group: `κ` and `M` in the axes of the plane.
struct Member {
    sheet: usize,
    kappa: Number,
    form: [Number; 3],
}

pub(super) fn survey(survey: &mut Survey) {
    let groups = groups(survey);
    for group in &groups {
        let members: Vec<Member> = group
            .members
            .iter()
            .map(|&sheet| Member {
                sheet,
                kappa: survey.active[sheet].gradient.dot(&group.n),
                form: group.form_of(survey, sheet),
            })
            .collect();
        let lines = group.lines(survey, &members);
        for (angle, width) in sectors(lines) {
            group.climb(survey, &members, &within(angle, width));
        }
        for direction in group.thin_sectors(survey) {
            group.climb(survey, &members, &direction);
        }
    }
    for (position, one) in groups.iter().enumerate() {
        for other in &groups[..position] {
            let v = one.n.cross(&other.n);
            let back = v.times(&exact(-1.0));
            for v in [v, back] {
                edge::survey_along(survey, &v, [&one.n, &other.n]);
            }
        }
    }
}

fn groups(survey: &Survey) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (number, active) in survey.active.iter().enumerate() {
        if active.gradient.is_zero() {
            continue;
        }
        let same = |group: &&mut Group| group.n.cross(&active.gradient).is_zero();
        match groups.iter_mut().find(same) {
            Some(group) => group.members.push(number),
            None => groups.push(Group::new(number, &active.gradient)),
        }
    }
    groups
}

impl Group {
    fn new(first: usize, gradient: &Vector) -> Self {
        let size = gradient.approximation().abs();
        let exponent = (size.max_element().to_bits() >> 52) as i32 - 1023;
        let n = gradient.times(&exact(power_of_two(-exponent)));
        let one_zero = |axis: usize| {
            let unit = [0, 1, 2].map(|i| exact(if i == axis { 1.0 } else { 0.0 }));
            Vector(unit.map(Number::rational))
        };
        let across = n.cross(&one_zero(size.min_position()));
        Self {
            members: vec![first],
            axes: [across.clone(), n.cross(&across)],
            n,
        }
    }

    /// A sheet's matrix in the axes of the plane.
    fn form_of(&self, survey: &Survey, sheet: usize) -> [Number; 3] {
        let form = &survey.active[sheet].sheet.form;
        let [one, other] = &self.axes;
        [
            form.of(one, one),
            form.of(one, other),
            form.of(other, other),
        ]
    }

    /// The lines through the point that cut the plane into sectors, by their angles.
    fn lines(&self, survey: &Survey, members: &[Member]) -> Vec<f64> {
        let mut lines = Vec::new();
        for (number, active) in survey.active.iter().enumerate() {
            if active.gradient.is_zero() {
                lines.extend(zeros(&self.form_of(survey, number)));
            } else if !self.members.contains(&number) {
                let [x, y] = [0, 1].map(|i| active.gradient.dot(&self.axes[i]).approximation());
                lines.push(libm::atan2(-x, y));
            }
        }
        for (position, one) in members.iter().enumerate() {
            for other in &members[..position] {
                let difference = [0, 1, 2].map(|i| {
                    let first = one.form[i].by(&other.kappa);
                    first.minus(&other.form[i].by(&one.kappa))
                });
                lines.extend(zeros(&difference));
            }
        }
        lines
    }

    /// A direction in each sector between tangent planes that is thin, in the axes of the
    /// plane. None at points that are not rational: those of lines.
    fn thin_sectors(&self, survey: &Survey) -> Vec<[Exact; 2]> {
        let mut directions: Vec<([Exact; 2], f64)> = Vec::new();
        for (number, active) in survey.active.iter().enumerate() {
            if active.gradient.is_zero() || self.members.contains(&number) {
                continue;
            }
            let [x, y] = [0, 1].map(|i| active.gradient.dot(&self.axes[i]));
            let (Some(x), Some(y)) = (x.as_rational(), y.as_rational()) else {
                return Vec::new();
            };
            for [x, y] in [[y.clone(), -x], [-y, x.clone()]] {
                let angle = libm::atan2(to_f64(&y), to_f64(&x));
                directions.push(([x, y], angle));
            }
        }
        let mut sums = Vec::new();
        for (position, (one, angle)) in directions.iter().enumerate() {
            for (other, other_angle) in &directions[..position] {
                let apart = (angle - other_angle).abs();
                let is_parallel = &one[0] * &other[1] == &one[1] * &other[0];
                if apart.min(TAU - apart) < THIN && !is_parallel {
                    sums.push([0, 1].map(|i| &one[i] + &other[i]));
                }
            }
        }
        sums
    }

    /// Notes all neighbours above and below each other in a direction, in the axes of the
    /// plane.
    fn climb(&self, survey: &mut Survey, members: &[Member], [x, y]: &[Exact; 2]) {
        let v = self.axes[0].times(x).plus(&self.axes[1].times(y));
        let squares = [x * x, exact(2.0) * x * y, y * y];
        let mut heights: Vec<Height> = members
            .iter()
            .map(|member| Height::new(member, &squares))
            .collect();
        heights.sort_by(|one, other| one.height.total_cmp(&other.height));
        let mut levels: Vec<Vec<&Height>> = Vec::new();
        for height in &heights {
            match levels.last_mut() {
                Some(level) if level[0].is_equal(height) => level.push(height),
                _ => levels.push(vec![height]),
            }
        }
        let greatest = heights
            .iter()
            .fold(1.0, |sum: f64, one| sum.max(one.height.abs()));
        let between = (0..=levels.len()).map(|level| {
            let below = level.checked_sub(1).map(|below| levels[below][0].height);
            let above = levels.get(level).map(|above| above[0].height);
            let height = match (below, above) {
                (Some(below), Some(above)) => below + 0.5 * (above - below),
                (Some(below), None) => below + greatest,
                (None, Some(above)) => above - greatest,
                (None, None) => 0.0,
            };
            survey.cell(&Curve {
                v: v.clone(),
                a: Some(self.n.times(&exact(height))),
            })
        });
        let cells: Vec<_> = between.collect();
        for (level, pair) in levels.iter().zip(cells.windows(2)) {
            let across: Vec<usize> = level.iter().map(|one| one.sheet).collect();
            if let [Some(below), Some(above)] = pair {
                survey.note_cells([below, above], &across);
            }
        }
    }
}

/// A sheet's height along a direction, `-bend / (2 κ)`.
struct Height<'a> {
    sheet: usize,
    bend: Number,
    kappa: &'a Number,
    height: f64,
}

impl<'a> Height<'a> {
    fn new(member: &'a Member, squares: &[Exact; 3]) -> Self {
        let [a, b, c] = [0, 1, 2].map(|i| member.form[i].times(&squares[i]));
        let bend = a.plus(&b).plus(&c);
        Self {
            sheet: member.sheet,
            height: -bend.approximation() / (2.0 * member.kappa.approximation()),
            bend,
            kappa: &member.kappa,
        }
    }

    fn is_equal(&self, other: &Self) -> bool {
        let difference = self.bend.by(other.kappa);
        difference.minus(&other.bend.by(self.kappa)).is_zero()
    }
}

/// The angles of the lines on which `a x² + 2 b x y + c y²` is zero.
fn zeros(form: &[Number; 3]) -> Vec<f64> {
    if form.iter().all(Number::is_zero) {
        return Vec::new();
    }
    let product = form[0].by(&form[2]);
    let discriminant = form[1].by(&form[1]).minus(&product);
    if discriminant.sign() == Ordering::Less {
        return Vec::new();
    }
    let [a, b, c] = [0, 1, 2].map(|i| form[i].approximation());
    let root = discriminant.approximation().sqrt();
    let far = -b - if b < 0.0 { -root } else { root };
    // As in the textbook: (far, a) and (c, far); one may be zero.
    [(far, a), (c, far)]
        .into_iter()
        .filter(|&(x, y)| x != 0.0 || y != 0.0)
        .map(|(x, y)| libm::atan2(y, x))
        .collect()
}

/// The direction of an angle, rounded by less than the width of its sector.
fn within(angle: f64, width: f64) -> [Exact; 2] {
    let bits = if width > 1e-3 { 20 } else { 52 };
    [libm::cos(angle), libm::sin(angle)]
        .map(|x| exact((x * power_of_two(bits)).round() * power_of_two(-bits)))
}

/// The middles and widths of the sectors between lines.
fn sectors(lines: Vec<f64>) -> Vec<(f64, f64)> {
    let both = lines
        .into_iter()
        .flat_map(|line| [line, line + 0.5 * TAU])
        .map(|angle| angle - TAU * (angle / TAU).floor());
    let mut angles: Vec<f64> = both.collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|one, other| (*one - *other).abs() < LEAST_ANGLE);
    let Some(&first) = angles.first() else {
        return vec![(0.4, TAU)];
    };
    angles.push(first + TAU);
    let pairs = angles.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    pairs
        .filter(|(_, width)| *width > LEAST_ANGLE)
        .map(|(start, width)| (start + 0.5 * width, width))
        .collect()
}
