"""The hits of rays, as arrays that are computed when they are first read."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Bools, Floats, Ints, rows

if TYPE_CHECKING:
    import pandas

    from ._scene import Scene

#: The names of the kinds of solids; ``Hits.solid`` has positions in it.
SOLIDS: tuple[str, ...] = tuple(_core.SOLIDS)
#: The names of the parts of surfaces; ``Hits.part`` has positions in it.
PARTS: tuple[str, ...] = tuple(_core.PARTS)

#: The columns of tables, each with its width.
_COLUMNS = {
    "hit": 1,
    "t": 1,
    "point": 3,
    "normal": 3,
    "uv": 2,
    "error": 1,
    "solid": 1,
    "primitive": 1,
    "part": 1,
    "entering": 1,
    "prototype": 1,
    "material": 1,
}


class Hits:
    """The answers to some rays, in their order.

    Every attribute is an array with a row a ray. It is computed when it is first read, from
    the hits that the query found, and kept. Rays that hit nothing have ``t = inf``, NaN in the
    other real columns and -1 in the whole ones.

    ``hits[i:j]``, ``hits[mask]`` and ``hits[indices]`` are the hits of some rays, ``hits[i]``
    those of one; ``len(hits)`` is the number of rays.
    """

    def __init__(self, core: _core.Found, scene: Scene, ray: Ints) -> None:
        self._core = core
        self._scene = scene
        self._ray = ray
        self._columns: dict[str, Any] = {}

    def __len__(self) -> int:
        return len(self._ray)

    def __repr__(self) -> str:
        kind = type(self).__name__
        return f"<cyltrace.{kind}: {int(self.hit.sum())} of {len(self)} rays hit>"

    def __getitem__(self, which: int | slice | npt.ArrayLike) -> Hits:
        if isinstance(which, (int, np.integer)):
            if not -len(self) <= which < len(self):
                raise IndexError(f"there is no ray {which}: there are {len(self)}")
            which = [int(which)]
        chosen = which if isinstance(which, slice) else np.asarray(which)
        positions = np.ascontiguousarray(np.arange(len(self))[chosen])
        if positions.ndim != 1:
            raise IndexError("hits have one dimension")
        return Hits(self._core.take(positions), self._scene, self._ray[positions])

    @property
    def ray(self) -> Ints:
        """(n,) The number of the ray in the query."""
        return self._ray

    @property
    def hit(self) -> Bools:
        """(n,) Whether the ray hits anything."""
        return self._once("hit", lambda: np.isfinite(self.t))

    @property
    def t(self) -> Floats:
        """(n,) The ray's parameter: the hit is at ``origin + t * direction``. ``inf`` if it
        misses."""
        return self._column("t")

    @property
    def point(self) -> Floats:
        """(n, 3) The hit point, put onto the surface."""
        self._vectors()
        return self._columns["point"]

    @property
    def normal(self) -> Floats:
        """(n, 3) The outward unit normal, whichever way the ray goes."""
        self._vectors()
        return self._columns["normal"]

    @property
    def uv(self) -> Floats:
        """(n, 2) Coordinates on the surface: of a cylinder the angle around the axis divided
        by 2π and the position from ``p0`` to ``p1``, both from 0 to 1."""
        return self._column("uv")

    @property
    def error(self) -> Floats:
        """(n,) A bound of the distance of ``point`` from the true surface, in scene units."""
        return self._column("error")

    @property
    def solid(self) -> npt.NDArray[np.int8]:
        """(n,) The kind of solid, a position in :data:`cyltrace.SOLIDS`."""
        return self._column("solid")

    @property
    def primitive(self) -> Ints:
        """(n,) The number of the solid in its prototype, as ``add_...`` returned it."""
        return self._column("primitive")

    @property
    def part(self) -> npt.NDArray[np.int8]:
        """(n,) The part of the surface, a position in :data:`cyltrace.PARTS`."""
        return self._column("part")

    @property
    def entering(self) -> Bools:
        """(n,) Whether the ray goes into the solid there; false if it leaves or misses."""
        return self._column("entering")

    @property
    def prototype(self) -> Ints:
        """(n,) The number of the prototype that contains the solid; 0 is the scene itself."""
        return self._column("prototype")

    @property
    def material(self) -> Ints:
        """(n,) The number of the material; 0 is the default one."""
        return self._column("material")

    @property
    def instance(self) -> tuple[Ints, Ints]:
        """The path of placements to the solid, outermost first, as values (m,) and offsets
        (n + 1,): that of ray ``i`` is ``values[offsets[i]:offsets[i + 1]]``."""
        return self._once("instance", lambda: self._core.column("instance"))

    @property
    def placement(self) -> Ints:
        """(n,) The number of the outermost placement, as ``scene.add_instances`` returned it; -1
        for solids of the scene itself and rays that hit nothing."""

        def outermost() -> Ints:
            values, offsets = self.instance
            placed = np.diff(offsets) > 0
            numbers = np.full(len(self), -1, dtype=np.int64)
            numbers[placed] = values[offsets[:-1][placed]]
            return numbers

        return self._once("placement", outermost)

    @property
    def value(self) -> Floats:
        """(n,) The number that ``values`` gave the solid; NaN where there is none."""
        return self._once("value", self._value)

    def to_numpy(self) -> np.ndarray[Any, Any]:
        """A structured array with a field for each column but ``instance`` and ``value``."""
        columns = {name: getattr(self, name) for name in _COLUMNS}
        fields = [
            (name, column.dtype, (width,) if width > 1 else ())
            for (name, column), width in zip(columns.items(), _COLUMNS.values(), strict=True)
        ]
        table = np.empty(len(self), dtype=fields)
        for name, column in columns.items():
            table[name] = column
        return table

    def to_pandas(self) -> pandas.DataFrame:
        """A data frame with a row a ray and the columns of ``trace``; needs pandas."""
        import pandas

        columns: dict[str, Any] = {"ray": self.ray, "hit": self.hit, "t": self.t}
        for name, vector in (("", self.point), ("n", self.normal)):
            for axis, letter in enumerate("xyz"):
                columns[name + letter] = vector[:, axis]
        names = [name or None for name in self._scene._core.prototype_names()]
        columns["prototype"] = pandas.Categorical.from_codes(
            np.where(self.prototype > 0, self.prototype - 1, -1), categories=names[1:]
        )
        columns["solid"] = pandas.Categorical.from_codes(self.solid, categories=SOLIDS)
        columns["primitive"] = self.primitive
        columns["part"] = pandas.Categorical.from_codes(self.part, categories=PARTS)
        columns["entering"] = self.entering
        values, offsets = self.instance
        paths = np.split(values, offsets[1:-1]) if len(self) else []
        columns["instance"] = ["/".join(map(str, path)) for path in paths]
        columns["u"], columns["v"] = self.uv[:, 0], self.uv[:, 1]
        columns["error"] = self.error
        return pandas.DataFrame(columns)

    def spawn(self, directions: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Rays that leave the surfaces, for shadows and reflections.

        The origins lie beside the surfaces, on the side to which the directions point, just so
        far that no ray hits the surface that it leaves.

        Parameters
        ----------
        directions : (n, 3) or (3,)

        Returns
        -------
        origins, directions : (n, 3)
            Origins are NaN for rays that hit nothing: select ``hits.hit`` first.
        """
        directions = rows("directions", directions)
        if len(directions) not in (1, len(self)):
            raise ValueError(
                f"directions has {len(directions)} rows: it must have 1 or {len(self)}, as the hits"
            )
        origins = self._core.spawn(directions).reshape(-1, 3)
        return origins, np.broadcast_to(directions, origins.shape).copy()

    def _vectors(self) -> None:
        if "point" not in self._columns:
            point, normal = (values.reshape(-1, 3) for values in self._core.vectors())
            self._columns |= {"point": point, "normal": normal}

    def _column(self, name: str) -> Any:
        def column() -> Any:
            values = self._core.column(name)
            width = _COLUMNS[name]
            return values.reshape(-1, width) if width > 1 else values

        return self._once(name, column)

    def _once(self, name: str, compute: Any) -> Any:
        if name not in self._columns:
            self._columns[name] = compute()
        return self._columns[name]

    def _value(self) -> Floats:
        values = np.full(len(self), np.nan)
        prototype, primitive = self.prototype, self.primitive
        for one in (self._scene, *self._scene.prototypes.values()):
            here = prototype == one._index
            if one._values and here.any():
                values[here] = one.values()[primitive[here]]
        return values


class AllHits(Hits):
    """All hits of some rays, ordered by ray and then by ``t``.

    The columns have a row a hit. Those of ray ``i`` are ``hits[offsets[i]:offsets[i + 1]]``.
    """

    def __init__(self, core: _core.Found, scene: Scene, counts: Ints) -> None:
        super().__init__(core, scene, np.repeat(np.arange(len(counts)), counts))
        self._counts = counts

    @property
    def counts(self) -> Ints:
        """(rays,) How many hits each ray has."""
        return self._counts

    @property
    def offsets(self) -> Ints:
        """(rays + 1,) Where the hits of each ray begin, and the end."""
        return np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(self._counts)])

    def __repr__(self) -> str:
        return f"<cyltrace.AllHits: {len(self)} hits of {len(self._counts)} rays>"


class Located:
    """The solids that contain some points, ordered by point.

    The columns have a row a solid. Those of point ``i`` are the rows from ``offsets[i]`` up to
    ``offsets[i + 1]``.
    """

    def __init__(
        self,
        prototype: Ints,
        solid: npt.NDArray[np.int8],
        primitive: Ints,
        instance: tuple[Ints, Ints],
        counts: Ints,
    ) -> None:
        self.prototype = prototype
        self.solid = solid
        self.primitive = primitive
        self.instance = instance
        self.counts = counts

    @property
    def offsets(self) -> Ints:
        """(points + 1,) Where the solids of each point begin, and the end."""
        return np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(self.counts)])

    @property
    def point(self) -> Ints:
        """(m,) The number of the point of each row."""
        return np.repeat(np.arange(len(self.counts)), self.counts)

    def __len__(self) -> int:
        return len(self.primitive)

    def __repr__(self) -> str:
        return f"<cyltrace.Located: {len(self)} solids at {len(self.counts)} points>"
