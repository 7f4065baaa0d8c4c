"""Checks of hits: of the tracer itself, of other intersectors and of other programs."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, common_length, numbers, real, rows, shape
from ._hits import AllHits, Hits
from ._scene import Scene
from ._tracer import Progress, Tracer

if TYPE_CHECKING:
    import pandas

#: The names of the classes of rays, in the order of the rows of a check.
CLASSES: tuple[str, ...] = tuple(_core.CLASSES)

#: Takes origins (n, 3), directions (n, 3), t_min (n,) and t_max (n,), and returns the first hits.
Intersector: TypeAlias = Callable[
    [Floats, Floats, Floats, Floats], "npt.ArrayLike | Mapping[str, npt.ArrayLike] | Hits"
]


class Check:
    """What a check found. It is true if the check passes.

    ``print(check)`` shows the table that the program prints. :func:`check` and
    :func:`check_hits` return it.
    """

    def __init__(self, core: _core.Check, scene: Scene) -> None:
        self._core = core
        self._scene = scene
        self._figures: dict[str, Any] = json.loads(core.json())

    @property
    def holds(self) -> bool:
        """Whether no answer is wrong and no row proves too little."""
        return self._figures["holds"]

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The rows, with the keys of ``cyltrace check --json``: one for each class of rays and
        each witness, the meshes of each number of sides and the exact oracle."""
        return self._figures["classes"]

    @property
    def violations(self) -> list[dict[str, Any]]:
        """The first wrong answers of each row, 20 at most: the ray, its answer ``t``, None for a
        miss, and ``what`` would be right."""
        return self._figures["listed"]

    @property
    def violation_count(self) -> int:
        """The number of wrong answers, listed or not."""
        return self._figures["violations"]

    @property
    def convergence(self) -> list[dict[str, Any]]:
        """How close the meshes of each number of sides are to the solids."""
        return self._figures["convergence"]

    @property
    def windows(self) -> list[str]:
        """A sentence for each part of the scene that was checked."""
        return self._figures["windows"]

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a data frame; needs pandas."""
        import pandas

        frame = pandas.DataFrame(self.rows)
        frame["segments"] = frame["segments"].astype("Int64")
        return frame

    def report(self, directory: str | os.PathLike[str], title: str | None = None) -> Path:
        """Writes the page of ``cyltrace check --report``: pictures, convergence, the table and
        the wrong answers.

        Parameters
        ----------
        directory : str or path
            Is made if it does not exist.
        title : str, optional
            What the scene is called on the page; the path that it was loaded from otherwise.

        Returns
        -------
        Path
            ``index.html`` in the directory, a single file that fetches nothing.

        Raises
        ------
        OSError
            If the directory cannot be made or the file cannot be written.
        """
        path = Path(directory) / "index.html"
        path.parent.mkdir(parents=True, exist_ok=True)
        self._core.write_page(path, title or self._scene._path or "a scene made in Python")
        return path

    def __bool__(self) -> bool:
        return self.holds

    def __repr__(self) -> str:
        return f"<cyltrace.Check: {self._figures['rays']} rays, {self._core.verdict()}>"

    def __str__(self) -> str:
        return self._core.text()


def check(
    scene: Scene | Tracer,
    intersector: Intersector | None = None,
    *,
    rays: int = 100_000,
    classes: str | Iterable[str] | None = None,
    segments: int | Iterable[int] = (16, 64),
    seed: int = 0,
    max_memory: int | str = "4GiB",
    threads: int | None = None,
    progress: Progress | None = None,
) -> Check:
    """Checks an intersector of a scene, as ``cyltrace check`` does.

    The rays are those that are hard: at silhouettes and rims, along axes, from inside. A mesh
    inside each solid and a mesh around it, traced by Embree, bound each hit, and exact
    arithmetic decides on a sample and in doubt. So an answer outside of the bounds is wrong, for
    any number of sides. The same scene, settings and seed give the same rows on any number of
    threads.

    Parameters
    ----------
    scene : Scene or Tracer
    intersector : callable, optional
        What is checked; the tracer itself otherwise. It is called as ``intersector(origins,
        directions, t_min, t_max)`` with float64 arrays of the shapes (n, 3), (n, 3), (n,) and
        (n,), up to 4096 rays a call, on the thread that called ``check``. It returns the first
        hit of each ray with ``t_min <= t <= t_max``, as

        - ``t`` of shape (n,), in lengths of the direction, ``inf`` or NaN for a miss; or
        - a dict with ``t`` and, to check these as well, ``normal`` of shape (n, 3), the outward
          unit normals; or
        - :class:`Hits`, whose solids and parts are checked as well.
    rays : int
        Rays of each class, 1 to 10^9.
    classes : str or iterable of str, optional
        Names in :data:`cyltrace.CLASSES`; all otherwise.
    segments : int or iterable of int
        Sides of the meshes, each 3 to 4096. All numbers of sides are checked with the same rays.
    seed : int
        Determines the rays.
    max_memory : int or str
        Bytes that the meshes may take, or a size such as ``"500MB"``. A larger scene is checked
        in parts.
    threads : int, optional
        How many threads check; all cores otherwise. With a tracer as ``scene``, as many as it has.
    progress : callable, optional
        Called as ``progress(done, total)`` now and then. An exception that it raises ends the
        check.

    Returns
    -------
    Check

    Raises
    ------
    ValueError
        If a setting is out of its range, the scene has no solid, or the arrays that the
        intersector returns have wrong shapes.
    TypeError
        If the intersector returns something else than real numbers.
    Exception
        Any that the intersector raises; it ends the check.

    Examples
    --------
    >>> import cyltrace
    >>> scene = cyltrace.Scene()
    >>> scene.add_cylinders([0, 0, 0], [0, 0, 2], 0.5)
    array([0])
    >>> cyltrace.check(scene, rays=1000)
    <cyltrace.Check: 10005 rays, passes: no answer is wrong>

    An intersector that returns hits too late by a millionth:

    >>> tracer = cyltrace.Tracer(scene)
    >>> def late(origins, directions, t_min, t_max):
    ...     return tracer.closest(origins, directions, t_min, t_max).t + 1e-6
    >>> found = cyltrace.check(scene, late, rays=1000)
    >>> found.holds, found.violation_count > 0
    (False, True)
    """
    if not 1 <= rays <= _core.GREATEST_RAYS:
        raise ValueError(f"rays is {rays}: it must be from 1 to {_core.GREATEST_RAYS}")
    sides = [segments] if isinstance(segments, (int, np.integer)) else list(segments)
    for number in sides:
        if not 3 <= number <= 4096:
            raise ValueError(f"segments has {number}: each number must be from 3 to 4096")
    names = [classes] if isinstance(classes, str) else classes
    memory = _core.parse_size(str(max_memory))
    tracer = scene if isinstance(scene, Tracer) else Tracer(scene, threads)
    core = _core.check(
        tracer._core,
        None if intersector is None else _called(intersector),
        rays,
        None if names is None else list(names),
        sides,
        seed,
        memory,
        progress,
    )
    return Check(core, tracer._scene)


def check_hits(
    scene: Scene | Tracer,
    origins: npt.ArrayLike,
    directions: npt.ArrayLike,
    t: npt.ArrayLike | Hits,
    *,
    t_min: npt.ArrayLike = 0.0,
    t_max: npt.ArrayLike = np.inf,
    tolerance: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Check:
    """Compares the hits of another program with the exact ones, as ``cyltrace check --hits`` does.

    An answer is wrong if no displacement of the ray and the surface within the tolerance
    explains it. The only row is called ``given``.

    Parameters
    ----------
    scene : Scene or Tracer
    origins, directions, t_min, t_max
        The rays, as in :meth:`Tracer.closest`.
    t : (n,) or Hits
        The first hit of each ray, in lengths of its direction; ``inf`` or NaN for a miss.
    tolerance : float, optional
        The error that is allowed, relative to the distances of the ray and of the solid; 16 / 2^24
        otherwise, which suits a program that computes in float32.
    threads, progress : optional
        As in :func:`check`.

    Returns
    -------
    Check

    Raises
    ------
    ValueError
        If shapes do not fit, a ray has NaN or a number that is too large, or the tolerance is
        negative.

    Examples
    --------
    >>> import cyltrace
    >>> scene = cyltrace.Scene()
    >>> scene.add_spheres([0, 0, 0], 1)
    array([0])
    >>> origins = [[0, 0, 3], [0, 0, 4], [0, 5, 4]]
    >>> cyltrace.check_hits(scene, origins, [0, 0, -1], [2.0, 3.0000001, float("inf")])
    <cyltrace.Check: 3 rays, passes: no answer is wrong>
    >>> wrong = cyltrace.check_hits(scene, origins, [0, 0, -1], [2.0, 3.5, float("nan")])
    >>> [(one["index"], one["t"], one["exact_t"]) for one in wrong.violations]
    [(1, 3.5, 3.0)]
    """
    if tolerance is not None and not 0.0 <= tolerance < np.inf:
        raise ValueError(f"tolerance is {tolerance}: it must be finite and not negative")
    rays = (
        rows("origins", origins),
        rows("directions", directions),
        numbers("t_min", t_min),
        numbers("t_max", t_max),
    )
    found = _times(t) if isinstance(t, Hits) else real("t", t)
    if found.ndim != 1:
        raise ValueError(f"t has the shape {shape(found.shape)}: it must be (n,)")
    names = ("origins", "directions", "t_min", "t_max")
    count = common_length(**dict(zip(names, rays, strict=True)), t=found)
    if len(found) != count:
        raise ValueError(f"t has {len(found)} rows: it must have one for each of {count} rays")
    tracer = scene if isinstance(scene, Tracer) else Tracer(scene, threads)
    core = _core.check_hits(tracer._core, *rays, found, tolerance, progress)
    return Check(core, tracer._scene)


def _called(intersector: Intersector) -> tuple[str, _core.Closest]:
    """The name of an intersector, and the function that the part in Rust calls."""

    def closest(origins: Floats, directions: Floats, t_min: Floats, t_max: Floats) -> _core.Answer:
        return _columns(intersector(origins, directions, t_min, t_max), len(origins))

    name = getattr(intersector, "__name__", type(intersector).__name__)
    return name, closest


def _columns(answer: Any, count: int) -> _core.Answer:
    """The answer of an intersector as contiguous columns, or an error that says what is wrong."""
    if isinstance(answer, Hits):
        times = _expect("the hits", _times(answer), (count,))
        paths, offsets = answer.instance
        return times, answer.normal.reshape(-1), (answer.part, answer.primitive, paths, offsets)
    normals = None
    if isinstance(answer, Mapping):
        unknown = set(answer) - {"t", "normal"}
        if "t" not in answer or unknown:
            raise ValueError(
                f"the intersector returned a dict with the keys {list(answer)}: they must be "
                "'t' and, if it knows normals, 'normal'"
            )
        if answer.get("normal") is not None:
            normals = real("the intersector's normal", answer["normal"])
            normals = _expect("the intersector's normal", normals, (count, 3)).reshape(-1)
        answer = answer["t"]
    times = real("the intersector's t", answer)
    return _expect("the intersector's t", times, (count,)), normals, None


def _expect(name: str, array: Floats, expected: tuple[int, ...]) -> Floats:
    if array.shape != expected:
        raise ValueError(
            f"{name}: the shape is {shape(array.shape)}, and it must be {shape(expected)}"
        )
    return array


def _times(hits: Hits) -> Floats:
    if isinstance(hits, AllHits):
        raise ValueError("these are all hits of each ray: it must be the first, as of closest()")
    return hits.t
