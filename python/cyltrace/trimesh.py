"""The methods of ``trimesh.ray`` over a cyltrace scene.

Code that takes ``mesh.ray`` takes ``cyltrace.trimesh.RayIntersector(scene)`` in its place. The
names, arguments and shapes are trimesh's; hits are exact, and where trimesh returns the index
of a triangle, this returns the number of the solid.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Bools, Floats, Ints
from ._hits import AllHits, Hits
from ._scene import Scene
from ._tracer import Tracer


class RayIntersector:
    """What ``mesh.ray`` is to a mesh.

    Parameters
    ----------
    scene : Scene or Tracer

    Examples
    --------
    >>> import cyltrace
    >>> from cyltrace.trimesh import RayIntersector
    >>> scene = cyltrace.Scene()
    >>> scene.add_spheres([[0, 0, 0], [0, 0, 3]], 1)
    array([0, 1])
    >>> ray = RayIntersector(scene)
    >>> ray.intersects_first([[0, 0, 9], [5, 0, 9]], [[0, 0, -1], [0, 0, -1]])
    array([ 1, -1])
    """

    def __init__(self, scene: Scene | Tracer) -> None:
        self._tracer = scene if isinstance(scene, Tracer) else Tracer(scene)

    def intersects_location(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        multiple_hits: bool = True,
    ) -> tuple[Floats, Ints, Ints]:
        """Where rays hit.

        Parameters
        ----------
        ray_origins, ray_directions : (n, 3)
        multiple_hits : bool
            Whether to return all hits of a ray, or the first.

        Returns
        -------
        locations : (h, 3)
        index_ray : (h,)
            The ray of each hit.
        index_tri : (h,)
            The number of the solid of each hit.
        """
        hits = self._hits(ray_origins, ray_directions, multiple_hits)
        return hits.point, hits.ray, hits.primitive

    def intersects_id(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        return_locations: bool = False,
        multiple_hits: bool = True,
    ) -> tuple[Ints, Ints] | tuple[Ints, Ints, Floats]:
        """Which solids rays hit.

        Parameters
        ----------
        ray_origins, ray_directions : (n, 3)
        return_locations : bool
            Whether to return the points too.
        multiple_hits : bool
            Whether to return all hits of a ray, or the first.

        Returns
        -------
        index_tri : (h,)
            The number of the solid of each hit.
        index_ray : (h,)
            The ray of each hit.
        locations : (h, 3)
            Only if requested.
        """
        hits = self._hits(ray_origins, ray_directions, multiple_hits)
        if return_locations:
            return hits.primitive, hits.ray, hits.point
        return hits.primitive, hits.ray

    def intersects_first(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> Ints:
        """(n,) The number of the first solid that each ray hits; -1 if it misses."""
        return self._tracer.closest(ray_origins, ray_directions).primitive

    def intersects_any(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> Bools:
        """(n,) Whether each ray hits anything."""
        return self._tracer.occluded(ray_origins, ray_directions)

    def contains_points(self, points: npt.ArrayLike) -> Bools:
        """(n,) Whether any solid contains each point."""
        return self._tracer.contains(points)

    def _hits(
        self, origins: npt.ArrayLike, directions: npt.ArrayLike, multiple_hits: bool
    ) -> Hits | AllHits:
        if multiple_hits:
            return self._tracer.all_hits(origins, directions)
        hits = self._tracer.closest(origins, directions)
        return hits[np.flatnonzero(hits.hit)]
