//! The state of queries: rays in f64, and the hits so far.
//!
//! It travels through Embree in the query context. Embree's f32 rays only find candidates; what
//! is a hit, and which is nearer, is decided here in f64, for single rays ([`Query`]) and for
//! packets ([`Packet`]).

mod found;
mod levels;
mod packet;
mod position;
mod row;
mod single;

pub(crate) use found::{Found, Nearest, QueryMode, SolidRef, SolidSlot};
pub(crate) use packet::Packet;
pub(crate) use single::Query;
