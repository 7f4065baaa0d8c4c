//! What callbacks work for: the states of queries.

/// What callbacks read and write on behalf of rays: the type itself is the
/// state of one ray. A scene knows both states, for a query of either kind.
pub trait Query: 'static {
    /// The state of a packet of rays; [`NoPackets`] where none are traced.
    type Packet: 'static;
}

/// The state of packets that are never traced. There is no value of it, so that
/// a callback that would get one has nothing to do:
/// `match *packet {}`.
#[derive(Clone, Copy, Debug)]
pub enum NoPackets {}

/// Nothing to read or write.
impl Query for () {
    type Packet = ();
}

/// Hits that a filter function collects, which it does for single rays.
impl<H: 'static> Query for Vec<H> {
    type Packet = NoPackets;
}
