//! What solids are the convex hulls of.

use glam::DVec3;

use cyltrace::solid::AnySolid;

/// What a solid is the hull of, as its numbers state it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// Balls about one or two points.
    Balls { ends: [(DVec3, f64); 2] },
    /// Disks about one or two points, across an axis.
    Disks { ends: [(DVec3, f64); 2], axis: Axis },
    /// What is within a half width of a point along each of three axes.
    Box {
        center: DVec3,
        axes: [DVec3; 3],
        half_widths: [f64; 3],
    },
}

/// An axis of disks.
#[derive(Clone, Copy, Debug)]
pub(super) enum Axis {
    /// From one end to the other.
    BetweenEnds,
    /// This vector; the ends are one point.
    Along(DVec3),
}

impl Form {
    pub fn new(solid: &AnySolid) -> Self {
        match solid {
            AnySolid::Cylinder(cylinder) => {
                let radius = cylinder.radius();
                Self::Disks {
                    ends: [(cylinder.p0(), radius), (cylinder.p1(), radius)],
                    axis: Axis::BetweenEnds,
                }
            }
            AnySolid::Cone(cone) => Self::Disks {
                ends: [(cone.p0(), cone.radius0()), (cone.p1(), cone.radius1())],
                axis: Axis::BetweenEnds,
            },
            AnySolid::RoundedCone(cone) => Self::Balls {
                ends: [(cone.p0(), cone.radius0()), (cone.p1(), cone.radius1())],
            },
            AnySolid::Sphere(sphere) => Self::Balls {
                ends: [(sphere.center(), sphere.radius()); 2],
            },
            AnySolid::Disk(disk) => Self::Disks {
                ends: [(disk.center(), disk.radius()); 2],
                axis: Axis::Along(disk.normal()),
            },
            AnySolid::Cuboid(cuboid) => {
                let frame = cuboid.orientation().world_from_object();
                Self::Box {
                    center: cuboid.center(),
                    axes: [frame.x_axis, frame.y_axis, frame.z_axis],
                    half_widths: cuboid.half_widths().to_array(),
                }
            }
        }
    }

    /// The two ends, which have the solid's middle between them.
    pub fn end_points(&self) -> [DVec3; 2] {
        match self {
            Self::Balls { ends } | Self::Disks { ends, .. } => ends.map(|(point, _)| point),
            Self::Box { center, .. } => [*center; 2],
        }
    }

    /// The face of a box whose outward normal is nearest to a vector: its axis and side.
    pub fn face(axes: &[DVec3; 3], hint: DVec3) -> (usize, f64) {
        let along = axes.map(|axis| axis.dot(hint));
        let axis = (0..3)
            .max_by(|&i, &j| along[i].abs().total_cmp(&along[j].abs()))
            .unwrap_or(0);
        (axis, along[axis].signum())
    }
}
