//! The limits of input, in one place; `docs/reliability.md` lists them in a table. The
//! tracer's proofs depend on the limits of placements. Limits of numbers are defined
//! elsewhere: those of coordinates and radii are `Cylinder::GREATEST` and
//! `Cylinder::LEAST`, those of rays [`crate::math::GREATEST_ORIGIN`] and
//! [`crate::math::DIRECTION_SIZES`].

use crate::math::power_of_two;

/// Most nested placements. A level takes up to 12 kB of a thread's stack while a
/// single ray traverses it, and up to 65 kB for a packet of rays; at great depths
/// the tracer traces rays singly.
pub const GREATEST_DEPTH: usize = 64;

/// The greatest `‖L‖ ‖L⁻¹‖` of a placement (Frobenius norms), 2^27: more flattening
/// would leave less than half of the digits of f64, and enlarge the bounding boxes
/// too much.
pub const GREATEST_CONDITION: f64 = power_of_two(27);

/// The greatest factor by which all placements on a path together may stretch
/// or shrink, 2^64: beyond it the solvers' products could leave f64.
pub const GREATEST_STRETCH: f64 = power_of_two(64);

/// Most pixels of a picture, 2^28 (16384 x 16384): its film takes 3 GiB, and
/// twice that while tiles are assembled.
pub const GREATEST_PIXELS: u64 = 1 << 28;

/// Most bytes of a scene file: 64 MiB, about 600 000 solids. Longer lists belong in
/// tables, which are read a row at a time.
pub const GREATEST_SCENE_BYTES: u64 = 64 << 20;

/// Most threads: more than any machine has, few enough to start.
pub const GREATEST_THREADS: usize = 1024;

/// Most rays of a class in a check: several hours.
pub const GREATEST_RAYS: u64 = 1_000_000_000;

/// Most samples of a pixel: the numbers of samples of the largest picture fit in u64
/// with room to spare, and more than 2^20 change no 8-bit color.
pub const GREATEST_SAMPLES: u32 = 1 << 20;

/// Most segment numbers of one check: all rays are repeated for each.
pub const MOST_SEGMENT_NUMBERS: usize = 64;

/// Most violations that a check lists: about a hundred bytes each, and more than anyone reads.
pub const MOST_LISTED_VIOLATIONS: u64 = 1_000_000;

/// Most cases of a family in `stress` and `bench accuracy`: several hours.
pub const GREATEST_CASES: u64 = 10_000_000;

/// Most rays of a kind that `bench` traces: with their hits they take several gigabytes.
pub const GREATEST_TIMED_RAYS: u64 = 10_000_000;

/// Most samples of a time in `bench`: confidence intervals are stable with a thousand.
pub const GREATEST_ROUNDS: u64 = 100_000;

/// Most bytes of a file with a picture, 2^32: a picture of 2^28 pixels in OpenEXR has at most
/// as many, alpha included.
pub const MOST_PICTURE_BYTES: u64 = 1 << 32;

/// Most bytes of a mesh file, 2^32: about 30 million triangles of OBJ, 80 million of binary
/// STL.
pub const MOST_MESH_BYTES: u64 = 1 << 32;

/// The greatest size of a mesh's coordinate, that of a cylinder's.
pub const GREATEST_MESH_COORDINATE: f64 = crate::solid::Cylinder::GREATEST;

/// Most bytes of the header of a PLY file, 2^20: headers in use have less than a thousand.
pub const MOST_PLY_HEADER_BYTES: usize = 1 << 20;

/// Most properties of all elements of a PLY file together, 2^12: files in use have less than
/// a hundred.
pub const MOST_PLY_PROPERTIES: usize = 1 << 12;

/// Most corners of a face of a mesh, 2^20: a face is stored whole before it is split.
pub const MOST_FACE_CORNERS: usize = 1 << 20;

/// Most bytes of a part of a 3MF file, unpacked, 2^30: about 16 million beams.
#[cfg(feature = "three-mf")]
pub(super) const MOST_PART_BYTES: u64 = 1 << 30;

/// Most elements and texts of a part of a 3MF file, 2^26: each takes about 100 bytes while
/// the part is read.
pub(super) const MOST_XML_NODES: u32 = 1 << 26;

/// Most attributes of an element of a 3MF file. The format defines at most 12 for one; the
/// parser's time is quadratic in them.
pub(super) const MOST_ATTRIBUTES: usize = 256;

/// Most prefixes of namespaces that a part of a 3MF file declares: the parser searches all
/// of them for each name.
pub(super) const MOST_NAMESPACES: usize = 256;

/// Most placed objects of a 3MF file, 2^20: nested components multiply, so a small file may
/// place very many.
pub(super) const MOST_PLACES: usize = 1 << 20;

/// Most bytes of a table or a neuron, 2^40: enough for 10^10 rows.
pub const GREATEST_TABLE_BYTES: u64 = 1 << 40;

/// Most bytes of a row of a table or a neuron, 2^24. A row is read as a whole, so a
/// line without an end takes this much memory before it is rejected.
pub const LONGEST_LINE: usize = 1 << 24;

/// Most cells of a row, 2^14, the number of columns of an Excel sheet.
pub const MOST_COLUMNS: usize = 1 << 14;

/// Most bytes of a cell with a number, 2^16: the exact digits of any f64 take 1100.
pub const LONGEST_NUMBER: usize = 1 << 16;

/// How long a named pipe may have no writer: long enough for a shell to start one, short
/// enough that the error comes before a user gives up.
pub const PIPE_PATIENCE: std::time::Duration = std::time::Duration::from_secs(5);
