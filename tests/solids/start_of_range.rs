//! Rays within a surface, whose range begins before, at, between and behind the points where
//! their line comes to the solid and leaves it. All numbers are whole, so that every rounding is
//! exact and the oracle's answer is the only one.

use cyltrace::math::{Orientation, Ray};
use cyltrace::solid::{AnySolid, Caps, Cone, ConvexSolid, Cuboid, Cylinder, Disk, RayOrigin};
use cyltrace::with_solid;
use cyltrace_oracle::hits_of_any;
use glam::DVec3;

/// A line within a surface.
struct Within {
    solid: AnySolid,
    origin: DVec3,
    direction: DVec3,
}

fn lines(caps: Caps) -> Vec<Within> {
    let top = DVec3::Z * 8.0;
    let cylinder = Cylinder::new(DVec3::ZERO, top, 5.0, caps).expect("a cylinder");
    let cone = Cone::new(DVec3::ZERO, top, 9.0, 3.0, caps).expect("a cone");
    let half_widths = DVec3::new(3.0, 4.0, 5.0);
    let cuboid = Cuboid::new(DVec3::ZERO, half_widths, Orientation::IDENTITY).expect("a cuboid");
    let disk = Disk::new(DVec3::ZERO, DVec3::Z, 5.0).expect("a disk");
    let along_axis = (DVec3::new(3.0, 4.0, -4.0), DVec3::Z);
    let in_plane = (DVec3::new(3.0, -9.0, 0.0), DVec3::Y);
    let in_face = (DVec3::new(3.0, -9.0, 1.0), DVec3::Y);
    let on_edge = (DVec3::new(3.0, -9.0, 5.0), DVec3::Y);
    let within = |solid: AnySolid, (origin, direction)| Within {
        solid,
        origin,
        direction,
    };
    let mut lines = vec![
        within(cylinder.into(), along_axis),
        within(cylinder.into(), in_plane),
        within(cylinder.into(), (in_plane.0 + top, in_plane.1)),
        // From (9, 0, 0) to (3, 0, 8).
        within(
            cone.into(),
            (DVec3::new(12.0, 0.0, -4.0), DVec3::new(-3.0, 0.0, 4.0)),
        ),
        within(cone.into(), (DVec3::new(0.0, -11.0, 0.0), DVec3::Y)),
        within(cuboid.into(), in_face),
        within(cuboid.into(), on_edge),
        within(disk.into(), in_plane),
    ];
    let backwards = lines.iter().map(|line| Within {
        solid: line.solid,
        origin: line.origin + line.direction * 32.0,
        direction: -line.direction,
    });
    let backwards: Vec<Within> = backwards.collect();
    lines.extend(backwards);
    lines
}

#[test]
fn rays_within_a_surface_hit_where_the_oracle_says_wherever_they_start() {
    let mut starts_at_ends = 0;
    for caps in [Caps::Both, Caps::None, Caps::P0, Caps::P1] {
        for Within {
            solid,
            origin,
            direction,
        } in lines(caps)
        {
            // Only a line within a disk that is not there hits the rim alone, and only there.
            let whole = hits_of_any(&solid, &Ray::new(origin, direction));
            let ends: Vec<f64> = whole.iter().map(|hit| hit.t_f64()).collect();
            assert_eq!(ends.len(), 2, "{solid:?} {origin} {direction}");
            let [enter, leave] = [ends[0], ends[1]];
            for t_min in [
                enter - 1.0,
                enter,
                0.5 * (enter + leave),
                leave,
                leave + 1.0,
            ] {
                let ray = Ray {
                    t_min,
                    ..Ray::new(origin, direction)
                };
                let truth = hits_of_any(&solid, &ray);
                let first = truth
                    .first()
                    .map(|hit| (hit.t_f64(), hit.part, hit.crossing));
                with_solid!(&solid, solid => {
                    let from_anchor = origin - solid.anchor();
                    let rounded = solid.first(from_anchor, direction, 0.0, t_min, f64::INFINITY);
                    let at = RayOrigin::at(origin);
                    let exact = solid.exact_first(&at, direction, 0.0, [t_min, f64::INFINITY]);
                    for (how, hit) in [("rounded", rounded), ("exact", exact)] {
                        let found = hit.map(|hit| (hit.t, hit.part, hit.crossing));
                        assert_eq!(found, first, "{how}: {solid:?} {ray:?}");
                    }
                    let chord = solid.chord(from_anchor, direction).expect("a chord");
                    let all = chord.intersections(solid.caps(), 0.0, t_min, f64::INFINITY);
                    let all: Vec<_> = all.map(|hit| (hit.t, hit.part, hit.crossing)).collect();
                    let true_all = truth.iter().map(|hit| (hit.t_f64(), hit.part, hit.crossing));
                    assert_eq!(all, true_all.collect::<Vec<_>>(), "{solid:?} {ray:?}");
                });
                starts_at_ends += u32::from(t_min == leave);
            }
        }
    }
    assert_eq!(starts_at_ends, 4 * 16);
}
