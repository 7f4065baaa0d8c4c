"""Scenes."""

from __future__ import annotations

import os
from typing import Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import vector
from ._prototype import Prototype

Kind = Literal["diffuse", "metal", "plastic", "glass", "light"]


class Scene(Prototype):
    """A scene: solids, placed prototypes, materials, lights and a camera.

    Parameters
    ----------
    records : "f64" or "f32"
        The precision in which cylinders are kept: 64 or 32 bytes each. In f32 they are
        rounded once, and hits are those of the rounded cylinders, as exact as ever.

    Examples
    --------
    >>> import cyltrace
    >>> scene = cyltrace.Scene()
    >>> scene.add_spheres([[0, 0, 0], [3, 0, 0]], 1.0)
    array([0, 1])
    >>> scene
    <cyltrace scene: 2 solids, 0 placements>
    """

    def __init__(self, records: Literal["f64", "f32"] = "f64") -> None:
        self._become(_core.Scene(records))

    def _become(self, core: _core.Scene, path: str | None = None) -> None:
        self._core = core
        self._path = path
        super().__init__(self, 0, "")
        names = core.prototype_names()[1:]
        self._prototypes = {
            name: Prototype(self, index, name) for index, name in enumerate(names, 1)
        }
        self._materials = {name: code for code, name in enumerate(core.material_names())}

    @property
    def prototypes(self) -> dict[str, Prototype]:
        """The prototypes by their names, without the scene itself."""
        return dict(self._prototypes)

    @property
    def notes(self) -> list[str]:
        """What loading found worth a note, such as columns that are not read."""
        return self._core.notes

    @property
    def skipped_rows(self) -> int:
        """The rows that were left out because of ``degenerate="skip"``."""
        return self._core.skipped_rows

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene as a scene file with tables beside it, which loads to the same.

        Solids, placements, materials, camera and lights are kept to the last bit, with the
        numbers of solids and placements. ``values`` are not part of a scene file.

        Parameters
        ----------
        path : str or path
            Ends in ``.toml``. Tables get its name and ``_cylinders_1.csv`` and the like.

        Raises
        ------
        OSError
            If a file cannot be written. Then none is changed.
        ValueError
            If the scene states what a scene file cannot, or the file would have more than
            64 MiB: cylinders and placements are in tables, but each other solid takes some
            hundred bytes of it.
        """
        folder, name = os.path.split(os.fspath(path))
        stem, ending = os.path.splitext(name)
        if ending != ".toml":
            raise ValueError(f"{name!r} does not end in .toml")
        self._core.save(folder, stem)

    def prototype(self, name: str) -> Prototype:
        """Makes a prototype, or returns the one that has this name already."""
        if not name:
            raise ValueError("a prototype needs a name")
        if name not in self._prototypes:
            index = self._core.add_prototype(name)
            self._prototypes[name] = Prototype(self, index, name)
        return self._prototypes[name]

    def add_material(
        self,
        name: str,
        color: npt.ArrayLike | None = None,
        kind: Kind = "diffuse",
        *,
        roughness: float | None = None,
        ior: float | None = None,
        strength: float | None = None,
    ) -> str:
        """Adds a material and returns its name.

        Pictures of a scene with one that is not diffuse have the integrator ``path`` in place of
        ``sun``.

        Parameters
        ----------
        name : str
            Not empty, and not the name of another material.
        color : (3,)
            Linear RGB, each in [0, 1]: the reflectance, or what glass lets through, or the
            color of a light. Glass and lights are white by default.
        kind : "diffuse", "metal", "plastic", "glass" or "light"
        roughness : float in [0, 1], optional
            Of metal (0.3 by default), plastic (0.2) and glass (0).
        ior : float in [1, 10], optional
            The index of refraction of plastic and glass: 1.5 by default.
        strength : float, optional
            Factor on the color of a light, which is its radiance: 1 by default.
        """
        if not name or name in self._materials:
            reason = "is in use" if name else "is empty"
            raise ValueError(f"the name {name!r} of a material {reason}")
        if color is None:
            if kind not in ("glass", "light"):
                raise ValueError(f"the material {name!r} has no color")
            color = (1.0, 1.0, 1.0)
        reflectance = vector("color", color)
        if not all(0.0 <= part <= 1.0 for part in reflectance):
            raise ValueError(f"color is {reflectance}: each number must be in [0, 1]")
        numbers = [roughness, ior, strength]
        stated = [None if number is None else float(number) for number in numbers]
        self._materials[name] = self._core.add_material(name, reflectance, kind, stated)
        return name

    def set_camera(
        self,
        position: npt.ArrayLike | None = None,
        look_at: npt.ArrayLike | None = None,
        up: npt.ArrayLike = (0.0, 0.0, 1.0),
        *,
        fov_degrees: float = 40.0,
        orthographic: bool = False,
        height: float | None = None,
        aperture: float = 0.0,
        focus: float | None = None,
    ) -> None:
        """Aims the camera. Without ``position`` and ``look_at``, the whole scene is in the picture.

        Parameters
        ----------
        position, look_at : (3,), optional
            The eye and a point in the middle of the picture: both or neither.
        up : (3,)
            The direction that is upward in the picture, not along the view.
        fov_degrees : float in (0, 180)
            The vertical angle of view of a perspective.
        orthographic : bool
            Whether lines of sight are parallel.
        height : float, optional
            Scene units across the height of an orthographic picture; fits the scene otherwise.
        aperture : float
            The diameter of the lens in scene units; with 0, everything is sharp.
        focus : float, optional
            The distance of what a lens shows sharply; that of ``look_at`` otherwise.
        """
        if (position is None) != (look_at is None):
            raise ValueError("position and look_at go together: give both or neither")
        if not 0.0 < fov_degrees < 180.0:
            raise ValueError(f"fov_degrees is {fov_degrees}: it must be between 0 and 180")
        if height is not None and not 0.0 < height < np.inf:
            raise ValueError(f"height is {height}: it must be positive")
        if not 0.0 <= aperture < np.inf:
            raise ValueError(f"aperture is {aperture}: it must be finite and not negative")
        if focus is not None and not 0.0 < focus < np.inf:
            raise ValueError(f"focus is {focus}: it must be positive")
        upward = np.array(vector("up", up))
        if position is not None and look_at is not None:
            eye = np.array(vector("position", position))
            view = np.array(vector("look_at", look_at)) - eye
            # As a scene file demands: the sine of the angle between them is at least 1e-6.
            lengths = float(np.linalg.norm(view) * np.linalg.norm(upward))
            if not float(np.linalg.norm(np.cross(view, upward))) >= 1e-6 * lengths > 0.0:
                raise ValueError(
                    "position, look_at and up leave no picture: look_at must be another point "
                    "than position, and up not along the view"
                )
        self._core.set_camera(
            None if position is None else vector("position", position),
            None if look_at is None else vector("look_at", look_at),
            vector("up", up),
            orthographic,
            float(fov_degrees),
            None if height is None else float(height),
            (float(aperture), None if focus is None else float(focus)) if aperture else None,
        )

    def set_sun(
        self,
        direction: npt.ArrayLike | None = None,
        *,
        elevation_degrees: float = 40.0,
        azimuth_degrees: float = 135.0,
        color: npt.ArrayLike = (1.0, 0.95, 0.9),
        strength: float = 3.0,
        angle_degrees: float = 0.53,
    ) -> None:
        """Adds the sun, or replaces it.

        Parameters
        ----------
        direction : (3,), optional
            Towards the sun, of any length; instead of the two angles.
        elevation_degrees : float in [-90, 90]
            The angle above the x-y plane.
        azimuth_degrees : float
            The angle from the x axis towards the y axis.
        color : (3,)
            Linear RGB, not negative.
        strength : float
            Factor on ``color``: irradiance on a surface that faces the sun.
        angle_degrees : float in [0, 90]
            The angle that the sun spans. With 0, shadows are sharp.
        """
        if not 0.0 <= angle_degrees <= 90.0:
            raise ValueError(f"angle_degrees is {angle_degrees}: it must be in [0, 90]")
        if direction is None:
            if not -90.0 <= elevation_degrees <= 90.0:
                raise ValueError(
                    f"elevation_degrees is {elevation_degrees}: it must be in [-90, 90]"
                )
            up, around = np.radians([elevation_degrees, azimuth_degrees])
            towards = np.array(
                [np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)]
            )
        else:
            towards = np.array(vector("direction", direction))
        length = float(np.linalg.norm(towards))
        if not 0.0 < length < np.inf:
            raise ValueError(f"direction is {towards.tolist()}: it must not be zero")
        unit = (towards / length).tolist()
        light = (_light("color", color), _strength(strength))
        self._core.set_sun(unit, *light, float(angle_degrees))

    def set_sky(self, color: npt.ArrayLike = (0.5, 0.7, 1.0), strength: float = 1.0) -> None:
        """Adds light from every direction, which is also seen behind the scene.

        Parameters
        ----------
        color : (3,)
            Linear RGB, not negative.
        strength : float
            Factor on ``color``.
        """
        self._core.set_sky(_light("color", color), _strength(strength))

    def add_point_light(
        self, position: npt.ArrayLike, color: npt.ArrayLike = (1, 1, 1), strength: float = 1.0
    ) -> None:
        """Adds a light without an extent, for pictures with the integrator ``path``.

        ``strength`` is the factor on ``color``, linear RGB: the radiant intensity.
        """
        self._add_light(vector("position", position), None, None, color, strength)

    def add_sphere_light(
        self,
        center: npt.ArrayLike,
        radius: float,
        color: npt.ArrayLike = (1, 1, 1),
        strength: float = 1.0,
    ) -> None:
        """Adds a sphere that emits light outward, for pictures with the integrator ``path``.

        ``strength`` is the factor on ``color``, linear RGB: the radiance.
        """
        if not 0.0 < radius < np.inf:
            raise ValueError(f"radius is {radius}: it must be positive")
        self._add_light(vector("center", center), float(radius), None, color, strength)

    def add_rectangle_light(
        self,
        corner: npt.ArrayLike,
        edges: npt.ArrayLike,
        color: npt.ArrayLike = (1, 1, 1),
        strength: float = 1.0,
    ) -> None:
        """Adds a rectangle that emits light on one side, for pictures with the integrator
        ``path``.

        Parameters
        ----------
        corner : (3,)
        edges : (2, 3)
            From that corner. Light leaves to the side of their cross product.
        color : (3,)
            Linear RGB, not negative.
        strength : float
            Factor on ``color``: the radiance.
        """
        both = np.asarray(edges, dtype=np.float64)
        if both.shape != (2, 3) or not np.isfinite(both).all():
            raise ValueError(f"edges are {both.tolist()}: they must be two finite vectors")
        lengths = float(np.prod(np.linalg.norm(both, axis=1)))
        # As a scene file demands.
        if not float(np.linalg.norm(np.cross(both[0], both[1]))) >= 1e-6 * lengths > 0.0:
            raise ValueError("the edges are parallel: they must span the rectangle")
        self._add_light(vector("corner", corner), None, both.tolist(), color, strength)

    def _add_light(
        self,
        place: list[float],
        radius: float | None,
        edges: list[list[float]] | None,
        color: npt.ArrayLike,
        strength: float,
    ) -> None:
        light = (_light("color", color), _strength(strength))
        self._core.add_light(place, radius, edges, *light)

    def set_background(self, color: npt.ArrayLike) -> None:
        """The linear RGB that is seen where a scene without a sky is not hit."""
        self._core.set_background(_light("color", color))

    def _material(self, name: str | None) -> int:
        if name is None:
            return 0
        if not name or name not in self._materials:
            known = ", ".join(repr(other) for other in self._materials if other)
            raise ValueError(f"there is no material {name!r}: there are {known or 'none'}")
        return self._materials[name]


def load(path: str | os.PathLike[str]) -> Scene:
    """Loads a scene file, with the tables and other files that it names.

    Parameters
    ----------
    path : str or path
        A scene in TOML (docs/scene-file.md).

    Raises
    ------
    OSError
        If the file cannot be opened.
    ValueError
        If it is no scene: the file, the line and what would be right.
    """
    scene = Scene.__new__(Scene)
    scene._become(_core.Scene.load(os.fspath(path)), os.fspath(path))
    return scene


def _light(name: str, value: npt.ArrayLike) -> list[float]:
    color = vector(name, value)
    if min(color) < 0.0:
        raise ValueError(f"{name} is {color}: no number may be negative")
    return color


def _strength(value: float) -> float:
    strength = float(value)
    if not 0.0 <= strength < np.inf:
        raise ValueError(f"strength is {strength}: it must be finite and not negative")
    return strength
