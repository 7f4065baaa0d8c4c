//! The comments in a mesh file that describe the mesh.

use crate::solid::tessellation::Fit;

/// How `cyltrace tessellate` made a mesh, according to the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Made {
    /// Sides around an axis.
    pub segments: u32,
    /// The side of the surface on which the mesh lies.
    pub fit: Fit,
}

/// The first comment of each kind.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::meshes) struct Remarks {
    /// The number after the word `deviation`.
    pub deviation: Option<f64>,
    segments: Option<u32>,
    fit: Option<Fit>,
}

impl Remarks {
    /// Reads another comment, without the character or word that begins it.
    pub fn read(&mut self, comment: &str) {
        self.deviation = self.deviation.or_else(|| deviation(comment));
        // Exactly two words, so that the name of a scene is not mistaken for them.
        let mut words = comment.split_ascii_whitespace();
        let (Some(key), Some(value), None) = (words.next(), words.next(), words.next()) else {
            return;
        };
        match key {
            "segments" => self.segments = self.segments.or_else(|| value.parse().ok()),
            "fit" => {
                let named = |fit: &Fit| fit.name() == value;
                let fit = [Fit::Inscribed, Fit::Circumscribed].into_iter().find(named);
                self.fit = self.fit.or(fit);
            }
            _ => {}
        }
    }

    /// How the mesh was made, if the comments state both segments and fit.
    pub fn made(&self) -> Option<Made> {
        let (segments, fit) = (self.segments?, self.fit?);
        Some(Made { segments, fit })
    }
}

/// The number after the word `deviation`.
fn deviation(comment: &str) -> Option<f64> {
    let (_, after) = comment.split_once("deviation")?;
    let mut words = after.split(|c: char| c.is_whitespace() || matches!(c, ':' | '=' | ','));
    let number: f64 = words.find_map(|word| word.parse().ok())?;
    (number.is_finite() && number >= 0.0).then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviation_is_the_number_after_its_word() {
        assert_eq!(deviation(" scene, deviation: 0.25 units"), Some(0.25));
        assert_eq!(deviation("deviation = 1e-3"), Some(1e-3));
        for none in ["nothing", "deviation -1", "deviation inf", "deviation x"] {
            assert_eq!(deviation(none), None, "{none}");
        }
    }

    #[test]
    fn segments_and_fit_are_lines_of_two_words() {
        let made = |comments: &[&str]| {
            let mut remarks = Remarks::default();
            comments.iter().for_each(|one| remarks.read(one));
            remarks.made()
        };
        let right = Made {
            segments: 12,
            fit: Fit::Circumscribed,
        };
        let fit = " fit circumscribed";
        assert_eq!(made(&[" segments 12", fit]), Some(right));
        assert_eq!(
            made(&["scene segments 3", "segments 12\r", fit]),
            Some(right)
        );
        assert_eq!(made(&["segments 12", fit, "segments 3"]), Some(right));
        for wrong in [
            "segments -3",
            "segments 1e9",
            "segments 99999999999",
            "segments",
            "segments 3 4",
        ] {
            assert_eq!(made(&[wrong, fit]), None, "{wrong}");
        }
        assert_eq!(made(&["segments 12"]), None);
        assert_eq!(made(&["segments 12", "fit tight"]), None);
    }
}
