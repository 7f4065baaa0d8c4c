//! `[scale_bar]`, `[axes]`, `[outlines]` and `[depth_cue]` of a scene file.

use serde::Deserialize;
use toml::Spanned;

use super::description::{Camera, Projection};
use super::error::SceneError;
use super::illustration::{Axes, DepthCue, Illustration, Outlines, ScaleBar};
use super::inset::Corner;
use super::inset_keys::{check_corners, color, number, with_inset_keys};
use super::legend::Legend;
use super::legend_keys::LegendKeys;
use super::source::Source;
use super::values::{Keys, Number, Triple};
use crate::solid::Cylinder;

with_inset_keys! {
    /// `[scale_bar]`
    ScaleBarKeys {
        length: Option<Spanned<Number>>,
        unit: Option<Spanned<String>>,
    }
}

with_inset_keys! {
    /// `[axes]`
    AxesKeys {
        labels: Option<bool>,
    }
}

/// `[outlines]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OutlinesKeys {
    width: Option<Spanned<Number>>,
    color: Option<Triple>,
    crease_degrees: Option<Spanned<Number>>,
    between_solids: Option<bool>,
}

/// `[depth_cue]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DepthCueKeys {
    color: Option<Triple>,
    start: Option<Spanned<Number>>,
    end: Option<Spanned<Number>>,
    strength: Option<Spanned<Number>>,
}

/// The tables of an illustration.
#[derive(Clone, Copy)]
pub(super) struct IllustrationKeys<'a> {
    pub scale_bar: Option<&'a Spanned<Keys<ScaleBarKeys>>>,
    pub axes: Option<&'a Keys<AxesKeys>>,
    pub outlines: Option<&'a Keys<OutlinesKeys>>,
    pub depth_cue: Option<&'a Keys<DepthCueKeys>>,
}

/// The illustration that a scene file states.
pub(super) fn illustration(
    source: &Source,
    keys: IllustrationKeys,
    camera: &Camera,
    legend: Option<(&LegendKeys, &Legend)>,
) -> Result<Illustration, SceneError> {
    let scale_bar = keys.scale_bar;
    let scale_bar = scale_bar.map(|key| key.get_ref().0.scale_bar(source, camera, key.span()));
    let axes = keys.axes.map(|Keys(keys)| keys.axes(source));
    let outlines = keys.outlines;
    let outlines = outlines.map(|Keys(keys)| keys.outlines(source));
    let depth_cue = keys.depth_cue;
    let depth_cue = depth_cue.map(|Keys(keys)| keys.depth_cue(source));
    let illustration = Illustration {
        scale_bar: scale_bar.transpose()?,
        axes: axes.transpose()?,
        outlines: outlines.transpose()?,
        depth_cue: depth_cue.transpose()?,
    };
    check_insets(source, keys, legend, &illustration)?;
    Ok(illustration)
}

/// Rejects two of legend, scale bar and axes in one corner.
fn check_insets(
    source: &Source,
    keys: IllustrationKeys,
    legend: Option<(&LegendKeys, &Legend)>,
    illustration: &Illustration,
) -> Result<(), SceneError> {
    let mut insets = Vec::new();
    if let Some((keys, legend)) = legend {
        insets.push(("legend", legend.inset.corner, keys.inset_keys()));
    }
    if let (Some(bar), Some(key)) = (&illustration.scale_bar, keys.scale_bar) {
        let Keys(keys) = key.get_ref();
        insets.push(("scale_bar", bar.inset.corner, keys.inset_keys()));
    }
    if let (Some(axes), Some(Keys(keys))) = (&illustration.axes, keys.axes) {
        insets.push(("axes", axes.inset.corner, keys.inset_keys()));
    }
    check_corners(source, &insets)
}

impl ScaleBarKeys {
    fn scale_bar(
        &self,
        source: &Source,
        camera: &Camera,
        place: std::ops::Range<usize>,
    ) -> Result<ScaleBar, SceneError> {
        if camera.projection == Projection::Panorama {
            return Err(source.error_with_help(
                place,
                "[scale_bar] is for the perspective and the orthographic camera: a panorama has no scale",
                "remove [scale_bar], or choose another type of [camera]",
            ));
        }
        let length = self.length.as_ref();
        let length = length.map(|key| match key.get_ref().0 {
            length if (Cylinder::LEAST..=Cylinder::GREATEST).contains(&length) => Ok(length),
            length => Err(source.error(
                key.span(),
                format!("length is {length}: it must be a positive number of scene units"),
            )),
        });
        let unit = self.unit.as_ref();
        let unit = unit.map(|key| match key.get_ref() {
            unit if unit.chars().any(char::is_control) => Err(source.error(
                key.span(),
                "unit has a control character: it must be one line of text",
            )),
            unit => Ok(unit.clone()),
        });
        Ok(ScaleBar {
            length: length.transpose()?,
            unit: unit.transpose()?.unwrap_or_default(),
            inset: self.inset_keys().inset(source, Corner::BottomLeft)?,
        })
    }
}

impl AxesKeys {
    fn axes(&self, source: &Source) -> Result<Axes, SceneError> {
        Ok(Axes {
            labels: self.labels.unwrap_or(true),
            inset: self.inset_keys().inset(source, Corner::TopLeft)?,
        })
    }
}

impl OutlinesKeys {
    fn outlines(&self, source: &Source) -> Result<Outlines, SceneError> {
        let default = Outlines::DEFAULT;
        let positive =
            |key: &Option<Spanned<Number>>, what: &str, default: f64, most: f64| match key {
                Some(key) if key.get_ref().0 <= 0.0 => Err(source.error(
                    key.span(),
                    format!("{what} is {}: it must be greater than 0", key.get_ref().0),
                )),
                key => number(source, key.as_ref(), what, default, [0.0, most]),
            };
        Ok(Outlines {
            width: positive(
                &self.width,
                "width",
                default.width,
                Outlines::GREATEST_WIDTH,
            )?,
            color: color(source, self.color.as_ref(), default.color)?,
            crease_degrees: positive(
                &self.crease_degrees,
                "crease_degrees",
                default.crease_degrees,
                180.0,
            )?,
            between_solids: self.between_solids.unwrap_or(default.between_solids),
        })
    }
}

impl DepthCueKeys {
    fn depth_cue(&self, source: &Source) -> Result<DepthCue, SceneError> {
        let distance = |key: &Option<Spanned<Number>>, what: &str| {
            let key = key.as_ref();
            let range = [0.0, Cylinder::GREATEST];
            let distance = key.map(|_| number(source, key, what, 0.0, range));
            distance.transpose()
        };
        let (start, end) = (distance(&self.start, "start")?, distance(&self.end, "end")?);
        if let (Some(first), Some(last), Some(key)) = (start, end, &self.end)
            && last <= first
        {
            return Err(source.error(
                key.span(),
                format!("end is {last}: it must be greater than start, which is {first}"),
            ));
        }
        let default = DepthCue::DEFAULT_STRENGTH;
        Ok(DepthCue {
            color: match &self.color {
                None => None,
                key => Some(color(source, key.as_ref(), glam::DVec3::ONE)?),
            },
            start,
            end,
            strength: number(
                source,
                self.strength.as_ref(),
                "strength",
                default,
                [0.0, 1.0],
            )?,
        })
    }
}
