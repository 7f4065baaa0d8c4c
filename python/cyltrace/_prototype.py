"""Solids from arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, Ints, common_length, numbers, rows
from ._placements import NO_TURN, composed, stated
from ._polylines import pairs
from ._rows import Rows
from ._solid import Solid
from ._values import each, placement_values, solid_values

if TYPE_CHECKING:
    from ._scene import Scene

Caps: TypeAlias = Literal["none", "p0", "p1", "both"]
Degenerate: TypeAlias = Literal["error", "skip"]
#: Numbers, or by the column that the material shows.
Values: TypeAlias = npt.ArrayLike | dict[str, npt.ArrayLike] | None
Joints: TypeAlias = Literal["round", "flat", "none"]

_CAPS = {"none": 0, "p0": 1, "p1": 2, "both": 3}


class Prototype:
    """A list of solids, and of prototypes that are placed in it.

    A :class:`Scene` is the outermost prototype. Others are made by
    :meth:`Scene.prototype` and placed by :meth:`add_instances`, in the scene or in each other,
    as often as one likes: a placement takes about 200 bytes, whatever it places.

    Every ``add_...`` method takes arrays with a row a solid, of any real dtype and memory
    order. A single vector or number serves all rows. The methods return the numbers of the
    solids, as hits report them in ``primitive``; they count up from 0. Lengths and coordinates
    have any unit, the same one everywhere.
    """

    def __init__(self, scene: Scene, index: int, name: str) -> None:
        self._scene = scene
        self._index = index
        self._name = name
        self._values: list[tuple[int, Floats]] = []

    @property
    def name(self) -> str:
        """The name; empty for the scene itself."""
        return self._name

    def __len__(self) -> int:
        """How many solids it has, without those of placed prototypes."""
        return self._scene._core.counts(self._index)[0]

    def __repr__(self) -> str:
        solids, placements = self._scene._core.counts(self._index)
        what = f"prototype {self._name!r}" if self._index else "scene"
        return f"<cyltrace {what}: {solids} solids, {placements} placements>"

    def add_cylinders(
        self,
        p0: npt.ArrayLike,
        p1: npt.ArrayLike,
        radius: npt.ArrayLike,
        caps: Caps | Sequence[Caps] = "both",
        material: str | None = None,
        values: Values = None,
        degenerate: Degenerate = "error",
    ) -> Ints:
        """Adds circular cylinders.

        Parameters
        ----------
        p0, p1 : (n, 3) or (3,)
            The ends of the axes.
        radius : (n,) or number
            The radii, positive.
        caps : "none", "p0", "p1", "both", or n of these
            Which ends are closed by a disk.
        material : str, optional
            The name given to :meth:`Scene.add_material`; gray otherwise.
        values : (n,) or number, or a dict of one, optional
            A number for each solid, which :attr:`Hits.value` returns. A dict has the name of the
            column that the material shows (:meth:`Scene.add_material`): the values are also the
            colors of the solids. NaN is no value; labels may stand for numbers.
        degenerate : "error" or "skip"
            Whether rows that are no solid (a length or radius of zero, or NaN) are an error
            or left out. Those that are left out keep their numbers.

        Returns
        -------
        (n,) int64
            The numbers of the cylinders within this prototype.

        Raises
        ------
        ValueError
            If shapes do not fit, or a row is no cylinder: which row, its value and what would
            be right. Nothing is added then.

        Examples
        --------
        >>> import cyltrace
        >>> scene = cyltrace.Scene()
        >>> scene.add_cylinders([[0, 0, 0], [2, 0, 0]], [[0, 0, 1], [2, 0, 1]], [0.5, 0.25])
        array([0, 1])
        """
        p0, p1, radius = rows("p0", p0), rows("p1", p1), numbers("radius", radius)
        codes = _caps(caps)
        count = common_length(p0=p0, p1=p1, radius=radius, caps=codes)
        return self._add(
            self._scene._core.add_cylinders,
            count,
            [p0, p1, radius, codes],
            material,
            values,
            degenerate,
        )

    def add_cylinders_from_axis(
        self,
        start: npt.ArrayLike,
        axis: npt.ArrayLike,
        length: npt.ArrayLike,
        radius: npt.ArrayLike,
        caps: Caps | Sequence[Caps] = "both",
        material: str | None = None,
        values: Values = None,
        degenerate: Degenerate = "error",
    ) -> Ints:
        """Adds cylinders as QSM tables state them: ``p1 = start + axis / |axis| * length``.

        Parameters
        ----------
        start : (n, 3) or (3,)
            One end of each axis.
        axis : (n, 3) or (3,)
            The directions, of any length but zero.
        length : (n,) or number
            The lengths, not negative.

        The other parameters, the result and the errors are those of :meth:`add_cylinders`.

        Examples
        --------
        >>> import cyltrace
        >>> scene = cyltrace.Scene()
        >>> scene.add_cylinders_from_axis([0, 0, 0], [0, 0, 2], 3.0, 0.1)
        array([0])
        >>> scene.cylinders()["p1"]
        array([[0., 0., 3.]])
        """
        start, axis = rows("start", start), rows("axis", axis)
        length = numbers("length", length)
        negative = np.flatnonzero(length < 0)
        if len(negative):
            row = int(negative[0])
            raise ValueError(f"row {row}: length is {length[row]}: it must not be negative")
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            # Scaled first, so that squares neither overflow nor vanish.
            greatest = np.abs(axis).max(axis=1, keepdims=True)
            scaled = axis / greatest
            unit = scaled / np.sqrt((scaled * scaled).sum(axis=1, keepdims=True))
        # An axis of zero has no direction: the row is degenerate, as one without length.
        unit = np.where(greatest == 0, 0.0, unit)
        p1 = start + unit * length[:, np.newaxis]
        return self.add_cylinders(start, p1, radius, caps, material, values, degenerate)

    def add_cones(
        self,
        p0: npt.ArrayLike,
        p1: npt.ArrayLike,
        radius0: npt.ArrayLike,
        radius1: npt.ArrayLike,
        caps: Caps | Sequence[Caps] = "both",
        material: str | None = None,
        values: Values = None,
        degenerate: Degenerate = "error",
    ) -> Ints:
        """Adds cones between flat ends; one of the radii may be zero.

        Parameters
        ----------
        p0, p1 : (n, 3) or (3,)
            The ends of the axes.
        radius0, radius1 : (n,) or number
            The radii at ``p0`` and at ``p1``.

        The other parameters, the result and the errors are those of :meth:`add_cylinders`.
        """
        p0, p1 = rows("p0", p0), rows("p1", p1)
        radius0, radius1 = numbers("radius0", radius0), numbers("radius1", radius1)
        codes = _caps(caps)
        count = common_length(p0=p0, p1=p1, radius0=radius0, radius1=radius1, caps=codes)
        columns = [p0, p1, radius0, radius1, codes]
        add = self._scene._core.add_cones
        return self._add(add, count, columns, material, values, degenerate)

    def add_rounded_cones(
        self,
        p0: npt.ArrayLike,
        p1: npt.ArrayLike,
        radius0: npt.ArrayLike,
        radius1: npt.ArrayLike,
        material: str | None = None,
        values: Values = None,
        degenerate: Degenerate = "error",
    ) -> Ints:
        """Adds the convex hulls of pairs of balls; with equal radii these are capsules.

        Parameters
        ----------
        p0, p1 : (n, 3) or (3,)
            The centers of the balls; the same point makes one ball.
        radius0, radius1 : (n,) or number
            Their radii, not both zero.

        The other parameters, the result and the errors are those of :meth:`add_cylinders`.
        """
        p0, p1 = rows("p0", p0), rows("p1", p1)
        radius0, radius1 = numbers("radius0", radius0), numbers("radius1", radius1)
        count = common_length(p0=p0, p1=p1, radius0=radius0, radius1=radius1)
        columns = [p0, p1, radius0, radius1]
        add = self._scene._core.add_rounded_cones
        return self._add(add, count, columns, material, values, degenerate)

    def add_spheres(
        self,
        center: npt.ArrayLike,
        radius: npt.ArrayLike,
        material: str | None = None,
        values: Values = None,
        degenerate: Degenerate = "error",
    ) -> Ints:
        """Adds spheres.

        Parameters
        ----------
        center : (n, 3) or (3,)
        radius : (n,) or number, positive

        The other parameters, the result and the errors are those of :meth:`add_cylinders`.
        """
        center, radius = rows("center", center), numbers("radius", radius)
        count = common_length(center=center, radius=radius)
        add = self._scene._core.add_spheres
        return self._add(add, count, [center, radius], material, values, degenerate)

    def add_cuboids(
        self,
        center: npt.ArrayLike,
        half_widths: npt.ArrayLike,
        quaternion: npt.ArrayLike = NO_TURN,
        material: str | None = None,
        values: Values = None,
    ) -> Ints:
        """Adds boxes, which may be turned.

        Parameters
        ----------
        center : (n, 3) or (3,)
        half_widths : (n, 3) or (3,)
            Half of the widths along each box's own x, y and z, positive.
        quaternion : (n, 4) or (4,)
            The turn of each as ``x, y, z, w`` (SciPy's order), of any length.

        The other parameters, the result and the errors are those of :meth:`add_cylinders`.
        """
        center, half_widths = rows("center", center), rows("half_widths", half_widths)
        quaternion = rows("quaternion", quaternion, 4)
        count = common_length(center=center, half_widths=half_widths, quaternion=quaternion)
        columns = [center, half_widths, quaternion]
        return self._add(self._scene._core.add_cuboids, count, columns, material, values)

    def add_disks(
        self,
        center: npt.ArrayLike,
        normal: npt.ArrayLike,
        radius: npt.ArrayLike,
        material: str | None = None,
        values: Values = None,
        degenerate: Degenerate = "error",
    ) -> Ints:
        """Adds flat disks.

        Parameters
        ----------
        center : (n, 3) or (3,)
        normal : (n, 3) or (3,)
            Of any length but zero.
        radius : (n,) or number, positive

        The other parameters, the result and the errors are those of :meth:`add_cylinders`.
        """
        center, normal = rows("center", center), rows("normal", normal)
        radius = numbers("radius", radius)
        count = common_length(center=center, normal=normal, radius=radius)
        add = self._scene._core.add_disks
        return self._add(add, count, [center, normal, radius], material, values, degenerate)

    def add_polylines(
        self,
        points: npt.ArrayLike,
        offsets: npt.ArrayLike | None = None,
        edges: npt.ArrayLike | None = None,
        radius: npt.ArrayLike = 1.0,
        joints: Joints = "round",
        material: str | None = None,
        values: Values = None,
        degenerate: Degenerate = "error",
    ) -> Ints:
        """Adds tubes along lines of points: streamlines, neurons, lattices.

        Parameters
        ----------
        points : (n, 3)
        offsets : (k + 1,) integers, optional
            Where each of ``k`` lines begins in ``points``, and the end. Without offsets and
            edges, all points are one line.
        edges : (m, 2) integers, optional
            Pairs of points that are joined, instead of offsets.
        radius : (n,) or number
            The radius at each point.
        joints : "round", "flat", "none"
            The solid of a segment: a rounded cone, so that the tube has no gaps; a cone with
            flat ends; or a cylinder with the radius of the segment's second point.
        values : (n,) or number, or a dict of one, optional
            A number for each point, as of :meth:`add_cylinders`. A segment gets that of its second
            point.

        ``material``, ``degenerate`` and the errors are those of :meth:`add_cylinders`.

        Returns
        -------
        (m,) int64
            The numbers of the segments, in the order of the lines or edges.

        Examples
        --------
        >>> import cyltrace
        >>> scene = cyltrace.Scene()
        >>> scene.add_polylines([[0, 0, 0], [1, 0, 0], [1, 1, 0]], radius=0.1)
        array([0, 1])
        """
        points, radius = rows("points", points), numbers("radius", radius)
        common_length(points=points, radius=radius) if len(points) > 1 else None
        joined = pairs(len(points), offsets, edges)
        first, second = joined[:, 0], joined[:, 1]
        radius = np.broadcast_to(radius, len(points))
        if isinstance(values, dict):
            values = {name: each(name, one, len(points))[second] for name, one in values.items()}
        elif values is not None:
            values = each("values", values, len(points))[second]
        p0, p1, radius1 = points[first], points[second], radius[second]
        if joints == "none":
            return self.add_cylinders(p0, p1, radius1, "both", material, values, degenerate)
        if joints == "flat":
            radii = (radius[first], radius1)
            return self.add_cones(p0, p1, *radii, "both", material, values, degenerate)
        if joints == "round":
            radii = (radius[first], radius1)
            return self.add_rounded_cones(p0, p1, *radii, material, values, degenerate)
        raise ValueError(f'joints is {joints!r}: it must be "round", "flat" or "none"')

    def add(
        self,
        solid: Solid,
        material: str | None = None,
        value: float | dict[str, float | str] | None = None,
    ) -> int:
        """Adds what set operations make of some solids.

        Parameters
        ----------
        solid : Solid
        material : str, optional
        value : float, or a dict of one, optional
            A number that :attr:`Hits.value` returns, as ``values`` of :meth:`add_cylinders`.

        Returns
        -------
        int
            The solid's number within this prototype.

        Examples
        --------
        >>> import cyltrace
        >>> from cyltrace import Solid
        >>> scene = cyltrace.Scene()
        >>> pipe = Solid.cylinder([0, 0, 0], [0, 0, 2], 1.0)
        >>> scene.add(pipe - Solid.cylinder([0, 0, 0], [0, 0, 2], 0.75))
        0
        """
        if not isinstance(solid, Solid):
            raise TypeError(f"solid is a {type(solid).__name__}: it must be a cyltrace.Solid")
        code = self._scene._material(material)
        given, is_shown = solid_values(self._scene._core, code, value, 1)
        number = self._scene._core.add_composition(self._index, solid._core, code)
        self._keep(number, code, given, is_shown)
        return number

    def add_union(self, *solids: Solid, material: str | None = None) -> int:
        """Adds the union of solids, as ``add(a | b | ...)``."""
        return self.add(Solid.union(*solids), material)

    def add_intersection(self, *solids: Solid, material: str | None = None) -> int:
        """Adds the intersection of solids, as ``add(a & b & ...)``."""
        return self.add(Solid.intersection(*solids), material)

    def add_difference(self, *solids: Solid, material: str | None = None) -> int:
        """Adds the first of some solids without the others, as ``add(a - b - ...)``."""
        return self.add(Solid.difference(*solids), material)

    def add_instances(
        self,
        prototype: Prototype,
        matrices: npt.ArrayLike | None = None,
        *,
        positions: npt.ArrayLike | None = None,
        quaternions: npt.ArrayLike | None = None,
        scales: npt.ArrayLike | None = None,
        values: dict[str, npt.ArrayLike] | None = None,
    ) -> Ints:
        """Places a prototype in this one, any number of times.

        Parameters
        ----------
        prototype : Prototype
            One made by :meth:`Scene.prototype` of the same scene.
        matrices : (n, 4, 4) or (4, 4), optional
            Take points of the prototype (as columns) to points of this one.
        positions : (n, 3) or (3,), optional
            Where the prototype's origin goes, instead of matrices.
        quaternions : (n, 4) or (4,), optional
            Turns as ``x, y, z, w`` (SciPy's order), of any length.
        scales : (n,), (n, 3) or number, optional
            Factors, the same in all directions or one for each of the prototype's axes.
        values : dict of (n,) or numbers, optional
            Values of the placements in columns that materials show (:meth:`Scene.add_material`):
            the colors of solids in them that have none themselves. NaN is no value.

        Returns
        -------
        (n,) int64
            The numbers of the placements; ``Hits.instance`` is a path of such numbers.

        Raises
        ------
        ValueError
            If a matrix is singular or not affine: which one. If the prototype would contain
            itself.

        Examples
        --------
        >>> import cyltrace
        >>> scene = cyltrace.Scene()
        >>> tree = scene.prototype("tree")
        >>> tree.add_cylinders([0, 0, 0], [0, 0, 5], 0.2)
        array([0])
        >>> scene.add_instances(tree, positions=[[0, 0, 0], [9, 0, 0]], scales=[1.0, 1.5])
        array([0, 1])
        """
        if prototype._scene is not self._scene:
            raise ValueError("the prototype belongs to another scene")
        if matrices is None:
            stacked = composed(positions, quaternions, scales)
        elif positions is None and quaternions is None and scales is None:
            stacked = stated(matrices)
        else:
            raise ValueError(
                "matrices exclude positions, quaternions and scales: give one or the others"
            )
        core = self._scene._core
        columns = placement_values(core, values, len(stacked))
        first = core.add_placements(self._index, prototype._index, stacked.reshape(-1, 16))
        for column, shown in columns.items():
            core.set_placement_values(self._index, column, first, shown)
        return np.arange(first, first + len(stacked), dtype=np.int64)

    def cylinders(self) -> dict[str, Any]:
        """The cylinders as arrays ``p0`` (n, 3), ``p1`` (n, 3), ``radius`` (n,) and
        ``primitive`` (n,)."""
        p0, p1, radius, primitive = self._scene._core.cylinders(self._index)
        return {
            "p0": p0.reshape(-1, 3),
            "p1": p1.reshape(-1, 3),
            "radius": radius,
            "primitive": primitive,
        }

    def values(self) -> Floats:
        """The number given for each solid by ``values``; NaN where none was given."""
        values = np.full(self._scene._core.next_primitive(self._index), np.nan)
        for first, some in self._values:
            values[first : first + len(some)] = some
        return values

    def _add(
        self,
        add: Any,
        count: int,
        columns: list[Any],
        material: str | None,
        values: Values,
        degenerate: Degenerate = "error",
    ) -> Ints:
        if degenerate not in ("error", "skip"):
            raise ValueError(f'degenerate is {degenerate!r}: it must be "error" or "skip"')
        number = self._scene._material(material)
        given, is_shown = solid_values(self._scene._core, number, values, count)
        first, left_out = add(Rows(self._index, count, number, degenerate == "skip"), *columns)
        self._keep(first, number, given, is_shown, left_out)
        return np.arange(first, first + count, dtype=np.int64)

    def _keep(
        self,
        first: int,
        material: int,
        values: Floats | None,
        is_shown: bool,
        left_out: Sequence[int] = (),
    ) -> None:
        """Keeps the values of solids whose numbers count up from ``first``."""
        if values is None:
            return
        self._values.append((first, values))
        if is_shown:
            shown = values.copy()
            shown[list(left_out)] = np.nan
            self._scene._core.set_solid_values(self._index, material, first, shown)


def _caps(caps: Caps | Sequence[Caps]) -> npt.NDArray[np.uint8]:
    several = [caps] if isinstance(caps, str) else caps
    known, numbers = np.unique(np.asarray(several, dtype=np.str_), return_inverse=True)
    for name in known:
        if str(name) not in _CAPS:
            row = int(np.flatnonzero(known[numbers] == name)[0])
            raise ValueError(
                f'caps[{row}] is {str(name)!r}: it must be "none", "p0", "p1" or "both"'
            )
    codes = np.array([_CAPS[str(name)] for name in known], dtype=np.uint8)
    return np.ascontiguousarray(codes[numbers.reshape(-1)])
