//! The elements of a PLY file, one record after the other.
//!
//! In an ASCII file a record begins on a new line and may span several. `{` and `#` begin a
//! comment, as in the format's first description, and a `\` at the end of a line is ignored.
//! In a binary file each record directly follows the previous one.

use super::header::{Element, Form, Header, Kind, Property};
use crate::meshes::error::{MeshError, MeshPlace};
use crate::meshes::reading::text::{before, number, shown, words};

/// The content after the header.
pub(super) struct Data<'a> {
    form: Form,
    /// The unread bytes.
    rest: &'a [u8],
    /// The unread words of the current line, the next one last.
    words: Vec<&'a [u8]>,
    line: u64,
    /// Records of the current element that were begun.
    count: u64,
    numbers: Vec<f64>,
}

impl<'a> Data<'a> {
    pub fn new(header: &Header, bytes: &'a [u8]) -> Self {
        Self {
            form: header.form,
            rest: &bytes[header.bytes..],
            words: Vec::new(),
            line: header.lines,
            count: 0,
            numbers: Vec::new(),
        }
    }

    /// Begins an element, and rejects more records than the rest of a binary file can contain.
    pub fn check_length(&mut self, element: &Element) -> Result<(), MeshError> {
        self.count = 0;
        let needed = u128::from(element.count) * element.least_bytes() as u128;
        let left = self.rest.len();
        if self.form == Form::Ascii || needed <= left as u128 {
            return Ok(());
        }
        let (name, count) = (shown(element.name.as_bytes()), element.count);
        let message = format!(
            "{count} records of the element {name} take at least {needed} bytes, but the file has only {left} left"
        );
        Err(MeshError::in_line(element.line, message))
    }

    /// Reads the next record of an element. Returns its place and the numbers of the
    /// properties that `is_wanted` selects by position and length.
    pub fn record(
        &mut self,
        element: &Element,
        is_wanted: impl Fn(usize, usize) -> Result<bool, String>,
    ) -> Result<(MeshPlace, &[f64]), MeshError> {
        let place = match self.form {
            Form::Ascii => {
                self.next_line(element)?;
                MeshPlace::Line(self.line)
            }
            _ => MeshPlace::Record(place_name(element), self.count),
        };
        self.count += 1;
        self.numbers.clear();
        for (at, property) in element.properties.iter().enumerate() {
            let length = match property.length {
                None => 1,
                Some(kind) => self.length(element, property, kind, place)?,
            };
            match is_wanted(at, length).map_err(|message| MeshError::new(place, message))? {
                true => {
                    for _ in 0..length {
                        let number = self.number(element, property.kind, place)?;
                        self.numbers.push(number);
                    }
                }
                false => self.skip(element, property.kind, length, place)?,
            }
        }
        match self.words.last() {
            Some(word) => Err(MeshError::in_line(
                self.line,
                format!(
                    "unexpected {} after the last number of the element {}",
                    shown(word),
                    shown(element.name.as_bytes())
                ),
            )),
            None => Ok((place, &self.numbers)),
        }
    }

    /// Rejects words after the last record of an ASCII file.
    pub fn check_end(&mut self) -> Result<(), MeshError> {
        match self.form == Form::Ascii && self.fill() {
            true => {
                let message = "the file continues after the last element that the header declares";
                Err(MeshError::in_line(self.line, message))
            }
            false => Ok(()),
        }
    }

    /// Reads the words of the next line that has any. Returns whether such a line exists.
    fn fill(&mut self) -> bool {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&byte| byte == b'\n');
            let (line, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
            self.rest = rest.get(1..).unwrap_or_default();
            self.line += 1;
            let content = before(line, b"{#").trim_ascii_end();
            let content = content.strip_suffix(b"\\").unwrap_or(content);
            self.words.extend(words(content));
            self.words.reverse();
            if !self.words.is_empty() {
                return true;
            }
        }
        false
    }

    fn next_line(&mut self, element: &Element) -> Result<(), MeshError> {
        match self.fill() {
            true => Ok(()),
            false => Err(self.ended(element, MeshPlace::Line(self.line))),
        }
    }

    /// The error that the file ends before an element does.
    fn ended(&self, element: &Element, place: MeshPlace) -> MeshError {
        let (read, count) = (self.count, element.count);
        let name = shown(element.name.as_bytes());
        let message = format!(
            "the file ends within the element {name}: the header declares {count} records, but only {read} begin"
        );
        MeshError::new(place, message)
    }

    /// The length of a list.
    fn length(
        &mut self,
        element: &Element,
        property: &Property,
        kind: Kind,
        place: MeshPlace,
    ) -> Result<usize, MeshError> {
        let length = self.number(element, kind, place)?;
        match length >= 0.0 && length.fract() == 0.0 && length <= f64::from(u32::MAX) {
            true => Ok(length as usize),
            false => Err(MeshError::new(
                place,
                format!(
                    "the length of the list {} is {length:?}: it must be a whole number, 0 or more",
                    shown(property.name.as_bytes())
                ),
            )),
        }
    }

    fn skip(
        &mut self,
        element: &Element,
        kind: Kind,
        length: usize,
        place: MeshPlace,
    ) -> Result<(), MeshError> {
        if self.form == Form::Ascii {
            for _ in 0..length {
                self.number(element, kind, place)?;
            }
            return Ok(());
        }
        let rest = length.checked_mul(kind.size());
        let rest = rest.and_then(|bytes| self.rest.get(bytes..));
        self.rest = rest.ok_or_else(|| self.ended(element, place))?;
        Ok(())
    }

    fn number(
        &mut self,
        element: &Element,
        kind: Kind,
        place: MeshPlace,
    ) -> Result<f64, MeshError> {
        if self.form == Form::Ascii {
            if self.words.is_empty() {
                self.next_line(element)?;
            }
            let word = self.words.pop().unwrap_or_default();
            return number(word).ok_or_else(|| {
                MeshError::in_line(self.line, format!("{} is not a number", shown(word)))
            });
        }
        let Some((bytes, rest)) = self.rest.split_at_checked(kind.size()) else {
            return Err(self.ended(element, place));
        };
        self.rest = rest;
        Ok(decoded(bytes, kind, self.form == Form::BigEndian))
    }
}

/// The name of an element's records in messages.
fn place_name(element: &Element) -> &'static str {
    match element.name.as_str() {
        "vertex" => "vertex",
        "face" => "face",
        _ => "record",
    }
}

/// Decodes a binary number of a kind from all of its bytes.
fn decoded(bytes: &[u8], kind: Kind, is_big_endian: bool) -> f64 {
    let mut ordered = [0; 8];
    let ordered = &mut ordered[..bytes.len()];
    ordered.copy_from_slice(bytes);
    if is_big_endian {
        ordered.reverse();
    }
    match *ordered {
        [a] if kind == Kind::I8 => f64::from(a as i8),
        [a] => f64::from(a),
        [a, b] if kind == Kind::I16 => f64::from(i16::from_le_bytes([a, b])),
        [a, b] => f64::from(u16::from_le_bytes([a, b])),
        [a, b, c, d] => match kind {
            Kind::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Kind::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::from(u32::from_le_bytes([a, b, c, d])),
        },
        [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        _ => unreachable!("numbers have 1, 2, 4 or 8 bytes"),
    }
}
