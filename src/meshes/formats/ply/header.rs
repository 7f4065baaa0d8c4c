//! The header of a PLY file: its encoding, and the elements with their properties.

use crate::meshes::error::MeshError;
use crate::meshes::reading::remarks::Remarks;
use crate::meshes::reading::text::{before, shown, words};
use crate::scene::{MOST_PLY_HEADER_BYTES, MOST_PLY_PROPERTIES};

/// The encoding of the elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The kind of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// The names of the kinds in the first version of the format and in later ones.
const KINDS: [(&str, Kind); 16] = [
    ("char", Kind::I8),
    ("int8", Kind::I8),
    ("uchar", Kind::U8),
    ("uint8", Kind::U8),
    ("short", Kind::I16),
    ("int16", Kind::I16),
    ("ushort", Kind::U16),
    ("uint16", Kind::U16),
    ("int", Kind::I32),
    ("int32", Kind::I32),
    ("uint", Kind::U32),
    ("uint32", Kind::U32),
    ("float", Kind::F32),
    ("float32", Kind::F32),
    ("double", Kind::F64),
    ("float64", Kind::F64),
];

/// A property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    /// The kind of the list's length, if the property is a list.
    pub length: Option<Kind>,
    pub kind: Kind,
}

/// A kind of element, with `count` records in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    /// Its line in the header.
    pub line: u64,
    pub properties: Vec<Property>,
}

/// Everything before the elements.
#[derive(Debug)]
pub(super) struct Header {
    pub form: Form,
    pub elements: Vec<Element>,
    pub remarks: Remarks,
    /// Bytes of the header.
    pub bytes: usize,
    /// Lines of the header.
    pub lines: u64,
}

impl Kind {
    /// Bytes of a number in a binary file.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn named(word: &[u8]) -> Result<Self, String> {
        let found = KINDS.iter().find(|(name, _)| name.as_bytes() == word);
        found.map(|(_, kind)| *kind).ok_or_else(|| {
            let names = KINDS.map(|(name, _)| name).join(", ");
            format!("{} is not a number type: use one of {names}", shown(word))
        })
    }
}

impl Element {
    /// The least size of a record in a binary file.
    pub fn least_bytes(&self) -> usize {
        let kinds = self.properties.iter();
        let kinds = kinds.map(|property| property.length.unwrap_or(property.kind));
        kinds.map(Kind::size).sum()
    }

    /// The place of a property.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|one| one.name == name)
    }
}

impl Header {
    /// Reads the header at the beginning of a file.
    pub fn new(bytes: &[u8]) -> Result<Self, MeshError> {
        let mut header = Self {
            form: Form::Ascii,
            elements: Vec::new(),
            remarks: Remarks::default(),
            bytes: 0,
            lines: 0,
        };
        let mut form = None;
        let mut properties = 0;
        loop {
            let rest = &bytes[header.bytes..];
            header.lines += 1;
            let wrong = |message: String| MeshError::in_line(header.lines, message);
            let Some(length) = rest.iter().position(|&byte| byte == b'\n') else {
                return Err(wrong(
                    "the header does not end: end_header is missing".into(),
                ));
            };
            header.bytes += length + 1;
            if header.bytes > MOST_PLY_HEADER_BYTES {
                return Err(wrong(format!(
                    "the header has more than {MOST_PLY_HEADER_BYTES} bytes"
                )));
            }
            let line = &rest[..length];
            let mut words = words(before(line, b"{#"));
            let first = words.next();
            if header.lines == 1 {
                match first {
                    Some(b"ply") => continue,
                    _ => return Err(wrong("a PLY file must begin with the line \"ply\"".into())),
                }
            }
            match first {
                Some(b"format") => {
                    form = Some(form_of(words.next().unwrap_or_default()).map_err(wrong)?);
                }
                Some(key @ (b"comment" | b"obj_info")) => {
                    let text = &line.trim_ascii_start()[key.len()..];
                    header.remarks.read(&String::from_utf8_lossy(text));
                }
                Some(b"element") => {
                    let element = element(&mut words, header.lines).map_err(wrong)?;
                    let same = header.elements.iter().find(|one| one.name == element.name);
                    if let Some(same) = same {
                        let name = shown(element.name.as_bytes());
                        let line = same.line;
                        let message = format!("line {line} already declares an element {name}");
                        return Err(wrong(message));
                    }
                    header.elements.push(element);
                }
                Some(b"property") => {
                    properties += 1;
                    if properties > MOST_PLY_PROPERTIES {
                        let message =
                            format!("the header has more than {MOST_PLY_PROPERTIES} properties");
                        return Err(wrong(message));
                    }
                    let property = property(&mut words).map_err(wrong)?;
                    let Some(element) = header.elements.last_mut() else {
                        return Err(wrong("a property needs an element before it".into()));
                    };
                    if element.position(&property.name).is_some() {
                        let name = shown(property.name.as_bytes());
                        return Err(wrong(format!("the element already has a property {name}")));
                    }
                    element.properties.push(property);
                }
                Some(b"end_header") => break,
                None => {}
                Some(other) => {
                    return Err(wrong(format!(
                        "{} is not a header keyword: use format, comment, obj_info, element, property or end_header",
                        shown(other)
                    )));
                }
            }
        }
        header.form = form
            .ok_or_else(|| MeshError::in_line(header.lines, "the header has no line \"format\""))?;
        header.check()?;
        Ok(header)
    }

    /// Rejects elements without properties: the size of the file would not bound their number.
    fn check(&self) -> Result<(), MeshError> {
        let mut elements = self.elements.iter();
        let empty = elements.find(|one| one.properties.is_empty() && one.count > 0);
        empty.map_or(Ok(()), |element| {
            let (name, count) = (shown(element.name.as_bytes()), element.count);
            let message = format!(
                "the element {name} has {count} records but no properties: declare a property"
            );
            Err(MeshError::in_line(element.line, message))
        })
    }
}

fn form_of(word: &[u8]) -> Result<Form, String> {
    match word {
        b"ascii" => Ok(Form::Ascii),
        b"binary_little_endian" => Ok(Form::LittleEndian),
        b"binary_big_endian" => Ok(Form::BigEndian),
        _ => Err(format!(
            "{} is not a PLY format: use ascii, binary_little_endian or binary_big_endian",
            shown(word)
        )),
    }
}

fn element<'a>(words: &mut impl Iterator<Item = &'a [u8]>, line: u64) -> Result<Element, String> {
    let name = words.next().ok_or("an element needs a name and a number")?;
    let count = words.next().ok_or("an element needs a number")?;
    let number = std::str::from_utf8(count).ok();
    let number = number.and_then(|count| count.parse().ok());
    Ok(Element {
        name: String::from_utf8_lossy(name).into_owned(),
        count: number.ok_or_else(|| {
            let count = shown(count);
            format!("the number of records is {count}: it must be a whole number, 0 or more")
        })?,
        line,
        properties: Vec::new(),
    })
}

fn property<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Result<Property, String> {
    let mut next = || words.next().ok_or("a property needs a type and a name");
    let mut kind = next()?;
    let mut length = None;
    if kind == b"list" {
        let count = Kind::named(next()?)?;
        if matches!(count, Kind::F32 | Kind::F64) {
            return Err("the length of a list must be a whole number".to_owned());
        }
        length = Some(count);
        kind = next()?;
    }
    Ok(Property {
        kind: Kind::named(kind)?,
        length,
        name: String::from_utf8_lossy(next()?).into_owned(),
    })
}
