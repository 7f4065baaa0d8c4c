//! Removes the noise of pictures with Intel Open Image Denoise 2.
//!
//! The library is loaded at run time, so that programs need it only where they denoise. It
//! guesses what a picture without noise looks like: the result is for the eye, has no error bound
//! and differs between versions and machines.
//!
//! # Example
//! ```no_run
//! use cyltrace_denoise::{Denoiser, Picture};
//!
//! let mut colors = vec![[0.5_f32; 3]; 64 * 48];
//! let (albedo, normals) = (vec![[0.8_f32; 3]; 64 * 48], vec![[0.0_f32, 0.0, 1.0]; 64 * 48]);
//! let mut picture = Picture {
//!     width: 64,
//!     height: 48,
//!     colors: &mut colors,
//!     albedo: &albedo,
//!     normals: &normals,
//! };
//! Denoiser::load()?.denoise(&mut picture, 2)?;
//! # Ok::<(), cyltrace_denoise::DenoiseError>(())
//! ```

mod library;

use library::{Device, Image, Library};

/// The name of the library for the system's loader, which searches its usual folders and those of
/// `LD_LIBRARY_PATH`.
pub const LIBRARY: &str = if cfg!(target_os = "macos") {
    "libOpenImageDenoise.2.dylib"
} else if cfg!(windows) {
    "OpenImageDenoise.dll"
} else {
    "libOpenImageDenoise.so.2"
};

/// Why a picture cannot be denoised.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DenoiseError {
    /// The library, or a function in it, cannot be loaded.
    #[error(
        "Open Image Denoise 2 cannot be loaded: install it, or put the folder of {LIBRARY} into LD_LIBRARY_PATH"
    )]
    Load {
        /// The error of the system's loader.
        source: libloading::Error,
    },
    /// The library reports an error.
    #[error("Open Image Denoise reports: {message}")]
    Library {
        /// Its message.
        message: String,
    },
}

/// A picture, row by row from the top. All lists have `width * height` pixels.
#[derive(Debug)]
pub struct Picture<'a> {
    /// The number of columns.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    /// Linear RGB, which is replaced; components are finite and not negative.
    pub colors: &'a mut [[f32; 3]],
    /// The colors of the surfaces that are seen first, in [0, 1]; 0 where there is none.
    pub albedo: &'a [[f32; 3]],
    /// Their unit normals; 0 where there is none.
    pub normals: &'a [[f32; 3]],
}

/// The loaded library.
#[derive(Debug)]
pub struct Denoiser(Library);

impl Denoiser {
    /// Loads the library [`LIBRARY`].
    ///
    /// # Errors
    /// If the system's loader does not find it, or finds another version.
    pub fn load() -> Result<Self, DenoiseError> {
        Library::load(LIBRARY).map(Self)
    }

    /// Replaces the colors by those without noise, as the library guesses them, on `threads`
    /// threads of the processor.
    ///
    /// # Errors
    /// If the library reports an error. The colors are undefined then.
    ///
    /// # Panics
    /// If a list has another number of pixels.
    pub fn denoise(&self, picture: &mut Picture, threads: usize) -> Result<(), DenoiseError> {
        let (width, height) = (picture.width, picture.height);
        let pixels = width * height;
        assert_eq!(picture.colors.len(), pixels, "the colors of all pixels");
        assert_eq!(picture.albedo.len(), pixels, "the albedo of all pixels");
        assert_eq!(picture.normals.len(), pixels, "the normals of all pixels");
        let size = [width, height];
        let device = Device::new(&self.0, threads)?;
        device.run(
            [
                Image::read(c"albedo", picture.albedo, size),
                Image::read(c"normal", picture.normals, size),
            ],
            Image::replaced(picture.colors, size),
        )
    }
}
