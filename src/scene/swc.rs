//! Neurons in SWC: one sample a line (`id type x y z radius parent`), and a
//! solid for every sample that has a parent, from the parent's point to the
//! sample's own: a cylinder with the sample's radius or, where joints are asked for,
//! a cone or a rounded cone with the radii of both.
//!
//! That holds for the soma too: segments between its samples are made like all
//! others, so a soma of one sample has no segment of its own and is not drawn.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::error::SceneError;
use super::gathered::{Degenerate, Gathered, Look, SKIP_HELP, is_degenerate, is_degenerate_cone};
use super::names::quoted;
use super::solid_keys::SwcKeys;
use super::source::Source;
use crate::solid::{AnySolid, Cone, ConeError, Cylinder, CylinderError, RoundedCone};

const COLUMNS: [&str; 7] = ["id", "type", "x", "y", "z", "radius", "parent"];
/// The parent of a sample that has none.
const NO_PARENT: i64 = -1;

/// A line of the file.
#[derive(Clone, Debug)]
struct Sample {
    line: u64,
    id: i64,
    point: DVec3,
    radius: f64,
    parent: i64,
}

/// What the segments are, and so how they meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Joints {
    /// Cylinders, of the radius of the segment's own sample.
    Steps,
    /// Cones, which end flat.
    Flat,
    /// Rounded cones, which end in balls.
    Round,
}

/// The joints that an `[[swc]]` asks for.
pub(super) fn joints(source: &Source, keys: &SwcKeys) -> Result<Joints, SceneError> {
    const JOINTS: [(&str, Joints); 2] = [("flat", Joints::Flat), ("round", Joints::Round)];
    let joints = match &keys.joints {
        Some(word) => source.choose("joints", word, &JOINTS)?,
        None => Joints::Steps,
    };
    match &keys.caps {
        Some(caps) if joints == Joints::Round => Err(source.error(
            caps.span(),
            "caps are for flat ends: with joints = \"round\" segments end in balls",
        )),
        _ => Ok(joints),
    }
}

/// Why a segment is no solid.
struct Fault {
    message: String,
    is_of_radius: bool,
    is_degenerate: bool,
}

impl Joints {
    /// The segment between a sample and its parent.
    fn segment(self, parent: &Sample, sample: &Sample, look: Look) -> Result<AnySolid, Fault> {
        let (p0, p1) = (parent.point, sample.point);
        let (radius0, radius1) = (parent.radius, sample.radius);
        match self {
            Self::Steps => Cylinder::new(p0, p1, radius1, look.caps)
                .map(AnySolid::from)
                .map_err(|error| Fault {
                    message: error.to_string(),
                    is_of_radius: matches!(error, CylinderError::Radius { .. }),
                    is_degenerate: is_degenerate(&error),
                }),
            Self::Flat => Cone::new(p0, p1, radius0, radius1, look.caps)
                .map(AnySolid::from)
                .map_err(Fault::of_cone),
            Self::Round => RoundedCone::new(p0, p1, radius0, radius1)
                .map(AnySolid::from)
                .map_err(|error| Fault::of_cone(error.0)),
        }
    }
}

impl Fault {
    fn of_cone(error: ConeError) -> Self {
        Self {
            message: error.to_string(),
            is_of_radius: matches!(error, ConeError::Radius { .. } | ConeError::NoRadius),
            is_degenerate: is_degenerate_cone(&error),
        }
    }
}

/// Adds the segments of an `[[swc]]`, in the order of their samples.
pub(super) fn add_swc(
    solids: &mut Gathered,
    source: &Source,
    keys: &SwcKeys,
    look: Look,
    joints: Joints,
    degenerate: Degenerate,
) -> Result<(), SceneError> {
    let file = SwcFile {
        path: source.resolve(keys.file.get_ref()),
    };
    let samples = file
        .samples()
        .map_err(|error| source.unreadable(&keys.file, error))?;
    let index = file.index(&samples)?;
    let parents = file.parents(&samples, &index)?;
    file.check_cycles(&samples, &parents)?;
    for (sample, parent) in samples.iter().zip(&parents) {
        let Some(parent) = parent.map(|place| &samples[place]) else {
            continue;
        };
        match joints.segment(parent, sample, look) {
            Ok(solid) => solids.push_any(&solid, look.material),
            Err(fault) if fault.is_degenerate && degenerate == Degenerate::Skip => solids.skip(),
            Err(fault) => {
                let column = fault.is_of_radius.then_some("radius");
                let help = fault.is_degenerate.then_some(SKIP_HELP);
                return Err(file.error(sample.line, column, fault.message, help));
            }
        }
        .map_err(|refusal| {
            refusal.in_row(source, &keys.file, |message, help| {
                file.error(sample.line, None, message, help)
            })
        })?;
    }
    Ok(())
}

/// A file that is being read.
struct SwcFile {
    path: PathBuf,
}

impl SwcFile {
    fn error(
        &self,
        line: u64,
        column: Option<&str>,
        message: impl Into<String>,
        help: Option<&str>,
    ) -> SceneError {
        SceneError::Row {
            path: self.path.clone(),
            line,
            column: column.map(str::to_owned),
            message: message.into(),
            help: help.map(str::to_owned),
        }
    }

    /// All samples, in the order of the file.
    fn samples(&self) -> Result<Vec<Sample>, SceneError> {
        let path: &Path = &self.path;
        let unreadable = |source| SceneError::Unreadable {
            path: path.to_owned(),
            source,
        };
        let mut reader = BufReader::new(File::open(path).map_err(unreadable)?);
        let mut samples = Vec::new();
        let mut bytes = Vec::new();
        let mut line = 0;
        while reader.read_until(b'\n', &mut bytes).map_err(unreadable)? > 0 {
            line += 1;
            let row = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
            let row = row.trim_ascii();
            if !row.is_empty() && !row.starts_with(b"#") {
                let text = std::str::from_utf8(row).map_err(|_| SceneError::Encoding {
                    path: path.to_owned(),
                    line,
                    column: None,
                    utf16: line == 1 && (row[0] == 0xff || row[0] == 0xfe),
                })?;
                samples.push(self.sample(line, text)?);
            }
            bytes.clear();
        }
        if samples.is_empty() {
            return Err(self.error(line.max(1), None, "the file holds no samples", None));
        }
        Ok(samples)
    }

    fn sample(&self, line: u64, text: &str) -> Result<Sample, SceneError> {
        let cells: Vec<&str> = text.split_whitespace().collect();
        let Ok(cells) = <[&str; 7]>::try_from(cells.as_slice()) else {
            let count = cells.len();
            let message =
                format!("the row has {count} cells, SWC has 7: id type x y z radius parent");
            return Err(self.error(line, None, message, None));
        };
        let whole = |index: usize| {
            cells[index].parse::<i64>().map_err(|_| {
                let message = format!("{} is not a whole number", quoted(cells[index]));
                self.error(line, Some(COLUMNS[index]), message, None)
            })
        };
        let number = |index: usize| match cells[index].parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let message = format!("{} is not a finite number", quoted(cells[index]));
                Err(self.error(line, Some(COLUMNS[index]), message, None))
            }
        };
        whole(1)?;
        Ok(Sample {
            line,
            id: whole(0)?,
            point: DVec3::new(number(2)?, number(3)?, number(4)?),
            radius: number(5)?,
            parent: whole(6)?,
        })
    }

    /// Where each id stands in the list of samples.
    fn index(&self, samples: &[Sample]) -> Result<HashMap<i64, usize>, SceneError> {
        let mut index = HashMap::with_capacity(samples.len());
        for (place, sample) in samples.iter().enumerate() {
            if let Some(first) = index.insert(sample.id, place) {
                let (id, line) = (sample.id, samples[first].line);
                let message = format!("the id {id} stands on line {line} already");
                return Err(self.error(sample.line, Some("id"), message, None));
            }
        }
        Ok(index)
    }

    /// Where the parent of each sample stands in the list of samples.
    fn parents(
        &self,
        samples: &[Sample],
        index: &HashMap<i64, usize>,
    ) -> Result<Vec<Option<usize>>, SceneError> {
        let parent = |sample: &Sample| {
            let message = match index.get(&sample.parent) {
                _ if sample.parent == NO_PARENT => return Ok(None),
                Some(_) if sample.parent == sample.id => "the sample is its own parent".to_owned(),
                Some(&place) => return Ok(Some(place)),
                None => format!(
                    "there is no sample {}: the parent must be the id of a sample, or -1 for none",
                    sample.parent
                ),
            };
            Err(self.error(sample.line, Some("parent"), message, None))
        };
        samples.iter().map(parent).collect()
    }

    /// That no sample descends from itself.
    fn check_cycles(
        &self,
        samples: &[Sample],
        parents: &[Option<usize>],
    ) -> Result<(), SceneError> {
        // For each sample the start of the walk that came by first.
        let mut seen = vec![usize::MAX; samples.len()];
        for start in 0..samples.len() {
            let mut place = start;
            while seen[place] == usize::MAX {
                seen[place] = start;
                match parents[place] {
                    Some(parent) => place = parent,
                    None => break,
                }
            }
            // The walk met its own trail, rather than an end or an older one.
            if seen[place] == start && parents[place].is_some() {
                return Err(self.cycle(samples, parents, place));
            }
        }
        Ok(())
    }

    /// That the sample at `place` descends from itself. The error is about
    /// the first sample of the cycle in the file.
    fn cycle(&self, samples: &[Sample], parents: &[Option<usize>], place: usize) -> SceneError {
        const MOST_SHOWN: usize = 12;
        let mut round = vec![place];
        round.extend(
            std::iter::successors(parents[place], |&at| parents[at]).take_while(|&at| at != place),
        );
        let first = (0..round.len()).min_by_key(|&at| round[at]).unwrap_or(0);
        round.rotate_left(first);
        let id = |at: usize| samples[at].id.to_string();
        let mut ids: Vec<String> = round.iter().take(MOST_SHOWN).map(|&at| id(at)).collect();
        if round.len() > MOST_SHOWN {
            ids.push(format!("({} more)", round.len() - MOST_SHOWN));
        }
        ids.push(id(round[0]));
        let message = format!(
            "the parents form a cycle: {}; a neuron is a tree, a sample must not descend from itself",
            ids.join(" -> ")
        );
        self.error(samples[round[0]].line, Some("parent"), message, None)
    }
}
