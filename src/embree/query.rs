//! The states of queries, which callbacks read and write.

/// The state of a query, which callbacks read and write. The type itself is the state of one
/// ray, and it names the state of a packet. A scene supports queries with both.
pub trait Query: 'static {
    /// The state of a packet of rays; [`NoPackets`] if packets are never traced.
    type Packet: 'static;
}

/// The state of packets that are never traced. It has no values, so a callback that receives
/// one is `match *packet {}`.
#[derive(Clone, Copy, Debug)]
pub enum NoPackets {}

/// No state.
impl Query for () {
    type Packet = ();
}

/// The hits that a filter function collects, for single rays only.
impl<H: 'static> Query for Vec<H> {
    type Packet = NoPackets;
}
