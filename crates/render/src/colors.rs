//! The colors of surfaces at hits.

use std::sync::Arc;

use cyltrace::scene::{Color, PrototypeIndex, Scene};
use cyltrace::tracer::{HitFields, PartialHit};
use glam::DVec3;

/// The colors of a scene's materials.
pub(crate) struct Colors {
    scene: Arc<Scene>,
    fields: HitFields,
    /// For each material with a data color, the position of its column among the values of each
    /// prototype's placements; empty if no placement has a value of it.
    placed: Vec<Vec<Option<usize>>>,
}

impl Colors {
    pub fn new(scene: &Arc<Scene>) -> Self {
        let mut fields = HitFields::empty();
        let mut placed = Vec::with_capacity(scene.materials.len());
        for material in &scene.materials {
            let mut columns = Vec::new();
            match &material.color {
                Color::Constant(_) => {}
                Color::Checker(_) | Color::Stripes(_) | Color::Image(_) => fields |= HitFields::UV,
                Color::Data(data) => {
                    columns = placed_columns(scene, &data.column);
                    if !columns.is_empty() {
                        fields |= HitFields::PATH;
                    }
                }
            }
            placed.push(columns);
        }
        Self {
            scene: Arc::clone(scene),
            fields,
            placed,
        }
    }

    /// The fields of a hit that determine its color.
    pub fn fields(&self) -> HitFields {
        self.fields
    }

    /// The color of the surface at a hit with at least these fields.
    pub fn at(&self, hit: &PartialHit) -> DVec3 {
        let uv = || hit.uv().expect("the fields of colors are requested");
        match &self.scene.materials[usize::from(hit.material().0)].color {
            Color::Constant(color) => *color,
            Color::Checker(checker) => {
                let (u, v) = uv();
                checker.at(u, v)
            }
            Color::Stripes(stripes) => {
                let (u, v) = uv();
                stripes.at(u, v)
            }
            Color::Image(image) => {
                let (u, v) = uv();
                image.at(u, v)
            }
            Color::Data(data) => data.at(self.value(hit)),
        }
    }

    /// The value at a hit: that of the solid, or else that of the innermost placement that has
    /// one.
    fn value(&self, hit: &PartialHit) -> Option<f32> {
        let prototypes = &self.scene.prototypes;
        let own = prototypes[hit.prototype().0 as usize]
            .solid_values
            .get(hit.primitive());
        let columns = &self.placed[usize::from(hit.material().0)];
        if own.is_some() || columns.is_empty() {
            return own;
        }
        let path = hit.instance().expect("the fields of colors are requested");
        let mut innermost = None;
        let mut index = PrototypeIndex::ROOT.0 as usize;
        for &number in path {
            let prototype = &prototypes[index];
            let values = columns[index].map(|column| &prototype.placement_values[column].values);
            innermost = values.and_then(|values| values.get(number)).or(innermost);
            index = prototype.placements[number as usize].of.0 as usize;
        }
        innermost
    }
}

/// The position of a column among the values of each prototype's placements; empty if none has
/// it.
fn placed_columns(scene: &Scene, column: &str) -> Vec<Option<usize>> {
    let of_prototype = scene.prototypes.iter().map(|prototype| {
        let mut columns = prototype.placement_values.iter();
        columns.position(|shown| shown.column == column)
    });
    let places: Vec<_> = of_prototype.collect();
    match places.iter().all(Option::is_none) {
        true => Vec::new(),
        false => places,
    }
}
