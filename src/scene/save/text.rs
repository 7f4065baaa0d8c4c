//! The text of a scene file, key by key.

use std::fmt::Write;

use glam::DVec3;

use super::SaveError;
use crate::scene::limits::GREATEST_SCENE_BYTES;
use crate::scene::solid_keys::CAPS;
use crate::solid::Caps;

/// The text of a scene file that is being written.
#[derive(Default)]
pub(super) struct Text {
    text: String,
    /// The header of the table that is being written.
    header: String,
    /// The first number that is not finite.
    not_finite: Option<SaveError>,
}

impl Text {
    /// The keys before all tables.
    pub fn top(&mut self) -> Entry<'_> {
        Entry::new(self)
    }

    /// Begins a table with its header, in brackets.
    pub fn table(&mut self, header: &str) -> Entry<'_> {
        header.clone_into(&mut self.header);
        let separator = if self.text.is_empty() { "" } else { "\n" };
        self.push(format_args!("{separator}{header}\n"));
        Entry::new(self)
    }

    /// That what is written can be read.
    pub fn check(&mut self) -> Result<(), SaveError> {
        match self.not_finite.take() {
            Some(error) => Err(error),
            None if self.text.len() as u64 > GREATEST_SCENE_BYTES => Err(SaveError::TooLarge),
            None => Ok(()),
        }
    }

    /// The whole text.
    pub fn complete(mut self) -> Result<String, SaveError> {
        self.check().map(|()| self.text)
    }

    fn push(&mut self, text: std::fmt::Arguments) {
        // A String accepts everything.
        let _ = self.text.write_fmt(text);
    }
}

/// The keys of a table, one a line or between braces.
pub(in crate::scene) struct Entry<'t> {
    text: &'t mut Text,
    is_inline: bool,
    /// Whether no key is written yet.
    is_first: bool,
}

impl<'t> Entry<'t> {
    fn new(text: &'t mut Text) -> Self {
        Self {
            text,
            is_inline: false,
            is_first: true,
        }
    }

    /// States a number.
    pub fn number(&mut self, key: &'static str, number: f64) {
        self.check(key, &[number]);
        self.value(key, format_args!("{number:?}"));
    }

    /// States a whole number.
    pub fn whole(&mut self, key: &'static str, number: u32) {
        self.value(key, format_args!("{number}"));
    }

    /// States true or false.
    pub fn truth(&mut self, key: &'static str, truth: bool) {
        self.value(key, format_args!("{truth}"));
    }

    /// States three numbers.
    pub fn vector(&mut self, key: &'static str, vector: DVec3) {
        self.check(key, &vector.to_array());
        self.value(key, format_args!("{:?}", vector.to_array()));
    }

    /// States colors, an array of three numbers each.
    pub fn vectors(&mut self, key: &'static str, vectors: &[DVec3]) {
        let rows: Vec<[f64; 3]> = vectors.iter().map(DVec3::to_array).collect();
        self.check(key, rows.as_flattened());
        self.value(key, format_args!("{rows:?}"));
    }

    /// States rows of numbers.
    pub fn rows<const N: usize, const M: usize>(&mut self, key: &'static str, rows: [[f64; N]; M]) {
        self.check(key, rows.as_flattened());
        self.value(key, format_args!("{rows:?}"));
    }

    /// States any text.
    pub fn text(&mut self, key: &'static str, text: &str) {
        self.value(key, format_args!("{}", toml::Value::from(text)));
    }

    /// States a value that is written as in a scene file.
    pub fn verbatim(&mut self, key: &'static str, value: &str) {
        self.value(key, format_args!("{value}"));
    }

    /// States which ends are closed, unless both are, the default.
    pub fn caps(&mut self, caps: Caps) {
        let name = CAPS.iter().find(|&&(_, named)| named == caps);
        if let Some((name, _)) = name.filter(|_| caps != Caps::default()) {
            self.text("caps", name);
        }
    }

    /// States the name of a material, unless it is the default one, which has none.
    pub fn material(&mut self, name: Option<&str>) {
        if let Some(name) = name {
            self.text("material", name);
        }
    }

    /// States the values of columns, if there are any.
    pub fn values<'v>(&mut self, values: impl IntoIterator<Item = (&'v str, f32)>) {
        let values = values.into_iter();
        let values = values.map(|(column, value)| {
            format!("{} = {:?}", toml::Value::from(column), f64::from(value))
        });
        let values: Vec<_> = values.collect();
        if !values.is_empty() {
            self.value("values", format_args!("{{ {} }}", values.join(", ")));
        }
    }

    /// States a table between braces.
    pub fn inline(&mut self, key: &'static str, keys: impl FnOnce(&mut Entry)) {
        self.begin(key);
        self.braces(keys);
        self.end();
    }

    /// States an array of tables between braces.
    pub fn list<T>(
        &mut self,
        key: &'static str,
        items: impl IntoIterator<Item = T>,
        mut keys: impl FnMut(&mut Entry, T),
    ) {
        self.begin(key);
        self.text.push(format_args!("["));
        for (index, item) in items.into_iter().enumerate() {
            let separator = if index > 0 { ", " } else { "" };
            self.text.push(format_args!("{separator}"));
            self.braces(|entry| keys(entry, item));
        }
        self.text.push(format_args!("]"));
        self.end();
    }

    fn value(&mut self, key: &'static str, value: std::fmt::Arguments) {
        self.begin(key);
        self.text.push(value);
        self.end();
    }

    fn begin(&mut self, key: &'static str) {
        let separator = match self.is_inline && !self.is_first {
            true => ", ",
            false => "",
        };
        self.is_first = false;
        self.text.push(format_args!("{separator}{key} = "));
    }

    fn end(&mut self) {
        if !self.is_inline {
            self.text.push(format_args!("\n"));
        }
    }

    fn braces(&mut self, keys: impl FnOnce(&mut Entry)) {
        self.text.push(format_args!("{{ "));
        keys(&mut Entry {
            text: &mut *self.text,
            is_inline: true,
            is_first: true,
        });
        self.text.push(format_args!(" }}"));
    }

    fn check(&mut self, key: &'static str, numbers: &[f64]) {
        let wrong = numbers.iter().find(|number| !number.is_finite());
        if let Some(&number) = wrong
            && self.text.not_finite.is_none()
        {
            let place = match self.text.header.as_str() {
                "" => key.to_owned(),
                header => format!("{key} of {header}"),
            };
            self.text.not_finite = Some(SaveError::NotFinite { place, number });
        }
    }
}
