//! The channels of a picture beside its colors.
//!
//! Geometric channels are of one ray a pixel, through the middle of the pixel, whatever its
//! samples are: what it hits first, with the values that `trace` has for the same ray. So they
//! have no noise, and ids and normals are never averaged. Other channels are statistics of the
//! pixel's samples.
//!
//! The names of channels are those of pbrt-v4's `gbuffer` film where it has them.

use cyltrace::tracer::{HitFields, PartialHit};
use cyltrace_output::{Channel, Numbers};
use glam::DVec3;

use crate::colors::Colors;

/// Channels that are requested together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ChannelGroup {
    /// `Z`: `t` of the hit. For cameras whose rays have directions of length 1 along the view,
    /// this is the distance from the eye along the view. Infinite where nothing is hit.
    Depth,
    /// `P.X`, `P.Y`, `P.Z`: the point that is hit; 0 where nothing is hit.
    Position,
    /// `N.X`, `N.Y`, `N.Z`: the outward unit normal there; 0 where nothing is hit.
    Normal,
    /// `Albedo.R`, `Albedo.G`, `Albedo.B`: the color of the surface; 0 where nothing is hit.
    Albedo,
    /// `u`, `v`: the coordinates on the surface; 0 where nothing is hit.
    Uv,
    /// `Id.Primitive`, `Id.Prototype`, `Id.Material`: numbers from 0; `Id.Instance`: the number
    /// of the outermost placement; `Id.Path`: a hash of all placements that contain the solid
    /// (FNV-1a of 32 bits). All are 2^32 - 1 where nothing is hit, and `Id.Instance` also where
    /// the solid is not in an instance.
    Ids,
    /// `Variance.R`, `Variance.G`, `Variance.B`: the variance of the pixel's samples, estimated
    /// from them; 0 for a single one. Samples are more even than random ones, so the error of
    /// the pixel is at most that of as many random ones, the root of variance over samples.
    Variance,
    /// `Samples`: the number of the pixel's samples.
    Samples,
}

const fn float(name: &'static str) -> Channel {
    Channel {
        name,
        numbers: Numbers::F32,
    }
}

const fn whole(name: &'static str) -> Channel {
    Channel {
        name,
        numbers: Numbers::U32,
    }
}

/// The id where there is none.
pub const NO_ID: u32 = u32::MAX;

impl ChannelGroup {
    /// All groups, in the order of a pixel's words.
    pub const ALL: [Self; 8] = [
        Self::Depth,
        Self::Position,
        Self::Normal,
        Self::Albedo,
        Self::Uv,
        Self::Ids,
        Self::Variance,
        Self::Samples,
    ];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Albedo => "albedo",
            Self::Uv => "uv",
            Self::Ids => "ids",
            Self::Variance => "variance",
            Self::Samples => "samples",
        }
    }

    /// Its channels.
    #[must_use]
    pub fn channels(self) -> &'static [Channel] {
        match self {
            Self::Depth => const { &[float("Z")] },
            Self::Position => const { &[float("P.X"), float("P.Y"), float("P.Z")] },
            Self::Normal => const { &[float("N.X"), float("N.Y"), float("N.Z")] },
            Self::Albedo => const { &[float("Albedo.R"), float("Albedo.G"), float("Albedo.B")] },
            Self::Uv => const { &[float("u"), float("v")] },
            Self::Ids => {
                const {
                    &[
                        whole("Id.Primitive"),
                        whole("Id.Prototype"),
                        whole("Id.Material"),
                        whole("Id.Instance"),
                        whole("Id.Path"),
                    ]
                }
            }
            Self::Variance => {
                const {
                    &[
                        float("Variance.R"),
                        float("Variance.G"),
                        float("Variance.B"),
                    ]
                }
            }
            Self::Samples => const { &[whole("Samples")] },
        }
    }
}

/// A set of channels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Channels {
    /// Sorted, each once.
    groups: Vec<ChannelGroup>,
    has_opacity: bool,
}

impl Channels {
    /// The channels of some groups, in any order, and opacity if it is requested: the part of a
    /// pixel's samples that hit.
    #[must_use]
    pub fn new(groups: impl IntoIterator<Item = ChannelGroup>, has_opacity: bool) -> Self {
        let mut groups: Vec<_> = groups.into_iter().collect();
        groups.sort_unstable();
        groups.dedup();
        Self {
            groups,
            has_opacity,
        }
    }

    /// The groups in their order.
    #[must_use]
    pub fn groups(&self) -> &[ChannelGroup] {
        &self.groups
    }

    /// Whether pixels have opacity.
    #[must_use]
    pub fn has_opacity(&self) -> bool {
        self.has_opacity
    }

    /// The channels in the order of a pixel's words.
    #[must_use]
    pub fn list(&self) -> Vec<Channel> {
        let opacity = self.has_opacity.then_some(Channel::OPACITY);
        let groups = self.groups.iter();
        let groups = groups.flat_map(|group| group.channels().iter().copied());
        opacity.into_iter().chain(groups).collect()
    }

    pub(crate) fn has_variance(&self) -> bool {
        self.groups.contains(&ChannelGroup::Variance)
    }

    /// The fields of the middle ray's hit that the channels need; `None` if they need no ray.
    pub(crate) fn fields(&self, colors: &Colors) -> Option<HitFields> {
        let fields = self.groups.iter().filter_map(|group| match group {
            ChannelGroup::Depth => Some(HitFields::empty()),
            ChannelGroup::Position => Some(HitFields::POINT),
            ChannelGroup::Normal => Some(HitFields::NORMAL),
            ChannelGroup::Albedo => Some(colors.fields()),
            ChannelGroup::Uv => Some(HitFields::UV),
            ChannelGroup::Ids => Some(HitFields::PATH),
            ChannelGroup::Variance | ChannelGroup::Samples => None,
        });
        fields.reduce(HitFields::union)
    }

    /// Appends the words of a pixel.
    pub(crate) fn push(&self, pixel: &PixelValues, colors: &Colors, words: &mut Vec<u32>) {
        if self.has_opacity {
            words.push(pixel.opacity.to_bits());
        }
        let hit = pixel.hit;
        let requested = "every channel requests its fields";
        for group in &self.groups {
            match group {
                ChannelGroup::Depth => {
                    words.push((hit.map_or(f64::INFINITY, PartialHit::t) as f32).to_bits());
                }
                ChannelGroup::Position => {
                    push(words, hit.map(|hit| hit.point().expect(requested)));
                }
                ChannelGroup::Normal => {
                    push(words, hit.map(|hit| hit.normal().expect(requested)));
                }
                ChannelGroup::Albedo => push(words, hit.map(|hit| colors.at(hit))),
                ChannelGroup::Uv => {
                    let (u, v) = hit.map_or((0.0, 0.0), |hit| hit.uv().expect(requested));
                    words.extend([u, v].map(|value| (value as f32).to_bits()));
                }
                ChannelGroup::Ids => words.extend(hit.map_or([NO_ID; 5], |hit| {
                    let path = hit.instance().expect(requested);
                    [
                        hit.primitive(),
                        hit.prototype().0,
                        u32::from(hit.material().0),
                        path.first().copied().unwrap_or(NO_ID),
                        hash(path),
                    ]
                })),
                ChannelGroup::Variance => push(words, Some(pixel.variance)),
                ChannelGroup::Samples => words.push(pixel.samples),
            }
        }
    }
}

/// What the channels of a pixel are made of.
pub(crate) struct PixelValues<'a> {
    /// The first hit of the ray through the pixel's middle.
    pub hit: Option<&'a PartialHit>,
    /// The part of the samples that hit.
    pub opacity: f32,
    /// The variance of the samples.
    pub variance: DVec3,
    /// Their number.
    pub samples: u32,
}

/// Appends three numbers, 0 if there are none.
fn push(words: &mut Vec<u32>, numbers: Option<DVec3>) {
    let numbers = numbers.unwrap_or_default().as_vec3().to_array();
    words.extend(numbers.map(f32::to_bits));
}

/// FNV-1a of the path's numbers, each four bytes, the lowest first.
fn hash(path: &[u32]) -> u32 {
    let bytes = path.iter().flat_map(|number| number.to_le_bytes());
    bytes.fold(0x811c_9dc5, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_do_not_depend_on_the_order_of_the_request() {
        let forward = Channels::new(ChannelGroup::ALL, true);
        let backward = ChannelGroup::ALL.into_iter().rev();
        assert_eq!(
            Channels::new(backward.chain(ChannelGroup::ALL), true),
            forward
        );
        let mut names: Vec<_> = forward.list().iter().map(|channel| channel.name).collect();
        assert_eq!(names.len(), 22);
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), 22, "names differ");
    }

    /// Values of the authors' list of test vectors for FNV-1a: no byte, and the byte "a" = 97.
    #[test]
    fn hash_is_fnv_1a() {
        assert_eq!(hash(&[]), 0x811c_9dc5);
        let first = (0x811c_9dc5_u32 ^ 97).wrapping_mul(0x0100_0193);
        assert_eq!(first, 0xe40c_292c);
        // Three zero bytes follow.
        let zeros = (0..3).fold(first, |hash, _| hash.wrapping_mul(0x0100_0193));
        assert_eq!(hash(&[97]), zeros);
    }
}
