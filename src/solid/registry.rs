//! The list of the kinds of solids. Everything with an entry for each kind is generated from
//! it.
//!
//! A new kind is a row here and a type with the traits that each subsystem requires; the
//! compiler reports missing traits. `docs/architecture.md` has the recipe.

use std::fmt;
use std::str::FromStr;

/// Calls a macro with the list of the kinds of solids, without the set operations.
///
/// `for_each_solid!(callback arguments)` becomes `callback! { arguments rows }`. A row is
///
/// ```text
/// { Type name list code "description" }
/// ```
///
/// - `Type`: the type, and the variant of [`SolidKind`] and [`AnySolid`];
/// - `name`: the name in files and tables, a key of scene files;
/// - `list`: the name of a list of such solids;
/// - `code`: the number in the C interface and its header;
/// - `"description"`: a noun phrase for the docs.
///
/// The order is that of the primitive numbers of a scene file, so new rows are appended.
/// Callbacks match the columns that they use and leave the others to `$($rest:tt)*`.
///
/// ```
/// macro_rules! names {
///     ($({ $type:ident $name:ident $($rest:tt)* })*) => { [$(stringify!($name)),*] };
/// }
/// assert_eq!(cyltrace::for_each_solid!(names)[0], "cylinder");
/// ```
///
/// [`AnySolid`]: crate::solid::AnySolid
/// [`SolidKind`]: crate::solid::SolidKind
#[macro_export]
macro_rules! for_each_solid {
    (@ [$($callback:tt)+] $($arguments:tt)*) => {
        $($callback)+! {
            $($arguments)*
            { Cylinder cylinder cylinders 0 "A circular cylinder." }
            { Sphere sphere spheres 3 "A ball." }
            { Cuboid cuboid cuboids 4 "A box that may be turned." }
            { Cone cone cones 1 "A part of a circular cone between two disks." }
            { RoundedCone rounded_cone rounded_cones 2 "Two balls and what is between them." }
            { Disk disk disks 5 "A flat disk." }
        }
    };
    ($callback:ident $($arguments:tt)*) => {
        $crate::for_each_solid! { @ [$callback] $($arguments)* }
    };
}

/// Evaluates an expression for the solid in an [`AnySolid`](crate::solid::AnySolid) of any
/// kind.
///
/// `with_solid!(any, solid => solid)` dispatches a trait that every kind implements, as a trait
/// object; so does a call in place of the last `solid`.
///
/// ```
/// use cyltrace::solid::{AnySolid, ConvexSolid, Sphere};
///
/// let any = AnySolid::from(Sphere::new(glam::DVec3::X, 2.0).unwrap());
/// assert_eq!(cyltrace::with_solid!(&any, solid => ConvexSolid::size(solid)), 4.0);
/// ```
#[macro_export]
macro_rules! with_solid {
    (@arms $any:expr, $solid:ident => $what:expr; $({ $type:ident $($rest:tt)* })*) => {
        match $any {
            $($crate::solid::AnySolid::$type($solid) => $what,)*
        }
    };
    ($any:expr, $solid:ident => $what:expr) => {
        $crate::for_each_solid!(@ [$crate::with_solid] @arms $any, $solid => $what;)
    };
}

/// Evaluates an expression with the type of a [`SolidKind`](crate::solid::SolidKind). The type
/// of every set operation is [`Composition`](crate::solid::Composition).
///
/// ```
/// use cyltrace::solid::SolidKind;
///
/// let bytes = cyltrace::with_solid_kind!(SolidKind::Sphere, S => size_of::<S>());
/// assert_eq!(bytes, size_of::<cyltrace::solid::Sphere>());
/// ```
#[macro_export]
macro_rules! with_solid_kind {
    (@arms $kind:expr, $name:ident => $what:expr; $({ $type:ident $($rest:tt)* })*) => {
        match $kind {
            $($crate::solid::SolidKind::$type => {
                type $name = $crate::solid::$type;
                $what
            })*
            // The set operations.
            _ => {
                type $name = $crate::solid::Composition;
                $what
            }
        }
    };
    ($kind:expr, $name:ident => $what:expr) => {
        $crate::for_each_solid!(@ [$crate::with_solid_kind] @arms $kind, $name => $what;)
    };
}

macro_rules! kinds {
    ($({ $type:ident $name:ident $list:ident $code:literal $description:literal })*) => {
        /// The kinds of solids; [`SolidKind::name`] is the `solid` column of `trace`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum SolidKind {
            $(#[doc = $description] $type,)*
            /// The points in any of several solids, see [`Composition`](super::Composition).
            Union,
            /// The points in all of several solids.
            Intersection,
            /// The points in a solid and in none of others.
            Difference,
        }

        impl SolidKind {
            /// The kinds without the set operations.
            pub const SIMPLE: &[Self] = &[$(Self::$type),*];
            /// The kinds that name lists: all set operations share one list.
            pub const LISTS: &[Self] = &[$(Self::$type,)* Self::Union];
            /// The set operations.
            pub const OPERATIONS: &[Self] = &[Self::Union, Self::Intersection, Self::Difference];

            /// The name in files and tables.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$type => stringify!($name),)*
                    Self::Union => "union",
                    Self::Intersection => "intersection",
                    Self::Difference => "difference",
                }
            }

            /// The plural of the name.
            #[must_use]
            pub fn plural(self) -> &'static str {
                match self {
                    $(Self::$type => stringify!($list),)*
                    Self::Union => "unions",
                    Self::Intersection => "intersections",
                    Self::Difference => "differences",
                }
            }

            /// The number in the C interface.
            #[must_use]
            pub const fn code(self) -> u32 {
                match self {
                    $(Self::$type => $code,)*
                    Self::Union => 6,
                    Self::Intersection => 7,
                    Self::Difference => 8,
                }
            }
        }
    };
}

for_each_solid!(kinds);

impl SolidKind {
    /// All kinds, the set operations last.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::SIMPLE.iter().chain(Self::OPERATIONS).copied()
    }
}

impl fmt::Display for SolidKind {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// A name that is not that of a kind of solid.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no solid {0:?}")]
pub struct UnknownSolid(pub String);

impl FromStr for SolidKind {
    type Err = UnknownSolid;

    fn from_str(name: &str) -> Result<Self, UnknownSolid> {
        let kind = Self::all().find(|kind| kind.name() == name);
        kind.ok_or_else(|| UnknownSolid(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn names_and_codes_are_different_and_names_are_read() {
        let kinds: Vec<SolidKind> = SolidKind::all().collect();
        assert_eq!(kinds.len(), SolidKind::Difference as usize + 1);
        let codes: HashSet<u32> = kinds.iter().map(|kind| kind.code()).collect();
        assert_eq!(codes.len(), kinds.len());
        for kind in kinds {
            assert_eq!(kind.name().parse(), Ok(kind));
        }
        let unknown = UnknownSolid("pyramid".to_owned());
        assert_eq!("pyramid".parse::<SolidKind>(), Err(unknown));
    }
}
