//! The losses of filters, for tests with random solids and rays.

use super::{Filtered, survivors};
use crate::for_each_solid;
use crate::math::{Bounds, LANES, Ray};
use crate::solid::AnySolid;
use crate::tracer::frame::{Frame, LocalRay};

/// The hits of rays with the solids of a block, solved in f64, compared with the block's
/// filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FilterLosses {
    /// Pairs of a ray and a solid that it hits.
    pub hits: u64,
    /// Hits that do not survive the filter; always 0 with the full margins.
    pub lost: u64,
    /// Pairs that survive without a hit.
    pub spare: u64,
}

impl FilterLosses {
    /// Tests rays with the filter of up to eight solids of one kind, in a prototype that fills
    /// the box `whole`. The filter has a share of the required margins.
    ///
    /// # Panics
    /// If there are more solids, or of several kinds.
    #[must_use]
    pub fn of(solids: &[AnySolid], whole: &Bounds, rays: &[Ray], share: f64) -> Self {
        assert!(solids.len() <= LANES, "a block has no more");
        macro_rules! of_kinds {
            ($({ $type:ident $($rest:tt)* })*) => {
                match solids {
                    [] => Self::default(),
                    $([AnySolid::$type(_), ..] => {
                        let alike = solids.iter().map(|one| match one {
                            AnySolid::$type(one) => *one,
                            other => panic!("{other:?} beside {:?}", solids[0]),
                        });
                        Self::of_kind(&alike.collect::<Vec<_>>(), whole, rays, share)
                    })*
                }
            };
        }
        for_each_solid!(of_kinds)
    }

    fn of_kind<S: Filtered>(solids: &[S], whole: &Bounds, rays: &[Ray], share: f64) -> Self {
        let frame = Frame::new(whole);
        let filter = S::filter(solids, &frame, share);
        let mut losses = Self::default();
        for ray in rays {
            let (t_min, t_max) = (ray.t_min, ray.t_max);
            let Some((level, ray32)) = frame.enter(&LocalRay::new(ray), t_min, t_max) else {
                continue;
            };
            let local = level.ray;
            let survivors = survivors(&filter, &ray32);
            for (lane, one) in solids.iter().enumerate() {
                let from_anchor = local.origin_from(one.anchor());
                let (direction, shift) = (local.direction, local.shift);
                let hit = one.first(from_anchor, direction, shift, t_min, t_max);
                let survives = survivors >> lane & 1 == 1;
                losses.hits += u64::from(hit.is_some());
                losses.lost += u64::from(hit.is_some() && !survives);
                losses.spare += u64::from(hit.is_none() && survives);
            }
        }
        losses
    }
}
