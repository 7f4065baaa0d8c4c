//! Orientations and poses against exact arithmetic: what stays orthonormal, and what
//! many turns amount to.

use cyltrace::math::{Orientation, Pose, Random, UNIT_ROUNDOFF};
use cyltrace_oracle::{Exact, ExactAffine, ExactVector, exact, to_f64};
use glam::{DAffine3, DMat3, DVec3};

/// One of the four kinds of turns.
#[derive(Clone, Copy)]
struct Turn {
    kind: u64,
    axis: DVec3,
    degrees: f64,
}

impl Turn {
    fn draw(random: &mut Random) -> Self {
        Self {
            kind: random.below(4),
            axis: random.direction() * random.log_uniform(1e-3, 1e3),
            degrees: random.uniform(-400.0, 400.0),
        }
    }

    fn after(self, before: Orientation) -> Orientation {
        match self.kind {
            0 => before.rotated_x(self.degrees),
            1 => before.rotated_y(self.degrees),
            2 => before.rotated_z(self.degrees),
            _ => before.rotated(self.axis, self.degrees),
        }
    }
}

/// The greatest entry of `Mᵀ M - I`, of exact numbers.
fn off_orthonormal(matrix: &DMat3) -> f64 {
    let columns = [0, 1, 2].map(|axis| ExactVector::new(matrix.col(axis)));
    let mut greatest: f64 = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            let unit = exact(if i == j { 1.0 } else { 0.0 });
            greatest = greatest.max(to_f64(&(columns[i].dot(&columns[j]) - unit)).abs());
        }
    }
    greatest
}

/// The greatest size of an entry of the difference.
fn apart(one: &DMat3, other: &DMat3) -> f64 {
    let entries = (*one - *other).to_cols_array();
    entries
        .into_iter()
        .fold(0.0, |most, entry| most.max(entry.abs()))
}

/// Proven: 2 u after any number of turns, and `2^-98` for what a step leaves.
#[test]
fn frame_stays_orthonormal_to_rounding_over_a_million_turns() {
    let mut random = Random::new(61, 0);
    let mut frame = Orientation::IDENTITY;
    let mut worst: f64 = 0.0;
    for turn in 0..1_000_000 {
        frame = Turn::draw(&mut random).after(frame);
        if turn % 1_000 == 999 {
            worst = worst.max(off_orthonormal(&frame.world_from_object()));
        }
    }
    assert!(worst <= 2.0 * UNIT_ROUNDOFF * (1.0 + 1e-12), "{worst:e}");
    assert!((frame.world_from_object().determinant() - 1.0).abs() < 1e-15);
}

/// A turn is off by its own rounding, and each of its products by some units of
/// 2^-53: over a million, forth and back, at most that many times 8 units.
#[test]
fn half_a_million_turns_and_back_are_none() {
    const TURNS: usize = 500_000;
    let mut random = Random::new(62, 0);
    let turns: Vec<Turn> = (0..TURNS).map(|_| Turn::draw(&mut random)).collect();
    let there = turns
        .iter()
        .fold(Orientation::IDENTITY, |frame, turn| turn.after(frame));
    let back = turns.iter().rev().fold(there, |frame, turn| {
        Turn {
            degrees: -turn.degrees,
            ..*turn
        }
        .after(frame)
    });
    let off = apart(&back.world_from_object(), &DMat3::IDENTITY);
    println!("a million turns drift by {off:e}");
    assert!(off < 2.0 * TURNS as f64 * 8.0 * UNIT_ROUNDOFF, "{off:e}");
    assert!(apart(&there.world_from_object(), &DMat3::IDENTITY) > 0.1);
}

#[test]
fn turns_compose_as_their_exact_matrices_do() {
    for (sequences, length) in [(200, 12), (2, 1_000)] {
        for sequence in 0..sequences {
            let mut random = Random::new(63, sequence);
            let mut frame = Orientation::IDENTITY;
            let mut truth = ExactAffine::identity();
            for _ in 0..length {
                let turn = Turn::draw(&mut random);
                frame = turn.after(frame);
                let alone = turn.after(Orientation::IDENTITY).world_from_object();
                truth = ExactAffine::new(&DAffine3::from_mat3(alone)).after(&truth);
            }
            let off = apart(&frame.world_from_object(), &truth.rounded().matrix3);
            let bound = f64::from(length) * 8.0 * UNIT_ROUNDOFF;
            assert!(off <= bound, "sequence {sequence} of {length}: {off:e}");
        }
    }
}

#[test]
fn known_angles_have_their_sines() {
    let half_root = 3.0_f64.sqrt() / 2.0;
    let turned = Orientation::IDENTITY.rotated_z(30.0).to_world(DVec3::X);
    assert!((turned - DVec3::new(half_root, 0.5, 0.0)).length() <= 2.0 * UNIT_ROUNDOFF);
    let turned = Orientation::IDENTITY.rotated_x(-60.0).to_world(DVec3::Y);
    assert!((turned - DVec3::new(0.0, 0.5, -half_root)).length() <= 2.0 * UNIT_ROUNDOFF);
    // The diagonal's third of a turn takes x to y.
    let turned = Orientation::IDENTITY.rotated(DVec3::ONE, 120.0);
    assert!((turned.to_world(DVec3::X) - DVec3::Y).length() <= 8.0 * UNIT_ROUNDOFF);
}

#[test]
fn pose_takes_points_and_directions_both_ways() {
    let mut random = Random::new(64, 0);
    for case in 0..2_000 {
        let mut vector = || random.direction() * random.log_uniform(1e-6, 1e6);
        let (center, by, point) = (vector(), vector(), vector());
        let turn = Turn::draw(&mut random);
        let pose = Pose {
            orientation: turn.after(Orientation::IDENTITY),
            ..Pose::at(center)
        }
        .rotated_x(turn.degrees)
        .translated(by);
        assert_eq!(
            pose.center,
            center + by,
            "case {case}: turns leave the center"
        );

        let map = ExactAffine::new(&pose.world_from_object());
        let exact_point = ExactVector::new(point);
        let off = |found: DVec3, truth: &ExactVector| (&ExactVector::new(found) - truth).length();
        let u = UNIT_ROUNDOFF;
        let world = off(pose.point_to_world(point), &map.point(&exact_point));
        assert!(world <= u * (8.0 * point.length() + 2.0 * pose.center.length()));
        let direction = off(
            pose.direction_to_world(point),
            &map.matrix().times(&exact_point),
        );
        assert!(direction <= 6.0 * u * point.length());

        let from_center = &exact_point - map.translation();
        let object = off(
            pose.point_to_object(point),
            &map.matrix().times_from_left(&from_center),
        );
        assert!(object <= 8.0 * u * from_center.length());
        let direction = off(
            pose.direction_to_object(point),
            &map.matrix().times_from_left(&exact_point),
        );
        assert!(direction <= 6.0 * u * point.length());
    }
}

#[test]
fn quarter_turns_compose_to_whole_matrices() {
    let mut random = Random::new(65, 0);
    let mut frame = Orientation::IDENTITY;
    for _ in 0..10_000 {
        let quarters = random.below(9) as f64 - 4.0;
        frame = Turn {
            kind: random.below(3),
            axis: DVec3::X,
            degrees: 90.0 * quarters,
        }
        .after(frame);
        assert!(frame.is_axis_aligned());
    }
    let determinant: Exact = {
        let (_, determinant) =
            ExactAffine::new(&DAffine3::from_mat3(frame.world_from_object())).adjugate();
        determinant
    };
    assert_eq!(determinant, exact(1.0));
}
