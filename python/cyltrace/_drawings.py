"""What makes pictures easier to read, or cuts them open."""

from __future__ import annotations

from typing import Any, Literal

import numpy.typing as npt

from . import _core
from ._statement import statement

Corner = Literal["top left", "top right", "bottom left", "bottom right"]


class Drawings:
    """Clip planes, outlines, depth cue, and what is drawn over the corners of pictures.

    What is not given has the default of a scene file (docs/scene-file.md). Colors are linear RGB
    in [0, 1]. A second call of a ``set_`` method replaces what the
    first one has set.
    """

    _core: _core.Scene

    def _state(self, key: str, /, **keys: Any) -> None:
        """States a table of a scene file."""
        self._core.state(key, statement(**keys))

    def add_clip(
        self,
        point: npt.ArrayLike,
        normal: npt.ArrayLike,
        material: str | None = None,
        shadows: bool = True,
    ) -> None:
        """Cuts pictures open: what is on the side of a plane that its normal points to is removed.

        Parameters
        ----------
        point, normal : (3,)
            The plane.
        material : str, optional
            That of the cut faces, of one color and not glass; otherwise, that of each solid.
        shadows : bool
            Whether what is removed still casts shadows and is seen in mirrors.
        """
        self._state("clip", point=point, normal=normal, material=material, shadows=shadows)

    def set_outlines(
        self,
        width: float | None = None,
        color: npt.ArrayLike | None = None,
        *,
        crease_degrees: float | None = None,
        between_solids: bool | None = None,
    ) -> None:
        """Draws lines where surfaces end.

        Parameters
        ----------
        width : float in (0, 32]
            In pixels: 1 by default.
        color : (3,)
            Black by default.
        crease_degrees : float in (0, 180]
            The angle between neighboring normals above which there is a line: 30 by default.
        between_solids : bool
            Whether there are lines between solids that continue each other smoothly: True by
            default.
        """
        self._state(
            "outlines",
            width=width,
            color=color,
            crease_degrees=crease_degrees,
            between_solids=between_solids,
        )

    def set_depth_cue(
        self,
        color: npt.ArrayLike | None = None,
        *,
        start: float | None = None,
        end: float | None = None,
        strength: float | None = None,
    ) -> None:
        """Lets surfaces fade with their distance along the view.

        Parameters
        ----------
        color : (3,)
            What they fade to: the background by default.
        start, end : float
            The distances where fading begins and ends: those of the scene's box by default.
        strength : float in [0, 1]
            The share of the color at the end: 0.8 by default.
        """
        self._state("depth_cue", color=color, start=start, end=end, strength=strength)

    def set_scale_bar(
        self,
        length: float | None = None,
        unit: str | None = None,
        *,
        corner: Corner | None = None,
        size: float | None = None,
        color: npt.ArrayLike | None = None,
        background: npt.ArrayLike | None = None,
        opacity: float | None = None,
    ) -> None:
        """Draws a bar with its length over pictures.

        Parameters
        ----------
        length : float
            In scene units: a round number near a fifth of the picture's width by default.
        unit : str
            The text after the number.

        The other parameters are those of :meth:`set_legend`; the corner is "bottom left" by
        default.
        """
        self._state(
            "scale_bar",
            length=length,
            unit=unit,
            corner=corner,
            size=size,
            color=color,
            background=background,
            opacity=opacity,
        )

    def set_axes(
        self,
        labels: bool | None = None,
        *,
        corner: Corner | None = None,
        size: float | None = None,
        color: npt.ArrayLike | None = None,
        background: npt.ArrayLike | None = None,
        opacity: float | None = None,
    ) -> None:
        """Draws the axes of the world over pictures.

        Parameters
        ----------
        labels : bool
            Whether they have their names: True by default.

        The other parameters are those of :meth:`set_legend`; the corner is "top left" by default.
        """
        self._state(
            "axes",
            labels=labels,
            corner=corner,
            size=size,
            color=color,
            background=background,
            opacity=opacity,
        )

    def set_legend(
        self,
        material: str,
        title: str | None = None,
        *,
        corner: Corner | None = None,
        size: float | None = None,
        color: npt.ArrayLike | None = None,
        background: npt.ArrayLike | None = None,
        opacity: float | None = None,
    ) -> None:
        """Draws the legend of a material that shows a column over pictures.

        Parameters
        ----------
        material : str
        title : str
            The line above it: the column by default.
        corner : "top left", "top right", "bottom left" or "bottom right"
            "bottom right" by default. Two things in one corner are an error.
        size : float in [0.005, 0.2]
            The height of the text over that of the picture: 0.03 by default.
        color, background : (3,)
            Of the text, and behind it: black and white by default.
        opacity : float in [0, 1]
            Of the background: 0.8 by default.
        """
        self._state(
            "legend",
            material=material,
            title=title,
            corner=corner,
            size=size,
            color=color,
            background=background,
            opacity=opacity,
        )
