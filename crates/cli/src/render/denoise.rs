//! `--denoise`: the colors of whole pictures, with the help of what the surfaces are.

use std::io;
use std::time::Instant;

use cyltrace_denoise::{Denoiser, Picture};
use cyltrace_output::{Band, Bands};
use cyltrace_render::{ChannelGroup, Channels, RenderedTiles, Settings, Tiles};

/// The channels that the library reads.
const ALBEDO: &str = "Albedo.R";
const NORMAL: &str = "N.X";

/// A loaded library, and what it replaces.
pub struct Denoising {
    denoiser: Denoiser,
    threads: usize,
    /// The settings that the picture is rendered with, and those of what is written.
    rendered: Settings,
    written: Settings,
}

/// A picture without noise.
pub struct Denoised {
    picture: Band,
    /// The time it took, in seconds.
    pub seconds: f64,
}

impl Denoising {
    /// Loads the library, before time is spent on a picture.
    pub fn new(settings: &Settings, threads: usize) -> anyhow::Result<Self> {
        let groups = settings.channels.groups().iter().copied();
        let guides = [ChannelGroup::Albedo, ChannelGroup::Normal];
        let channels = Channels::new(groups.chain(guides), settings.channels.has_opacity());
        Ok(Self {
            denoiser: Denoiser::load()?,
            threads,
            rendered: Settings {
                channels,
                ..settings.clone()
            },
            written: settings.clone(),
        })
    }

    /// The settings that the picture is rendered with.
    pub fn settings(&self) -> &Settings {
        &self.rendered
    }

    /// The bytes that a picture takes while its noise is removed, beside the rendered pixels and
    /// what the library takes: a copy, the guides, and the channels that are written.
    pub fn bytes(&self) -> u64 {
        let tiles = Tiles::of(self.written.film);
        let guides = 2 * size_of::<[f32; 3]>() as u64 * tiles.pixels(tiles.all());
        let [copy, written] =
            [&self.rendered, &self.written].map(|settings| settings.pixels_bytes(tiles.all()));
        copy + written + guides
    }

    /// The picture without noise, and without channels that were not requested.
    pub fn apply(&self, rendered: &RenderedTiles) -> anyhow::Result<Denoised> {
        let start = Instant::now();
        let film = self.written.film;
        let (mut whole, mut band) = (Band::default(), Band::default());
        whole.colors.reserve_exact(rendered.pixels.len());
        whole.words.reserve_exact(rendered.words.len());
        let mut bands = rendered.bands(film);
        for _ in 0..Tiles::of(film).rows() {
            band.clear();
            bands(&mut band)?;
            whole.colors.append(&mut band.colors);
            whole.words.append(&mut band.words);
        }
        let names = |settings: &Settings| -> Vec<&str> {
            let channels = settings.channels.list().into_iter();
            channels.map(|channel| channel.name).collect()
        };
        let all = names(&self.rendered);
        let place = |name: &str| {
            let place = all.iter().position(|other| *other == name);
            place.expect("the picture has what is written and the guides")
        };
        let pixels = || whole.words.chunks_exact(all.len());
        let guide = |first: &str| -> Vec<[f32; 3]> {
            let first = place(first);
            let three = |words: &[u32]| [0, 1, 2].map(|at| f32::from_bits(words[first + at]));
            pixels().map(three).collect()
        };
        let (albedo, normals) = (guide(ALBEDO), guide(NORMAL));
        let kept: Vec<_> = names(&self.written).into_iter().map(place).collect();
        let words = pixels().flat_map(|words| kept.iter().map(|&at| words[at]));
        let words = words.collect();
        let mut picture = Picture {
            width: film.width as usize,
            height: film.height as usize,
            colors: &mut whole.colors,
            albedo: &albedo,
            normals: &normals,
        };
        self.denoiser.denoise(&mut picture, self.threads)?;
        whole.words = words;
        Ok(Denoised {
            picture: whole,
            seconds: start.elapsed().as_secs_f64(),
        })
    }
}

impl Denoised {
    /// The picture in one piece.
    pub fn bands(mut self) -> impl Bands {
        move |band: &mut Band| -> io::Result<()> {
            band.colors.append(&mut self.picture.colors);
            band.words.append(&mut self.picture.words);
            Ok(())
        }
    }
}
