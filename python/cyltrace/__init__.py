"""Exact ray tracing of cylinders and solids like them, with NumPy arrays.

A :class:`Scene` is made of arrays or loaded from a file. A :class:`Tracer` answers which
solids rays hit first, all hits, what is occluded and what contains points, in f64 and from
the surfaces themselves: nothing is a mesh. :func:`render` makes pictures. :func:`check`
validates the hits of any intersector.

>>> import cyltrace
>>> scene = cyltrace.Scene()
>>> scene.add_cylinders(p0=[0, 0, 0], p1=[0, 0, 2], radius=0.5)
array([0])
>>> hits = cyltrace.Tracer(scene).closest([4, 0, 1], [-1, 0, 0])
>>> hits.t, hits.point
(array([3.5]), array([[0.5, 0. , 1. ]]))
"""

from ._check import CLASSES, Check, Intersector, check, check_hits
from ._core import VERSION as __version__
from ._hits import PARTS, SOLIDS, AllHits, Hits, Located
from ._picture import Picture, render
from ._prototype import Prototype
from ._scene import Scene, load
from ._solid import Solid
from ._tracer import Tracer

__all__ = [
    "CLASSES",
    "PARTS",
    "SOLIDS",
    "AllHits",
    "Check",
    "Hits",
    "Intersector",
    "Located",
    "Picture",
    "Prototype",
    "Scene",
    "Solid",
    "Tracer",
    "__version__",
    "check",
    "check_hits",
    "load",
    "render",
]
