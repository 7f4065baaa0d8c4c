//! Parts of a picture: the pixels of a run of tiles as they are, three f32 each, little-endian.

use std::io::{self, Read, Write};
use std::path::Path;

use anyhow::bail;
use cyltrace::scene::{Film, GREATEST_PIXELS};
use cyltrace_output::Output;
use cyltrace_parts::{PartFile, PartSet, PartWriter, Payload};
use cyltrace_render::{Settings, Tiles};
use serde_json::{Value, json};

use super::value;

/// Bytes of a pixel.
const PIXEL: usize = 12;

/// The settings that determine a picture.
pub fn settings(settings: &Settings, exact: bool) -> Value {
    json!({
        "size": [settings.film.width, settings.film.height],
        "spp": settings.spp,
        "integrator": settings.integrator.name(),
        "seed": settings.seed,
        "exact": exact,
    })
}

/// Writes the payload.
pub fn write(part: &mut PartWriter, pixels: &[[f32; 3]]) -> io::Result<()> {
    for color in pixels.as_flattened() {
        part.write_all(&color.to_le_bytes())?;
    }
    Ok(())
}

/// Writes the picture of a whole set, a row of tiles at a time.
pub fn merge(set: &PartSet, output: &Path) -> anyhow::Result<()> {
    let first = &set.parts()[0];
    let [width, height]: [u32; 2] = value(first, &set.header().settings["size"])?;
    let film = Film { width, height };
    let pixels = u64::from(width) * u64::from(height);
    if !(1..=GREATEST_PIXELS).contains(&pixels) {
        bail!("{:?} is of a picture of {width}x{height}", first.path());
    }
    let tiles = Tiles::of(film);
    for part in set.parts() {
        let header = part.header();
        let pixels = tiles.pixels(header.range.clone());
        if header.whole != tiles.count() || part.payload_bytes() != pixels * PIXEL as u64 {
            bail!("{:?} has more or fewer pixels than its tiles", part.path());
        }
    }
    let mut pixels = Pixels::new(set.parts());
    let (mut row, mut colors) = (0, Vec::new());
    let bands = |band: &mut Vec<[f32; 3]>| {
        pixels.read(tiles.pixels(tiles.row(row)), &mut colors)?;
        tiles.arrange(row, &colors, band);
        row += 1;
        Ok(())
    };
    Output::create(output)?.write_bands((width, height), bands)?;
    Ok(())
}

/// The pixels of all parts, one after the other.
struct Pixels<'a> {
    parts: std::slice::Iter<'a, PartFile>,
    payload: Option<Payload>,
    bytes: Vec<u8>,
}

impl<'a> Pixels<'a> {
    fn new(parts: &'a [PartFile]) -> Self {
        Self {
            parts: parts.iter(),
            payload: None,
            bytes: Vec::new(),
        }
    }

    /// Reads the next `count` pixels.
    fn read(&mut self, count: u64, colors: &mut Vec<[f32; 3]>) -> io::Result<()> {
        self.bytes.resize(count as usize * PIXEL, 0);
        let mut filled = 0;
        while filled < self.bytes.len() {
            let read = match &mut self.payload {
                Some(payload) => payload.read(&mut self.bytes[filled..])?,
                None => 0,
            };
            filled += read;
            if read == 0 {
                let part = self.parts.next().ok_or(io::ErrorKind::UnexpectedEof)?;
                self.payload = Some(part.payload().map_err(io::Error::other)?);
            }
        }
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        colors.clear();
        colors.extend(
            self.bytes
                .chunks_exact(PIXEL)
                .map(|pixel| [0, 4, 8].map(|at| number(&pixel[at..at + 4]))),
        );
        Ok(())
    }
}
