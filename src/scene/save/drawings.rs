//! What a scene file states of what is drawn into and over the picture, and of what is cut away.

use super::text::{Entry, Text};
use super::{SaveError, check_unit};
use crate::scene::description::Scene;
use crate::scene::inset::Inset;
use crate::scene::record::MaterialIndex;

pub(super) fn state(text: &mut Text, scene: &Scene) -> Result<(), SaveError> {
    legend(text, scene)?;
    clips(text, scene)?;
    let illustration = &scene.illustration;
    if let Some(bar) = &illustration.scale_bar {
        let mut entry = text.table("[scale_bar]");
        if let Some(length) = bar.length {
            entry.number("length", length);
        }
        entry.text("unit", &bar.unit);
        inset(&mut entry, bar.inset);
    }
    if let Some(axes) = &illustration.axes {
        let mut entry = text.table("[axes]");
        entry.truth("labels", axes.labels);
        inset(&mut entry, axes.inset);
    }
    if let Some(outlines) = &illustration.outlines {
        let mut entry = text.table("[outlines]");
        entry.number("width", outlines.width);
        entry.vector("color", outlines.color);
        entry.number("crease_degrees", outlines.crease_degrees);
        entry.truth("between_solids", outlines.between_solids);
    }
    if let Some(cue) = &illustration.depth_cue {
        let mut entry = text.table("[depth_cue]");
        if let Some(color) = cue.color {
            entry.vector("color", color);
        }
        for (key, distance) in [("start", cue.start), ("end", cue.end)] {
            if let Some(distance) = distance {
                entry.number(key, distance);
            }
        }
        entry.number("strength", cue.strength);
    }
    Ok(())
}

fn legend(text: &mut Text, scene: &Scene) -> Result<(), SaveError> {
    let Some(legend) = &scene.legend else {
        return Ok(());
    };
    let material = material_name(scene, legend.material)?;
    let mut entry = text.table("[legend]");
    entry.text("material", material);
    entry.text("title", &legend.title);
    inset(&mut entry, legend.inset);
    Ok(())
}

fn clips(text: &mut Text, scene: &Scene) -> Result<(), SaveError> {
    for clip in &scene.clips {
        if clip.material == Some(MaterialIndex::default()) {
            return Err(SaveError::DefaultMaterialOfClip);
        }
        let material = clip.material.map(|index| material_name(scene, index));
        check_unit("the normal of a clip plane", clip.normal)?;
        let mut entry = text.table("[[clip]]");
        entry.vector("point", clip.point);
        entry.vector("normal", clip.normal);
        entry.material(material.transpose()?);
        entry.truth("shadows", clip.casts_shadows);
    }
    Ok(())
}

fn material_name(scene: &Scene, index: MaterialIndex) -> Result<&str, SaveError> {
    let material = scene.materials.get(usize::from(index.0));
    let material = material.ok_or(SaveError::Reference {
        what: "material",
        index: index.0.into(),
    })?;
    Ok(&material.name)
}

fn inset(entry: &mut Entry, inset: Inset) {
    entry.text("corner", inset.corner.name());
    entry.number("size", inset.size);
    entry.vector("color", inset.color);
    entry.vector("background", inset.background);
    entry.number("opacity", inset.opacity);
}
