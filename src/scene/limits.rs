//! How far a scene may go. The tracer's proofs rest on the limits of
//! placements.

use crate::math::power_of_two;

/// Most placements inside each other. A level takes up to 12 kB of a thread's
/// stack while a ray passes it, and up to 65 kB while a packet of rays does; deep
/// down the tracer gives packets up.
pub const GREATEST_DEPTH: usize = 64;

/// The greatest `‖L‖ ‖L⁻¹‖` of a placement (Frobenius norms), 2^27: flattening
/// by more would leave less than half of the digits of f64, and grow the boxes
/// without end.
pub const GREATEST_CONDITION: f64 = power_of_two(27);

/// The greatest factor by which all placements on a path together may stretch
/// or shrink, 2^64: beyond it the solvers' products could leave f64.
pub const GREATEST_STRETCH: f64 = power_of_two(64);

/// Most pixels of a picture, 2^28 (16384 x 16384): its film takes 3 GiB, and
/// twice that while tiles are put together.
pub const GREATEST_PIXELS: u64 = 1 << 28;

/// Most bytes of a table or a neuron, 2^40: enough for 10^10 rows.
pub const GREATEST_TABLE_BYTES: u64 = 1 << 40;

/// Most bytes of a row of a table or a neuron, 2^24. A row is read as a whole, so
/// that this is what a line without an end takes before it is refused.
pub const LONGEST_LINE: usize = 1 << 24;

/// Most cells of a row, 2^14: as many columns as a sheet of Excel has.
pub const MOST_COLUMNS: usize = 1 << 14;

/// Most bytes of a cell that holds a number, 2^16.
pub const LONGEST_NUMBER: usize = 1 << 16;

/// How long a named pipe may be without a program that writes to it.
pub const PIPE_PATIENCE: std::time::Duration = std::time::Duration::from_secs(5);
