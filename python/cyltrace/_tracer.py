"""Queries of many rays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Bools, Floats, common_length, numbers, rows
from ._hits import AllHits, Hits, Located
from ._scene import Scene

#: Called with the number of rays that are done and their total, some 20 times a second.
Progress: TypeAlias = Callable[[int, int], object]


class Tracer:
    """A scene that is ready to be traced.

    Building takes about a second for a million solids. The scene may be changed afterwards;
    the tracer keeps what it was made of. Several threads may use one tracer at once: the
    interpreter is free while rays are traced. Ctrl-C ends a query within a second.

    Parameters
    ----------
    scene : Scene
    threads : int, optional
        How many threads build and trace; all cores otherwise.
    layout : "auto", "single" or "block"
        Whether a primitive of Embree's is one solid or eight. It changes speed and memory only.
    exact : bool
        Whether hits, misses and parts are decided as exact arithmetic does for any f64 numbers,
        and not only for those that f32 represents. Tracing takes longer.

    Examples
    --------
    >>> import cyltrace
    >>> scene = cyltrace.Scene()
    >>> scene.add_cylinders([0, 0, 0], [0, 0, 2], 0.5)
    array([0])
    >>> tracer = cyltrace.Tracer(scene)
    >>> hits = tracer.closest([[4, 0, 1], [4, 3, 1]], [-1, 0, 0])
    >>> hits
    <cyltrace.Hits: 1 of 2 rays hit>
    >>> hits.t
    array([3.5, inf])
    >>> hits.normal[0]
    array([1., 0., 0.])
    """

    def __init__(
        self,
        scene: Scene,
        threads: int | None = None,
        layout: Literal["auto", "single", "block"] = "auto",
        exact: bool = False,
    ) -> None:
        self._scene = scene
        self._core = _core.Tracer(scene._core, threads, layout, exact)

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """The least and the greatest corner of a box around the scene."""
        least, greatest = self._core.bounds
        return np.array(least), np.array(greatest)

    @property
    def threads(self) -> int:
        """How many threads trace."""
        return self._core.threads

    def __repr__(self) -> str:
        version, isa = self._core.engine
        return f"<cyltrace.Tracer: Embree {version}, {isa}, {self.threads} threads>"

    def closest(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        progress: Progress | None = None,
    ) -> Hits:
        """The first hit of each ray.

        Parameters
        ----------
        origins : (n, 3) or (3,)
        directions : (n, 3) or (3,)
            Of any length but zero; ``t`` counts in it. One origin or direction serves all rays.
        t_min, t_max : (n,) or number
            The range of ``t``, ends included.
        progress : callable, optional
            Called as ``progress(done, total)`` now and then. An exception that it raises ends
            the query.

        Returns
        -------
        Hits
            With a row a ray.

        Raises
        ------
        ValueError
            If shapes do not fit, or a number is NaN or too large: of which ray.
        """
        arrays, count = self._rays(origins, directions, t_min, t_max)
        return Hits(self._core.closest(*arrays, progress), self._scene, np.arange(count))

    def occluded(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        progress: Progress | None = None,
    ) -> Bools:
        """(n,) Whether each ray hits anything. Faster than :meth:`closest`; the parameters are
        the same.

        Examples
        --------
        >>> import cyltrace
        >>> scene = cyltrace.Scene()
        >>> scene.add_spheres([0, 0, 0], 1)
        array([0])
        >>> cyltrace.Tracer(scene).occluded([0, 0, 5], [[0, 0, -1], [0, 0, 1]])
        array([ True, False])
        """
        arrays, _ = self._rays(origins, directions, t_min, t_max)
        return self._core.occluded(*arrays, progress)

    def all_hits(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike = 0.0,
        t_max: npt.ArrayLike = np.inf,
        progress: Progress | None = None,
    ) -> AllHits:
        """Every hit of each ray, in order, entries and exits alike. The parameters are those of
        :meth:`closest`.

        Examples
        --------
        >>> import cyltrace
        >>> scene = cyltrace.Scene()
        >>> scene.add_spheres([[0, 0, 0], [0, 0, 3]], 1)
        array([0, 1])
        >>> hits = cyltrace.Tracer(scene).all_hits([[0, 0, 9], [5, 0, 9]], [0, 0, -1])
        >>> hits.t, hits.entering, hits.offsets
        (array([ 5., 7., 8., 10.]), array([ True, False, True, False]), array([0, 4, 4]))
        """
        arrays, _ = self._rays(origins, directions, t_min, t_max)
        found, counts = self._core.all_hits(*arrays, progress)
        return AllHits(found, self._scene, counts)

    def contains(self, points: npt.ArrayLike, progress: Progress | None = None) -> Bools:
        """(n,) Whether any solid contains each point. Solids are closed, tubes included.

        Parameters
        ----------
        points : (n, 3) or (3,)

        Examples
        --------
        >>> import cyltrace
        >>> scene = cyltrace.Scene()
        >>> scene.add_spheres([0, 0, 0], 1)
        array([0])
        >>> cyltrace.Tracer(scene).contains([[0, 0, 1], [0, 0, 1.5]])
        array([ True, False])
        """
        return self._core.contains(rows("points", points), progress)

    def locate(self, points: npt.ArrayLike, progress: Progress | None = None) -> Located:
        """The solids that contain each point.

        Parameters
        ----------
        points : (n, 3) or (3,)
        """
        return Located(*self._core.locate(rows("points", points), progress))

    def spawn(self, hits: Hits, directions: npt.ArrayLike) -> tuple[Floats, Floats]:
        """As :meth:`Hits.spawn`."""
        return hits.spawn(directions)

    def _rays(
        self,
        origins: npt.ArrayLike,
        directions: npt.ArrayLike,
        t_min: npt.ArrayLike,
        t_max: npt.ArrayLike,
    ) -> tuple[tuple[Floats, Floats, Floats, Floats], int]:
        arrays = (
            rows("origins", origins),
            rows("directions", directions),
            numbers("t_min", t_min),
            numbers("t_max", t_max),
        )
        names = ("origins", "directions", "t_min", "t_max")
        count = common_length(**dict(zip(names, arrays, strict=True)))
        if count == 0:
            # The core takes the greatest length, and single rows serve all rays.
            empty = np.empty((0, 3)), np.empty((0, 3)), np.empty(0), np.empty(0)
            return empty, 0
        return arrays, count
