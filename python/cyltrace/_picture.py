"""Pictures of scenes."""

from __future__ import annotations

import os
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._scene import Scene
from ._tracer import Progress, Tracer


class Picture(np.ndarray[Any, np.dtype[np.float32]]):
    """A picture: an array of shape (height, width, 3), float32, linear RGB.

    A notebook shows it. :meth:`save` writes what the program writes.
    """

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture: ``.png`` in 8-bit sRGB, clamped, or ``.exr`` in linear f32. The
        file is complete or not there.

        Raises
        ------
        OSError
            If the file cannot be written.
        ValueError
            If the name ends otherwise, or the array is no longer (height, width, 3).
        """
        height, width = self._size()
        _core.write_picture(os.fspath(path), width, height, self._flat())

    def _repr_png_(self) -> bytes:
        height, width = self._size()
        return _core.png(width, height, self._flat())

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        # What is computed of all pixels is a number, not a picture.
        return array[()] if array.ndim == 0 else super().__array_wrap__(array, context)

    def _size(self) -> tuple[int, int]:
        if self.ndim != 3 or self.shape[2] != 3 or self.size == 0:
            raise ValueError(f"a picture has the shape (height, width, 3), not {self.shape}")
        return int(self.shape[0]), int(self.shape[1])

    def _flat(self) -> npt.NDArray[np.float32]:
        return np.ascontiguousarray(self, dtype=np.float32).view(np.ndarray).reshape(-1)


def render(
    scene: Scene | Tracer,
    size: tuple[int, int] | None = None,
    spp: int | None = None,
    integrator: Literal["sun", "normal", "ao", "path"] | None = None,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Picture:
    """Renders a scene, as ``cyltrace render`` does: the same scene, settings and seed give the
    same bits on any number of threads. Legend, scale bar and axes are not drawn, and a
    transparent background is black.

    Parameters
    ----------
    scene : Scene or Tracer
    size : (width, height), optional
        In pixels; the scene's own otherwise, which is 1280 x 720 unless its file says more.
    spp : int, optional
        Samples a pixel; the scene's own otherwise, 4 by default.
    integrator : "sun", "normal", "ao" or "path", optional
        Sun and sky with shadows, normals as colors, ambient occlusion, or light that is
        scattered any number of times, by materials of all kinds. ``sun`` by default, or ``path``
        if the scene has a material that is not diffuse, a light with a place, an environment
        or a clear sky.
    seed : int
        Chooses the random numbers.
    threads : int, optional
        How many threads build and trace. A tracer has its own.
    progress : callable, optional
        Called as ``progress(done, total)`` with pixels.

    Returns
    -------
    Picture
        (height, width, 3) float32, linear RGB.

    Examples
    --------
    >>> import cyltrace
    >>> scene = cyltrace.Scene()
    >>> scene.add_cylinders([0, 0, 0], [0, 0, 2], 0.5)
    array([0])
    >>> picture = cyltrace.render(scene, size=(64, 48))
    >>> picture.shape, picture.dtype
    ((48, 64, 3), dtype('float32'))
    """
    tracer = scene if isinstance(scene, Tracer) else Tracer(scene, threads)
    width, height = size if size is not None else (None, None)
    width, height, pixels = _core.render(
        tracer._core, width, height, spp, integrator, seed, progress
    )
    return pixels.reshape(height, width, 3).view(Picture)
