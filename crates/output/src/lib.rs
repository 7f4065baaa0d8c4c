//! The outputs of cyltrace: files that are never left half written, pictures with legends over
//! them, and figures, tables and pages as text.

mod axis;
mod csv;
mod figure;
mod film;
mod html;
mod label;
mod new_file;
mod overlay;
mod picture;
mod size;
mod srgb;
mod table;
mod text_file;
mod tone_map;
mod unfinished;

pub use csv::csv;
pub use figure::{Figure, Mark, Series, Symbol};
pub use film::Film;
pub use html::Page;
pub use new_file::{FileError, NewFile, followed};
pub use overlay::{
    Axes, Corner, Inset, Insets, Legend, Overlay, Scale, ScaleBar, ScaleBarError, with_overlays,
};
pub use picture::{
    Band, Bands, Channel, Contents, Format, Numbers, Output, OutputError, picture_png_bytes,
    png_bytes,
};
pub use size::{parse_size, readable};
pub use srgb::encode as srgb_encode;
pub use table::{Table, figure};
pub use text_file::write_text;
pub use tone_map::{Display, ToneMap};
pub use unfinished::{UnfinishedGuard, is_unfinished, remove_unfinished};
