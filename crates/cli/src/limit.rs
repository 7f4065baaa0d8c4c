//! The memory that a scene may take, and the rejection of a scene that takes more.
//!
//! A scene is rejected by its counts, before any record is made: otherwise the system
//! would end the program without a message.

use std::fs;
use std::path::Path;

use anyhow::anyhow;
use clap::{Args, ValueEnum};
use cyltrace::embree::MaxIsa;
use cyltrace::scene::{ExpectedCounts, ExpectedSolids, PlacedCount, Placement};
use cyltrace::tracer::{Layout, MemoryEstimate};

use super::allocator::AllocationLimit;
use super::memory::{kibibytes_of, parse_size, readable};

/// The greatest number of lines about the contents that take the memory.
const MOST_SHOWN: usize = 6;

/// The memory that a scene may take, and the layout that it depends on.
#[derive(Args, Debug)]
pub struct MemoryArguments {
    /// Reject a scene that takes more memory than SIZE, such as `500MB` or `4GiB`
    /// [default: the memory that the system has available]
    #[arg(long, value_name = "SIZE", value_parser = parse_size)]
    pub max_memory: Option<u64>,
    /// Store one solid, or a block of up to eight, per Embree primitive
    #[arg(long, value_name = "NAME", value_enum, default_value_t = LayoutName::Auto)]
    pub layout: LayoutName,
}

/// A layout by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LayoutName {
    /// blocks for kinds with at least 2^20 solids in a prototype
    Auto,
    /// one solid per primitive
    Single,
    /// up to eight neighboring solids of a kind per primitive
    Block,
}

impl From<LayoutName> for Layout {
    fn from(name: LayoutName) -> Self {
        match name {
            LayoutName::Auto => Self::Auto,
            LayoutName::Single => Self::Single,
            LayoutName::Block => Self::Block,
        }
    }
}

/// The parts of a scene that are built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Its records.
    Records,
    /// Its records, and the trees that rays traverse.
    Build,
}

/// The limit of memory.
#[derive(Clone, Copy, Debug)]
pub struct MemoryLimit {
    /// None if the system does not report it.
    bytes: Option<u64>,
    is_stated: bool,
    /// The layout that the estimate assumes.
    layout: Layout,
    /// What a picture takes beside the scene.
    picture: PictureBytes,
}

/// The memory of a picture beside the scene, in bytes.
#[derive(Clone, Copy, Debug, Default)]
pub struct PictureBytes {
    /// The pixels, colors and channels.
    pub pixels: u64,
    /// Copies for removing the noise.
    pub denoising: u64,
    /// Samples of all tiles at once.
    pub samples: u64,
    /// The environment and how it is sampled.
    pub environment: u64,
}

impl PictureBytes {
    /// The bytes of each purpose.
    fn by_purpose(self) -> [(u64, &'static str); 4] {
        [
            (self.pixels, "the pixels of the picture"),
            (self.denoising, "copies of the picture, for --denoise"),
            (self.samples, "the samples of all tiles at once, for --time"),
            (self.environment, "the environment"),
        ]
    }
}

impl MemoryLimit {
    /// This limit, for a command that also renders a picture.
    pub fn with_picture(self, picture: PictureBytes) -> Self {
        Self { picture, ..self }
    }

    /// The limit of `--max-memory`, or the memory that the system has available.
    pub fn of(arguments: &MemoryArguments) -> Self {
        match arguments.max_memory {
            Some(bytes) => Self {
                bytes: Some(bytes),
                is_stated: true,
                layout: arguments.layout.into(),
                picture: PictureBytes::default(),
            },
            None => Self {
                layout: arguments.layout.into(),
                ..Self::available()
            },
        }
    }

    /// The memory that is available without swapping and within `ulimit -v`, if the system
    /// reports it as Linux does.
    pub fn available() -> Self {
        let meminfo = fs::read_to_string("/proc/meminfo").ok();
        let free = meminfo.and_then(|text| kibibytes_of(&text, "MemAvailable:"));
        Self {
            bytes: [free, address_space_left()].into_iter().flatten().min(),
            is_stated: false,
            layout: Layout::default(),
            picture: PictureBytes::default(),
        }
    }

    /// Ends the program if reading the scene and its files allocates more.
    pub fn while_reading(self, path: &Path) -> AllocationLimit {
        let message = format!(
            "{}: reading the scene takes more memory than the limit: {}",
            path.display(),
            self.allowed(self.bytes.unwrap_or(u64::MAX))
        );
        AllocationLimit::new(self.bytes.unwrap_or(u64::MAX), message)
    }

    /// Rejects a scene that needs more, to read its files or for its records and trees;
    /// otherwise returns the remaining bytes, `None` without a limit.
    pub fn check(
        self,
        path: &Path,
        contents: &[ExpectedCounts],
        reading_bytes: u64,
        need: Need,
        max_isa: Option<MaxIsa>,
    ) -> anyhow::Result<Option<u64>> {
        let estimate = MemoryEstimate::of(contents, self.layout, max_isa);
        let needed = match need {
            Need::Records => estimate.records_bytes,
            // Prototypes are built when a ray reaches them, while the picture is in memory.
            Need::Build => {
                let parts = self.picture.by_purpose().into_iter();
                let parts = parts.map(|(bytes, _)| bytes);
                parts.fold(estimate.peak_bytes(), u64::saturating_add)
            }
        };
        let needed = needed.max(estimate.records_bytes.saturating_add(reading_bytes));
        let left = self.bytes.map(|allowed| allowed.checked_sub(needed));
        let (Some(allowed), Some(None)) = (self.bytes, left) else {
            return Ok(left.flatten());
        };
        Err(anyhow!(
            "{}: {} up to {} of memory, but {}\n{}",
            path.display(),
            match self.picture.pixels {
                0 => "the scene needs",
                _ => "the scene and its picture need",
            },
            readable(needed),
            self.allowed(allowed),
            takers(contents, &estimate, need, needed, self.picture)
        ))
    }

    /// The limit and its origin.
    fn allowed(self, bytes: u64) -> String {
        let bytes = readable(bytes);
        match self.is_stated {
            true => format!("--max-memory allows {bytes}"),
            false => {
                format!("the system has {bytes} available; --max-memory SIZE sets another limit")
            }
        }
    }
}

/// The address space that `ulimit -v` leaves; `None` if it is unlimited.
fn address_space_left() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = limit.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    Some(limit.saturating_sub(kibibytes_of(&status, "VmSize:")?))
}

/// The contents that take at least a hundredth of the memory, the largest first.
fn takers(
    contents: &[ExpectedCounts],
    estimate: &MemoryEstimate,
    need: Need,
    needed: u64,
    picture: PictureBytes,
) -> String {
    let quoted = |name: &str| match name {
        "" => "the scene itself".to_owned(),
        name => format!("\"{name}\""),
    };
    let mut lines: Vec<(u64, String)> = Vec::new();
    for prototype in contents {
        let name = quoted(&prototype.name);
        let ExpectedSolids { counts, bytes } = &prototype.solids;
        lines.push((*bytes, format!("{counts} in {name}")));
        for &PlacedCount { of, count } in &prototype.placed {
            let bytes = count.saturating_mul(size_of::<Placement>() as u64);
            let of = quoted(&contents[of.0 as usize].name);
            lines.push((bytes, format!("{count} placements of {of} in {name}")));
        }
    }
    if need == Need::Build {
        lines.push((estimate.copies_bytes, "blocks of solids".to_owned()));
        lines.push((estimate.embree_bytes, "Embree's trees of them".to_owned()));
        let building = "Embree, while it builds".to_owned();
        lines.push((estimate.building_bytes, building));
        let picture = picture.by_purpose().into_iter();
        lines.extend(picture.map(|(bytes, purpose)| (bytes, purpose.to_owned())));
    }
    lines.retain(|(bytes, _)| *bytes > needed / 100);
    lines.sort_by_key(|(bytes, _)| std::cmp::Reverse(*bytes));
    let shown = lines.iter().take(MOST_SHOWN);
    let shown = shown.map(|(bytes, what)| format!("  {:>8}  {what}", readable(*bytes)));
    shown.collect::<Vec<_>>().join("\n")
}
