//! The legend of a scene, as it is drawn over pictures.

use std::collections::BTreeSet;

use cyltrace::scene::{Color, DataColor, Listed, MaterialIndex, Prototype, Scene, SolidList};
use cyltrace::solid::SolidKind;
use cyltrace::with_solid_kind;
use cyltrace_output::{Legend, Scale};

use super::inset::{inset, numbers};

/// The colors of a bar, as many as 8-bit gradients have.
const STEPS: u32 = 256;

/// The most categories that are listed.
const MOST_CATEGORIES: usize = 24;

/// The legend of a scene, if it states one.
///
/// A legend of categories lists those that solids of its material or placements have, up to
/// 24, each with its label or its number.
pub(super) fn legend(scene: &Scene) -> Option<Legend> {
    let legend = scene.legend.as_ref()?;
    let Color::Data(data) = &scene.materials.get(usize::from(legend.material.0))?.color else {
        return None;
    };
    let scale = match data.map.has_categories() {
        true => Scale::Categories(categories(scene, legend.material, data)),
        false => {
            let places = (0..STEPS).map(|step| f64::from(step) / f64::from(STEPS - 1));
            Scale::Range {
                ends: data.range,
                colors: places.map(|place| numbers(data.map.at(place))).collect(),
            }
        }
    };
    Some(Legend {
        title: legend.title.clone(),
        inset: inset(&legend.inset),
        scale,
    })
}

/// The categories in the scene with their colors and names.
fn categories(scene: &Scene, material: MaterialIndex, data: &DataColor) -> Vec<([f32; 3], String)> {
    let mut found = BTreeSet::new();
    for prototype in &scene.prototypes {
        add_solids(prototype, material, &mut found);
        let columns = prototype.placement_values.iter();
        for column in columns.filter(|shown| shown.column == data.column) {
            let values = column.values.iter().map(|(_, value)| value);
            found.extend(
                values
                    .filter(|value| !value.is_nan())
                    .map(|value| value as u32),
            );
        }
    }
    let listed = found.into_iter().take(MOST_CATEGORIES);
    let listed = listed.map(|category| {
        let label = data.labels.get(category as usize);
        let name = label.cloned().unwrap_or_else(|| category.to_string());
        (numbers(data.map.of_category(category)), name)
    });
    listed.collect()
}

/// Adds the categories of a prototype's solids of a material.
fn add_solids(prototype: &Prototype, material: MaterialIndex, found: &mut BTreeSet<u32>) {
    for &kind in SolidKind::LISTS {
        with_solid_kind!(kind, S => {
            let list = S::list(&prototype.solids);
            for position in 0..list.len() {
                if list.material(position) == material {
                    let value = prototype.solid_values.get(list.primitive(position));
                    found.extend(value.map(|value| value as u32));
                }
            }
        });
    }
}
