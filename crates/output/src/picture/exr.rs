//! OpenEXR: 32-bit linear floats, and channels of 32 bits.

use std::io::{self, Seek, Write};
use std::iter;

use exr::block::lines::LineRefMut;
use exr::block::writer::ChunksWriter;
use exr::block::{self, UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::error::{Error, UnitResult};
use exr::meta::attribute::{AttributeValue, ChannelDescription, SampleType, Text};
use exr::meta::header::{Header, LayerAttributes};

use super::contents::{Band, Bands, Contents, Numbers};

/// The attribute with the estimated error. There may be no second attribute beside it: the
/// encoder writes them in any order.
const ERROR: &str = "relativeError";

/// Writes a picture that comes in bands of rows. The blocks of the file come in order, so that
/// equal pictures give equal files.
pub(super) fn write_bands(
    target: impl Write + Seek,
    (width, height): (u32, u32),
    contents: &Contents,
    bands: impl Bands,
) -> io::Result<()> {
    let sources = sources(contents);
    let header = header((width as usize, height as usize), &sources, contents);
    let mut rows = Window {
        bands,
        width: width as usize,
        first: 0,
        rows: Band::default(),
        band: Band::default(),
        words: contents.channels.len(),
    };
    let headers = iter::once(header).collect();
    let written = block::write(target, headers, true, |meta, chunks| {
        let mut compressor = chunks.sequential_blocks_compressor(&meta);
        for (number, index) in enumerate_ordered_header_block_indices(&meta.headers) {
            let top = index.pixel_position.y();
            rows.advance(top, top + index.pixel_size.height())?;
            let channels = &meta.headers[index.layer].channels;
            let mut filled = Ok(());
            let block = UncompressedBlock::from_lines(channels, index, |line| {
                let source = sources[line.location.channel].1;
                let line = rows.fill(line, source);
                filled = std::mem::replace(&mut filled, Ok(())).and(line);
            });
            filled?;
            compressor.compress_block(number, block)?;
        }
        Ok(())
    });
    written.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other),
    })
}

/// Where the numbers of a channel are.
#[derive(Clone, Copy)]
enum Source {
    Color(usize),
    Word(usize, Numbers),
}

/// All channels of the file, sorted by name as the format requires.
fn sources(contents: &Contents) -> Vec<(&'static str, Source)> {
    let colors = ["R", "G", "B"].into_iter().enumerate();
    let colors = colors.map(|(place, name)| (name, Source::Color(place)));
    let channels = contents.channels.iter().enumerate();
    let channels = channels.map(|(place, one)| (one.name, Source::Word(place, one.numbers)));
    let mut all: Vec<_> = colors.chain(channels).collect();
    all.sort_by_key(|(name, _)| *name);
    all
}

/// The header that the encoder's default for colors has, with all channels.
fn header(size: (usize, usize), sources: &[(&'static str, Source)], contents: &Contents) -> Header {
    let channels = sources.iter().map(|(name, source)| {
        let sample_type = match source {
            Source::Color(_) | Source::Word(_, Numbers::F32) => SampleType::F32,
            Source::Word(_, Numbers::U32) => SampleType::U32,
        };
        ChannelDescription::named(*name, sample_type)
    });
    let mut attributes = LayerAttributes::default();
    if let Some(error) = contents.error {
        let error = AttributeValue::F32(error);
        attributes.other.insert(Text::from(ERROR), error);
    }
    Header::new(Text::default(), size, channels.collect()).with_attributes(attributes)
}

/// Rows from the top of the block that is being written.
struct Window<B> {
    bands: B,
    width: usize,
    /// The row that `rows` begins with.
    first: usize,
    rows: Band,
    /// The next band, empty between calls.
    band: Band,
    /// Words of a pixel.
    words: usize,
}

impl<B: Bands> Window<B> {
    /// Forgets the rows above `top`, and reads those above `bottom`.
    fn advance(&mut self, top: usize, bottom: usize) -> io::Result<()> {
        let above = (top - self.first) * self.width;
        self.rows.colors.drain(..above);
        self.rows.words.drain(..above * self.words);
        self.first = top;
        while self.rows.colors.len() < (bottom - top) * self.width {
            self.band.clear();
            (self.bands)(&mut self.band)?;
            self.rows.colors.append(&mut self.band.colors);
            self.rows.words.append(&mut self.band.words);
        }
        Ok(())
    }

    /// Writes the numbers of a line of a block.
    fn fill(&self, line: LineRefMut<'_>, source: Source) -> UnitResult {
        let position = line.location.position;
        let start = (position.y() - self.first) * self.width + position.x();
        let word = |pixel: usize, place: usize| self.rows.words[pixel * self.words + place];
        match source {
            Source::Color(place) => {
                line.write_samples(|column| self.rows.colors[start + column][place])
            }
            Source::Word(place, Numbers::F32) => {
                line.write_samples(|column| f32::from_bits(word(start + column, place)))
            }
            Source::Word(place, Numbers::U32) => {
                line.write_samples(|column| word(start + column, place))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use exr::image::write::WritableImage;
    use exr::image::{Image, SpecificChannels};
    use exr::math::Vec2;

    use super::*;

    /// Files are those that the encoder itself writes of colors.
    #[test]
    fn colors_alone_have_the_bytes_of_the_encoder() {
        let (width, height) = (150, 70);
        let color = |place: usize| [place as f32, (place / 7) as f32, 0.25];
        let mut expected = Cursor::new(Vec::new());
        let channels = SpecificChannels::rgb(|position: Vec2<usize>| {
            let [red, green, blue] = color(position.y() * width + position.x());
            (red, green, blue)
        });
        let picture = Image::from_channels((width, height), channels);
        picture
            .write()
            .non_parallel()
            .to_buffered(&mut expected)
            .expect("written");
        let mut written = Cursor::new(Vec::new());
        let all = |band: &mut Band| {
            band.colors.extend((0..width * height).map(color));
            Ok(())
        };
        let size = (width as u32, height as u32);
        write_bands(&mut written, size, &Contents::default(), all).expect("written");
        assert!(written.into_inner() == expected.into_inner());
    }
}
