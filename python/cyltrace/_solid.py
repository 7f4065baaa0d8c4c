"""Solids by themselves, for set operations."""

from __future__ import annotations

import numpy.typing as npt

from . import _core
from ._arrays import real, vector

#: Scene files nest about as deeply.
_GREATEST_DEPTH = 25


class Solid:
    """A closed solid, or what set operations make of some.

    ``a | b`` is the union, ``a & b`` the intersection and ``a - b`` the difference. The
    operations are regularized, as in every solid modeler: they apply to interiors, and the
    result is closed. So ``a - a`` is empty, and solids that touch in a face have no face
    between them in their union. Add the result to a scene by :meth:`Prototype.add`.

    Examples
    --------
    >>> from cyltrace import Solid
    >>> block = Solid.cuboid([0, 0, 0], [2, 1, 1])
    >>> drilled = block - Solid.cylinder([0, 0, -1], [0, 0, 1], 0.5)
    >>> drilled
    <cyltrace.Solid: difference of 2 solids>
    >>> drilled.contains([1.5, 0, 0]), drilled.contains([0, 0, 0])
    (True, False)
    """

    def __init__(self, core: _core.Solid) -> None:
        if not isinstance(core, _core.Solid):
            raise TypeError("solids are made by Solid.cylinder, Solid.sphere and the like")
        if core.depth() > _GREATEST_DEPTH:
            raise ValueError(
                f"set operations are nested more than {_GREATEST_DEPTH} levels deep: "
                "name several operands at once, as in Solid.union(a, b, c)"
            )
        self._core = core

    @staticmethod
    def cylinder(p0: npt.ArrayLike, p1: npt.ArrayLike, radius: float) -> Solid:
        """The closed cylinder between two points."""
        return Solid(_core.Solid.cylinder(vector("p0", p0), vector("p1", p1), float(radius)))

    @staticmethod
    def cone(p0: npt.ArrayLike, p1: npt.ArrayLike, radius0: float, radius1: float) -> Solid:
        """The closed cone with these radii at its ends; one may be zero."""
        ends = (vector("p0", p0), vector("p1", p1))
        return Solid(_core.Solid.cone(*ends, float(radius0), float(radius1)))

    @staticmethod
    def rounded_cone(p0: npt.ArrayLike, p1: npt.ArrayLike, radius0: float, radius1: float) -> Solid:
        """The convex hull of two balls."""
        ends = (vector("p0", p0), vector("p1", p1))
        return Solid(_core.Solid.rounded_cone(*ends, float(radius0), float(radius1)))

    @staticmethod
    def sphere(center: npt.ArrayLike, radius: float) -> Solid:
        """The ball around a point."""
        return Solid(_core.Solid.sphere(vector("center", center), float(radius)))

    @staticmethod
    def cuboid(
        center: npt.ArrayLike,
        half_widths: npt.ArrayLike,
        quaternion: npt.ArrayLike = (0.0, 0.0, 0.0, 1.0),
    ) -> Solid:
        """The box with these half widths along its own axes, turned by a quaternion
        ``x, y, z, w``."""
        turn = vector("quaternion", real("quaternion", quaternion), 4)
        core = _core.Solid.cuboid(
            vector("center", center), vector("half_widths", half_widths), turn
        )
        return Solid(core)

    @staticmethod
    def union(*solids: Solid) -> Solid:
        """The points of any of the solids."""
        return Solid(_core.Solid.union(_operands(solids)))

    @staticmethod
    def intersection(*solids: Solid) -> Solid:
        """The points that all of the solids have in common."""
        return Solid(_core.Solid.intersection(_operands(solids)))

    @staticmethod
    def difference(*solids: Solid) -> Solid:
        """The points of the first solid that are in none of the others."""
        return Solid(_core.Solid.difference(_operands(solids)))

    def contains(self, point: npt.ArrayLike) -> bool:
        """Whether the closed solid contains a point."""
        return self._core.contains(vector("point", point))

    def __or__(self, other: Solid) -> Solid:
        return Solid.union(self, other) if isinstance(other, Solid) else NotImplemented

    def __and__(self, other: Solid) -> Solid:
        return Solid.intersection(self, other) if isinstance(other, Solid) else NotImplemented

    def __sub__(self, other: Solid) -> Solid:
        return Solid.difference(self, other) if isinstance(other, Solid) else NotImplemented

    def __repr__(self) -> str:
        return repr(self._core)


def _operands(solids: tuple[Solid, ...]) -> list[_core.Solid]:
    if not solids:
        raise ValueError("a set operation needs at least one solid")
    return [solid._core for solid in solids]
