//! Parts of a picture: the pixels of a run of tiles as they are, little-endian: three f32 of the
//! color, and a word of four bytes for each channel.

use std::io::{self, Read, Write};
use std::path::Path;

use anyhow::bail;
use cyltrace::scene::{Film, GREATEST_PIXELS};
use cyltrace_output::{Band, Channel, Contents, Display, Insets, Output, ToneMap, with_overlays};
use cyltrace_parts::{PartFile, PartSet, PartWriter, Payload};
use cyltrace_render::{ChannelGroup, Channels, RenderedTiles, Settings, Target, Tiles};
use serde_json::{Value, json};

use super::value;
use crate::reached;

/// Bytes of a color, and of a word.
const COLOR: usize = 12;
const WORD: usize = 4;

/// The settings that determine a picture.
pub fn settings(settings: &Settings, display: Display, exact: bool) -> Value {
    let channels = settings.channels.groups().iter();
    let mut determining = json!({
        "size": [settings.film.width, settings.film.height],
        "spp": settings.spp,
        "integrator": settings.integrator.name(),
        "sampler": settings.sampler.name(),
        "seed": settings.seed,
        "exact": exact,
        "channels": channels.map(|group| group.name()).collect::<Vec<_>>(),
        "opacity": settings.channels.has_opacity(),
        "exposure": display.exposure,
        "tonemap": display.tone_map.name(),
        "error": settings.target.map(|target| target.error),
    });
    if settings.target.is_some() {
        determining["error_rule"] = json!(Target::RULE);
    }
    determining
}

/// Writes the payload.
pub fn write(part: &mut PartWriter, tiles: &RenderedTiles) -> io::Result<()> {
    write_pixels(part, &tiles.pixels, &tiles.words)
}

/// Writes pixels, each with its words.
pub fn write_pixels(target: &mut impl Write, colors: &[[f32; 3]], words: &[u32]) -> io::Result<()> {
    let each = words.len() / colors.len().max(1);
    for (number, color) in colors.iter().enumerate() {
        for value in color {
            target.write_all(&value.to_le_bytes())?;
        }
        for word in &words[number * each..][..each] {
            target.write_all(&word.to_le_bytes())?;
        }
    }
    Ok(())
}

/// The bytes of a pixel with this number of words.
pub fn pixel_bytes(words: usize) -> usize {
    COLOR + words * WORD
}

/// The color and the words of a pixel.
pub fn pixel(bytes: &[u8]) -> ([f32; 3], impl Iterator<Item = u32>) {
    let (words, _) = bytes.as_chunks();
    let mut words = words.iter().map(|&word| u32::from_le_bytes(word));
    let color = [(); 3].map(|()| f32::from_bits(words.next().unwrap_or_default()));
    (color, words)
}

/// What the file of the picture has beside its colors.
fn contents(set: &PartSet) -> anyhow::Result<Contents> {
    let (first, stated) = (&set.parts()[0], &set.header().settings);
    let groups: Vec<String> = value(first, &stated["channels"])?;
    let group = |name: &String| ChannelGroup::ALL.into_iter().find(|one| one.name() == name);
    let groups: Option<Vec<_>> = groups.iter().map(group).collect();
    let tone_map: String = value(first, &stated["tonemap"])?;
    let mut tone_maps = ToneMap::ALL.into_iter();
    let tone_map = tone_maps.find(|one| one.name() == tone_map);
    let (Some(groups), Some(tone_map)) = (groups, tone_map) else {
        bail!("{:?} is a part that this version cannot read", first.path());
    };
    let display = Display {
        exposure: value(first, &stated["exposure"])?,
        tone_map,
    };
    Ok(Contents {
        channels: Channels::new(groups, value(first, &stated["opacity"])?).list(),
        display,
        error: reached::of_parts(set).map(|reached| reached.error),
    })
}

/// Checks that the picture of a whole set can be written.
pub fn check(set: &PartSet, output: &Path) -> anyhow::Result<()> {
    Ok(Output::check(output, &contents(set)?)?)
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
    let contents = contents(set)?;
    let words = contents.channels.len();
    let bytes = pixel_bytes(words);
    let tiles = Tiles::of(film);
    for part in set.parts() {
        let header = part.header();
        let pixels = tiles.pixels(header.range.clone());
        if header.whole != tiles.count() || part.payload_bytes() != pixels * bytes as u64 {
            bail!("{:?} has more or fewer pixels than its tiles", part.path());
        }
    }
    let mut pixels = Pixels::new(set.parts(), words);
    let (mut row, mut read) = (0, Band::default());
    let bands = |band: &mut Band| {
        pixels.read(tiles.pixels(tiles.row(row)), &mut read)?;
        tiles.arrange(row, 1, &read.colors, &mut band.colors);
        tiles.arrange(row, words, &read.words, &mut band.words);
        row += 1;
        Ok(())
    };
    let insets: Insets = value(first, &first.summary()["insets"])?;
    let overlays = insets.overlays((width, height));
    // Opacity is the first channel.
    let has_opacity = contents.channels.first() == Some(&Channel::OPACITY);
    let bands = with_overlays(overlays, width, has_opacity, bands);
    Output::create(output, contents)?.write_bands((width, height), bands)?;
    Ok(())
}

/// The pixels of all parts, one after the other.
struct Pixels<'a> {
    parts: std::slice::Iter<'a, PartFile>,
    payload: Option<Payload>,
    bytes: Vec<u8>,
    /// Words of a pixel.
    words: usize,
}

impl<'a> Pixels<'a> {
    fn new(parts: &'a [PartFile], words: usize) -> Self {
        Self {
            parts: parts.iter(),
            payload: None,
            bytes: Vec::new(),
            words,
        }
    }

    /// Reads the next `count` pixels.
    fn read(&mut self, count: u64, pixels: &mut Band) -> io::Result<()> {
        let each = pixel_bytes(self.words);
        self.bytes.resize(count as usize * each, 0);
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
        pixels.clear();
        for bytes in self.bytes.chunks_exact(each) {
            let (color, words) = pixel(bytes);
            pixels.colors.push(color);
            pixels.words.extend(words);
        }
        Ok(())
    }
}
