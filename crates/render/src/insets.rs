//! What is drawn over the corners of pictures of a scene.

use cyltrace::scene::Integrator;
use cyltrace::tracer::Tracer;
use cyltrace_output::{Axes, Insets, ScaleBar, ScaleBarError};
use glam::DVec3;

use super::Settings;
use super::inset::{inset, numbers};
use super::legend::legend;

/// The insets of a picture. It has the scene's legend if the integrator shows the colors of
/// materials.
///
/// # Errors
/// If the stated length of the scale bar is longer than the picture has room for.
pub fn insets(tracer: &Tracer, settings: &Settings) -> Result<Insets, ScaleBarError> {
    let scene = tracer.scene();
    let shows_colors = matches!(settings.integrator, Integrator::Sun | Integrator::Path);
    let mut insets = Insets {
        legend: legend(scene).filter(|_| shows_colors),
        ..Insets::default()
    };
    let illustration = &scene.illustration;
    if illustration.scale_bar.is_none() && illustration.axes.is_none() {
        return Ok(insets);
    }
    let camera = settings.camera(tracer);
    let size = (settings.film.width, settings.film.height);
    if let (Some(bar), Some(pixels)) = (&illustration.scale_bar, camera.pixels_per_unit()) {
        let bar = ScaleBar::new(bar.length, &bar.unit, inset(&bar.inset), pixels, size)?;
        insets.scale_bar = Some(bar);
    }
    insets.axes = illustration.axes.map(|axes| Axes {
        directions: DVec3::AXES.map(|axis| numbers(camera.seen_direction(axis))),
        labels: axes.labels,
        inset: inset(&axes.inset),
    });
    Ok(insets)
}
