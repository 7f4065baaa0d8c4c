//! What a scene may take of memory, and the refusal of one that takes more.
//!
//! A scene is refused by its counts, before any record is made: the system
//! would end the program otherwise, when it is too late for a message.

use std::fs;
use std::path::Path;

use anyhow::anyhow;
use clap::{Args, ValueEnum};
use cyltrace::embree::MaxIsa;
use cyltrace::scene::{ExpectedCounts, ExpectedSolids, PlacedCount, Placement};
use cyltrace::tracer::{Layout, MemoryEstimate};

use super::allocator::AllocationLimit;
use super::memory::{kibibytes_of, parse_size, readable};

/// Most lines about what takes the memory.
const MOST_SHOWN: usize = 6;

/// What a scene may take.
#[derive(Args, Debug)]
pub struct MemoryArguments {
    /// Refuse a scene that takes more memory than SIZE, such as 500MB or 4GiB
    /// [default: what the system has available]
    #[arg(long, value_name = "SIZE", value_parser = parse_size)]
    pub max_memory: Option<u64>,
    /// What is a primitive of Embree's: a solid, or a block of eight that are near each
    /// other, which is faster and less in Embree
    #[arg(long, value_name = "NAME", value_enum, default_value_t = LayoutName::Auto)]
    pub layout: LayoutName,
}

/// A layout by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LayoutName {
    /// Blocks where they are faster.
    Auto,
    /// One solid a primitive.
    Single,
    /// Eight solids a primitive.
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

/// What is made of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Its records.
    Records,
    /// Its records, and what is traced.
    Build,
}

/// How much memory may be taken.
#[derive(Clone, Copy, Debug)]
pub struct MemoryLimit {
    /// None where the system does not say.
    bytes: Option<u64>,
    is_stated: bool,
    /// What will be a primitive of Embree's.
    layout: Layout,
}

impl MemoryLimit {
    /// The one that `--max-memory` states, else what the system has available.
    pub fn of(arguments: &MemoryArguments) -> Self {
        match arguments.max_memory {
            Some(bytes) => Self {
                bytes: Some(bytes),
                is_stated: true,
                layout: arguments.layout.into(),
            },
            None => Self {
                layout: arguments.layout.into(),
                ..Self::available()
            },
        }
    }

    /// What the system can give without swapping and within `ulimit -v`, where it
    /// reports that as Linux does.
    pub fn available() -> Self {
        let meminfo = fs::read_to_string("/proc/meminfo").ok();
        let free = meminfo.and_then(|text| kibibytes_of(&text, "MemAvailable:"));
        Self {
            bytes: [free, address_space_left()].into_iter().flatten().min(),
            is_stated: false,
            layout: Layout::default(),
        }
    }

    /// Ends the program when reading the scene, and what it names, allocates more.
    pub fn while_reading(self, path: &Path) -> AllocationLimit {
        let refusal = format!(
            "{}: reading the scene takes more memory than it may: {}",
            path.display(),
            self.allowed(self.bytes.unwrap_or(u64::MAX))
        );
        AllocationLimit::new(self.bytes.unwrap_or(u64::MAX), refusal)
    }

    /// Refuses a scene that needs more, to read its files or for its records and trees;
    /// otherwise returns how much is left, `None` without a limit.
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
            Need::Build => estimate.peak_bytes(),
        };
        let needed = needed.max(estimate.records_bytes.saturating_add(reading_bytes));
        let left = self.bytes.map(|allowed| allowed.checked_sub(needed));
        let (Some(allowed), Some(None)) = (self.bytes, left) else {
            return Ok(left.flatten());
        };
        Err(anyhow!(
            "{}: the scene needs up to {} of memory, {}\n{}",
            path.display(),
            readable(needed),
            self.allowed(allowed),
            takers(contents, &estimate, need, needed)
        ))
    }

    /// Where the limit comes from.
    fn allowed(self, bytes: u64) -> String {
        let bytes = readable(bytes);
        match self.is_stated {
            true => format!("--max-memory allows {bytes}"),
            false => format!("the system has {bytes} available; --max-memory SIZE allows more"),
        }
    }
}

/// What `ulimit -v` leaves of the address space; `None` where it is unlimited.
fn address_space_left() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = limit.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    Some(limit.saturating_sub(kibibytes_of(&status, "VmSize:")?))
}

/// What takes at least a hundredth of the memory, the most first.
fn takers(
    contents: &[ExpectedCounts],
    estimate: &MemoryEstimate,
    need: Need,
    needed: u64,
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
    }
    lines.retain(|(bytes, _)| *bytes > needed / 100);
    lines.sort_by_key(|(bytes, _)| std::cmp::Reverse(*bytes));
    let shown = lines.iter().take(MOST_SHOWN);
    let shown = shown.map(|(bytes, what)| format!("  {:>8}  {what}", readable(*bytes)));
    shown.collect::<Vec<_>>().join("\n")
}
