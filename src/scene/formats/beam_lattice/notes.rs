//! Notes on a 3MF file: ignored content, violations of the specification, and content that
//! other programs may read differently.

use super::element::Element;

/// The most objects that a note names; it counts the others.
const MOST_NAMED: usize = 8;

/// The notes on a file, each listed once with its objects.
#[derive(Default)]
pub(super) struct Notes {
    list: Vec<Note>,
}

struct Note {
    /// The file, and the line of the first element concerned.
    place: String,
    text: String,
    /// The ids of the objects concerned; empty for a note on the file.
    objects: Vec<String>,
}

/// The notes on an object.
pub(super) struct ObjectNotes<'n, 'a, 'input> {
    notes: &'n mut Notes,
    object: &'n Element<'a, 'input>,
}

impl Notes {
    /// Access to the notes on an object.
    pub fn of<'n, 'a, 'input>(
        &'n mut self,
        object: &'n Element<'a, 'input>,
    ) -> ObjectNotes<'n, 'a, 'input> {
        let notes = self;
        ObjectNotes { notes, object }
    }

    /// Adds a note on the file.
    pub fn add(&mut self, element: &Element, text: &str) {
        self.list.push(Note {
            place: element.place_text(),
            text: text.to_owned(),
            objects: Vec::new(),
        });
    }

    /// A line for each note.
    pub fn into_lines(self) -> Vec<String> {
        let lines = self.list.into_iter().map(|note| {
            let Note {
                place,
                text,
                objects,
            } = note;
            let named = objects.iter().take(MOST_NAMED).cloned();
            let named = named.collect::<Vec<_>>().join(", ");
            match objects.len() {
                0 => format!("{place}: {text}"),
                1 => format!("{place}: object {named}: {text}"),
                2..=MOST_NAMED => format!("{place}: objects {named}: {text}"),
                count => {
                    let more = count - MOST_NAMED;
                    format!("{place}: objects {named} and {more} more: {text}")
                }
            }
        });
        lines.collect()
    }
}

impl ObjectNotes<'_, '_, '_> {
    /// Adds a note on the object, unless it has that note already.
    pub fn add(&mut self, text: &str) {
        let id = self.object.attribute("id").unwrap_or_default().to_owned();
        let list = &mut self.notes.list;
        match list.iter_mut().find(|note| note.text == text) {
            Some(note) if note.objects.contains(&id) => {}
            Some(note) => note.objects.push(id),
            None => list.push(Note {
                place: self.object.place_text(),
                text: text.to_owned(),
                objects: vec![id],
            }),
        }
    }
}
