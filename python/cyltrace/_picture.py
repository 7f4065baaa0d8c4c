"""Pictures of scenes."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import shape
from ._scene import Scene
from ._tracer import Progress, Tracer

Channel = Literal["depth", "position", "normal", "albedo", "uv", "ids", "variance", "samples"]
ToneMap = Literal["none", "pbr-neutral", "agx"]


@dataclass(frozen=True, slots=True)
class Request:
    """How to render; None is as the scene has it."""

    size: tuple[int, int] | None
    spp: int | None
    integrator: str | None
    seed: int
    channels: list[str]
    error: float | None
    time: float | None


@dataclass(frozen=True, slots=True)
class Pixels:
    """What is written of a picture."""

    width: int
    height: int
    colors: npt.NDArray[np.float32]
    has_opacity: bool
    channels: list[str]
    #: One for opacity, if there is, then those of the channels, pixel by pixel.
    words: npt.NDArray[np.uint32]
    error: float | None
    insets: _core.Insets | None


class Picture(np.ndarray[Any, np.dtype[np.float32]]):
    """A picture: an array of shape (height, width, 3), float32, linear RGB.

    A notebook shows it. :meth:`save` writes what the program writes, with legend, scale bar and
    axes over it.

    A part of a picture, as ``picture[10:50, ::2]``, is a picture with that part of the opacity and
    of the channels, but without legend, scale bar, axes and error. All else that is computed from
    a picture or selected in it has colors only; ``picture *= 2`` changes the picture itself.

    Attributes
    ----------
    opacity : (height, width) float32, or None
        The part of a pixel's samples that hit, if the background is transparent. The colors are
        multiplied by it.
    channels : dict of arrays
        (height, width) or (height, width, n), by the names of ``channels`` of :func:`render`:
        float32, or uint32 for ``ids`` and ``samples``.
    error : float or None
        The greatest estimated error of a tile, if :func:`render` had ``error`` or ``time``.
    tiles_above : int or None
        The number of tiles whose error is greater than the ``error`` of :func:`render`.
    """

    opacity: npt.NDArray[np.float32] | None
    channels: dict[str, npt.NDArray[Any]]
    error: float | None
    tiles_above: int | None
    _insets: _core.Insets | None

    def __array_finalize__(self, parent: Any) -> None:
        self.opacity = self.error = self.tiles_above = self._insets = None
        self.channels = {}

    def __getitem__(self, key: Any) -> Any:
        part = super().__getitem__(key)
        keys = key if isinstance(key, tuple) else (key,)
        if len(keys) <= 2 and all(isinstance(one, slice) for one in keys):
            if self.opacity is not None:
                part.opacity = self.opacity[key]
            part.channels = {name: channel[key] for name, channel in self.channels.items()}
        return part

    def save(
        self, path: str | os.PathLike[str], exposure: float = 0.0, tonemap: ToneMap = "none"
    ) -> None:
        """Writes the picture: ``.png`` in 8-bit sRGB, or ``.exr`` in linear f32 with all channels.
        The file is complete or not there.

        Parameters
        ----------
        path : str or path
        exposure : float in [-64, 64]
            Multiplies the colors of a PNG by 2 to this power.
        tonemap : "none", "pbr-neutral" or "agx"
            How a PNG shows the light beyond white; ``none`` clamps it.

        Raises
        ------
        OSError
            If the file cannot be written.
        ValueError
            If the name ends otherwise, a PNG would have channels, the array is no longer (height,
            width, 3), or opacity or a channel do not fit to it. If the picture has a legend, whose
            colors ``exposure`` and ``tonemap`` would change.
        """
        pixels = self._pixels(list(self.channels))
        _core.write_picture(os.fspath(path), pixels, float(exposure), tonemap)

    def _repr_png_(self) -> bytes:
        return _core.png(self._pixels([]))

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        # What is computed of all pixels is a number, not a picture.
        return array[()] if array.ndim == 0 else super().__array_wrap__(array, context)

    def _pixels(self, channels: list[str]) -> Pixels:
        """What is written, with some of the channels."""
        if self.ndim != 3 or self.shape[2] != 3 or self.size == 0:
            raise ValueError(f"a picture has the shape (height, width, 3), not {self.shape}")
        height, width = int(self.shape[0]), int(self.shape[1])
        known = {name: (words, is_float) for name, words, is_float in _core.CHANNELS}
        for name in channels:
            if name not in known:
                names = ", ".join(known)
                raise ValueError(f"there is no channel {name!r}: there are {names}")
        columns = []
        if self.opacity is not None:
            columns.append(_words("opacity", self.opacity, (height, width), 1, True))
        # In the order in which the program writes them.
        ordered = [name for name in known if name in channels]
        for name in ordered:
            columns.append(_words(name, self.channels[name], (height, width), *known[name]))
        empty = np.empty((height, width, 0), dtype=np.uint32)
        return Pixels(
            width,
            height,
            np.ascontiguousarray(self, dtype=np.float32).view(np.ndarray).reshape(-1),
            self.opacity is not None,
            ordered,
            np.concatenate([empty, *columns], axis=2).reshape(-1),
            self.error,
            self._insets,
        )


def _words(
    name: str, channel: npt.NDArray[Any], size: tuple[int, int], words: int, is_float: bool
) -> npt.NDArray[np.uint32]:
    """The words of a channel, of shape (height, width, words)."""
    dtype = np.dtype(np.float32 if is_float else np.uint32)
    expected = size if words == 1 else (*size, words)
    if channel.shape != expected or channel.dtype != dtype:
        raise ValueError(
            f"{name} has the shape {shape(channel.shape)} and the dtype {channel.dtype}: "
            f"it must be {shape(expected)} and {dtype}"
        )
    return np.ascontiguousarray(channel).view(np.uint32).reshape(*size, words)


def render(
    scene: Scene | Tracer,
    size: tuple[int, int] | None = None,
    spp: int | None = None,
    integrator: Literal["sun", "normal", "ao", "path"] | None = None,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
    *,
    channels: Iterable[Channel] = (),
    error: float | None = None,
    time: float | None = None,
) -> Picture:
    """Renders a scene, as ``cyltrace render`` does: the same scene, settings and seed give the
    same bits on any number of threads.

    Parameters
    ----------
    scene : Scene or Tracer
    size : (width, height), optional
        In pixels; the scene's own otherwise, which is 1280 x 720 unless it states more.
    spp : int, optional
        Samples a pixel; the scene's own otherwise, 4 by default. With ``error`` or ``time``, the
        most that a pixel gets, 16384 by default.
    integrator : "sun", "normal", "ao" or "path", optional
        Sun and sky with shadows, normals as colors, ambient occlusion, or light that is
        scattered any number of times, by materials of all kinds. The scene's own otherwise: what
        it states, or ``sun``, or ``path`` if the scene has a material that is not diffuse, a light
        with a place, an environment or a clear sky.
    seed : int
        Chooses the random numbers.
    threads : int, optional
        How many threads build and trace. A tracer has its own.
    progress : callable, optional
        Called as ``progress(done, total)`` with pixels.
    channels : names
        What :attr:`Picture.channels` gets: ``depth``, ``position``, ``normal``, ``albedo``,
        ``uv``, ``ids`` (primitive, prototype, material, instance, path), ``variance`` and
        ``samples``, as the program's ``--channels``. Those of the surface are of a ray through
        the middle of each pixel.
    error : float, optional
        Renders until the estimated relative error of every tile of 16 x 16 pixels is at most
        this.
    time : float, optional
        Renders for at most this many seconds. The picture depends on the speed of the machine.

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
    >>> picture = cyltrace.render(scene, size=(64, 48), channels=["depth", "ids"])
    >>> picture.shape, picture.dtype
    ((48, 64, 3), dtype('float32'))
    >>> picture.channels["depth"].shape, picture.channels["ids"].shape
    ((48, 64), (48, 64, 5))
    """
    tracer = scene if isinstance(scene, Tracer) else Tracer(scene, threads)
    tracer._scene._core.check_shown()
    names: list[str] = [channels] if isinstance(channels, str) else [*channels]
    request = Request(size, spp, integrator, seed, names, error, time)
    rendered = _core.render(tracer._core, request, progress)
    height, width = rendered.height, rendered.width
    picture = rendered.colors.reshape(height, width, 3).view(Picture)
    words = rendered.words.reshape(height, width, -1) if rendered.words.size else rendered.words
    place = 0
    if rendered.has_opacity:
        picture.opacity = _numbers(words, 0, 1, True)
        place = 1
    for name, count, is_float in _core.CHANNELS:
        if name in names:
            picture.channels[name] = _numbers(words, place, count, is_float)
            place += count
    if rendered.reached is not None:
        picture.error, picture.tiles_above = rendered.reached
    picture._insets = rendered.insets
    return picture


def _numbers(
    words: npt.NDArray[np.uint32], first: int, count: int, is_float: bool
) -> npt.NDArray[Any]:
    """Some words of each pixel as numbers; one alone has no axis."""
    some = words[..., first] if count == 1 else words[..., first : first + count]
    numbers = np.ascontiguousarray(some)
    return numbers.view(np.float32) if is_float else numbers
