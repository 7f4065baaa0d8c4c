"""Camera, lights, materials and settings of pictures."""

from __future__ import annotations

import os
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from ._arrays import real, shape, vector
from ._drawings import Drawings
from ._statement import statement

Kind = Literal["diffuse", "metal", "plastic", "glass", "light"]


class Look(Drawings):
    """What pictures of a scene look like.

    What is not given has the default of a scene file (docs/scene-file.md).
    """

    _materials: dict[str, int]

    def add_material(
        self,
        name: str,
        color: npt.ArrayLike | dict[str, Any] | None = None,
        kind: Kind = "diffuse",
        *,
        roughness: float | None = None,
        ior: float | None = None,
        strength: float | None = None,
        column: str | None = None,
        map: str | None = None,
        range: tuple[float, float] | Literal["auto"] | None = None,
        labels: list[str] | None = None,
        missing: npt.ArrayLike | None = None,
    ) -> str:
        """Adds a material and returns its name.

        Pictures of a scene with one that is not diffuse have the integrator ``path`` in place of
        ``sun``, unless the scene states an integrator.

        Parameters
        ----------
        name : str
            Not empty, and not the name of another material.
        color : (3,) or dict
            Linear RGB, each in [0, 1]: the reflectance, or what glass lets through, or the
            color of a light. Glass and lights are white by default. A dict has the keys of a
            pattern or image in a scene file, as ``{"checker": [[1, 1, 1], [0, 0, 0]], "count":
            [8, 8]}`` or ``{"image": "bark.png"}``.
        kind : "diffuse", "metal", "plastic", "glass" or "light"
        roughness : float in [0, 1], optional
            Of metal (0.3 by default), plastic (0.2) and glass (0).
        ior : float in [1, 10], optional
            The index of refraction of plastic and glass: 1.5 by default.
        strength : float, optional
            Factor on the color of a light, which is its radiance: 1 by default.
        column : str, optional
            Shows the value that each solid, or placement around it, has in this column, in place
            of ``color``: see ``values`` of :meth:`add_cylinders` and :meth:`add_instances`.
        map : str, optional
            The color map: ``viridis`` by default. ``tab10`` and others show categories.
        range : (least, greatest) or "auto", optional
            The values of its first and last color: by default, the least and the greatest one that
            are added to the scene in that column.
        labels : list of str, optional
            Texts that stand for the values 0, 1, 2 and so on; the legend shows them.
        missing : (3,), optional
            The color without a value: gray by default.
        """
        if not name or name in self._materials:
            reason = "is in use" if name else "is empty"
            raise ValueError(f"the name {name!r} of a material {reason}")
        data = statement(column=column, map=map, range=range, labels=labels, missing=missing)
        if data and color is not None:
            raise ValueError("color and column exclude each other: give one of them")
        if isinstance(color, dict) and "image" in color:
            _check_file(color["image"])
            color = {**color, "image": os.fspath(color["image"])}
        self._state(
            "material",
            name=name,
            color=data or color,
            kind=kind,
            roughness=roughness,
            ior=ior,
            strength=strength,
        )
        self._materials[name] = len(self._materials)
        return name

    def set_camera(
        self,
        position: npt.ArrayLike | None = None,
        look_at: npt.ArrayLike | None = None,
        up: npt.ArrayLike | None = None,
        *,
        fov_degrees: float | None = None,
        orthographic: bool = False,
        panorama: bool = False,
        height: float | None = None,
        aperture: float | None = None,
        focus: float | None = None,
    ) -> None:
        """Aims the camera. Without ``position`` and ``look_at``, the whole scene is in the picture.

        Parameters
        ----------
        position, look_at : (3,), optional
            The eye and a point in the middle of the picture: both or neither.
        up : (3,), optional
            The direction that is upward in the picture, not along the view: z by default.
        fov_degrees : float in (0, 180), optional
            The vertical angle of view of a perspective: 40 by default.
        orthographic : bool
            Whether lines of sight are parallel.
        panorama : bool
            Whether the picture shows all directions, as a map: longitude across and latitude
            upward. Without ``position``, they are seen from the center of the scene's box.
        height : float, optional
            Scene units across the height of an orthographic picture; fits the scene otherwise.
        aperture : float, optional
            The diameter of the lens in scene units; with 0, the default, everything is sharp.
        focus : float, optional
            The distance of what a lens shows sharply; that of ``look_at`` otherwise.
        """
        if orthographic and panorama:
            raise ValueError("orthographic and panorama exclude each other: give one of them")
        kind = "orthographic" if orthographic else "panorama" if panorama else "perspective"
        self._state(
            "camera",
            type=kind,
            position=position,
            look_at=look_at,
            up=up,
            fov_degrees=fov_degrees,
            height=height,
            aperture=aperture,
            focus=focus,
        )

    def set_film(self, width: int | None = None, height: int | None = None) -> None:
        """The size of pictures in pixels: 1280 x 720 by default. None leaves it as it is."""
        self._state("film", width=width, height=height)

    def set_render(
        self,
        integrator: Literal["sun", "normal", "ao", "path"] | None = None,
        spp: int | None = None,
        *,
        max_depth: int | None = None,
        ao_distance: float | None = None,
        sampler: Literal["sobol", "random"] | None = None,
    ) -> None:
        """How pictures are computed, where :func:`render` leaves a choice. None leaves it as it is.

        Parameters
        ----------
        integrator : "sun", "normal", "ao" or "path", optional
            What a pixel shows. What is stated here stays, whatever lights and materials are added.
        spp : int, optional
            Samples a pixel: 4 by default.
        max_depth : int, optional
            The most rays of a path of ``path``: 16 by default.
        ao_distance : float, optional
            The distance beyond which surfaces do not occlude under ``ao``: any by default.
        sampler : "sobol" or "random", optional
            How samples are spread: ``sobol`` by default.
        """
        self._state(
            "render",
            integrator=integrator,
            spp=spp,
            max_depth=max_depth,
            ao_distance=ao_distance,
            sampler=sampler,
        )

    def set_sun(
        self,
        direction: npt.ArrayLike | None = None,
        *,
        elevation_degrees: float | None = None,
        azimuth_degrees: float | None = None,
        color: npt.ArrayLike | None = None,
        strength: float | None = None,
        angle_degrees: float | None = None,
    ) -> None:
        """Adds the sun, or replaces it.

        Parameters
        ----------
        direction : (3,), optional
            Towards the sun, of any length; instead of the two angles.
        elevation_degrees : float in [-90, 90], optional
            The angle above the x-y plane: 40 by default.
        azimuth_degrees : float, optional
            The angle from the x axis towards the y axis: 135 by default.
        color : (3,), optional
            Linear RGB, not negative: (1, 0.95, 0.9) by default, or as a clear sky has it.
        strength : float, optional
            Factor on ``color``: irradiance on a surface that faces the sun, 3 by default, or as
            a clear sky has it.
        angle_degrees : float in [0, 90], optional
            The angle that the sun spans: 0.53 by default. With 0, shadows are sharp.
        """
        self._state(
            "sun",
            direction=direction,
            elevation_degrees=elevation_degrees,
            azimuth_degrees=azimuth_degrees,
            color=color,
            strength=strength,
            angle_degrees=angle_degrees,
        )

    def set_sky(
        self,
        color: npt.ArrayLike | None = None,
        strength: float | None = None,
        *,
        model: Literal["constant", "clear"] | None = None,
        turbidity: float | None = None,
        ground: npt.ArrayLike | None = None,
    ) -> None:
        """Adds light from every direction, which is also seen behind the scene. It replaces
        another sky or an environment.

        Parameters
        ----------
        color : (3,), optional
            Linear RGB, not negative: (0.5, 0.7, 1) by default.
        strength : float, optional
            Factor on the light: 1 by default.
        model : "constant" or "clear", optional
            ``clear`` is the sky of a clear day, whose colors follow from the turbidity and the
            sun; it has a sun.
        turbidity : float in [2, 10], optional
            How hazy a clear sky is: 3 by default.
        ground : (3,), optional
            The reflectance of the ground below a clear sky: 0.2 by default.
        """
        self._state(
            "sky", color=color, strength=strength, model=model, turbidity=turbidity, ground=ground
        )

    def set_environment(
        self,
        picture: str | os.PathLike[str] | npt.ArrayLike,
        strength: float = 1.0,
        rotate_degrees: float = 0.0,
    ) -> None:
        """Makes a picture of all directions the light around the scene, in place of a sky.

        Parameters
        ----------
        picture : path, or (height, width, 3)
            A picture in Radiance HDR or OpenEXR, or linear RGB from the top row down, as a panorama
            camera that looks along x renders it. It is kept in f32.
        strength : float
            Factor on the pixels, not negative.
        rotate_degrees : float
            Turns the picture about z.

        Raises
        ------
        OSError
            If the file cannot be opened.
        ValueError
            If it is no such picture, or a number is wrong.
        """
        if isinstance(picture, (str, os.PathLike)):
            _check_file(picture)
            self._state(
                "environment",
                file=os.fspath(picture),
                strength=strength,
                rotate_degrees=rotate_degrees,
            )
            return
        numbers = real("picture", picture)
        if numbers.ndim != 3 or numbers.shape[2] != 3:
            raise ValueError(
                f"picture has the shape {shape(numbers.shape)}: it must be (height, width, 3)"
            )
        if not 0.0 <= strength < np.inf:
            raise ValueError(f"strength is {strength}: it must be finite and not negative")
        if not np.isfinite(rotate_degrees):
            raise ValueError(f"rotate_degrees is {rotate_degrees}: it must be finite")
        with np.errstate(over="ignore"):
            pixels = numbers.astype(np.float32).reshape(-1)
        height, width, _ = numbers.shape
        self._core.set_environment(width, height, pixels, float(strength), float(rotate_degrees))

    def add_point_light(
        self, position: npt.ArrayLike, color: npt.ArrayLike = (1, 1, 1), strength: float = 1.0
    ) -> None:
        """Adds a light without an extent, for pictures with the integrator ``path``.

        ``strength`` is the factor on ``color``, linear RGB: the radiant intensity.
        """
        self._state("point_light", position=position, color=color, strength=strength)

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
        self._state("sphere_light", center=center, radius=radius, color=color, strength=strength)

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
        both = real("edges", edges)
        if both.shape != (2, 3):
            raise ValueError(f"edges has the shape {shape(both.shape)}: it must be (2, 3)")
        self._state(
            "rectangle_light",
            corner=vector("corner", corner),
            edges=both,
            color=color,
            strength=strength,
        )

    def set_background(self, color: npt.ArrayLike | Literal["transparent"]) -> None:
        """What is seen where a scene without a sky is not hit: linear RGB, not negative. With
        ``"transparent"``, not even the sky is seen there, and pictures have opacity."""
        value = color if isinstance(color, str) else vector("color", color)
        self._core.state("background", value)


def _check_file(path: str | os.PathLike[str]) -> None:
    """Raises OSError if a file cannot be opened."""
    with open(path, "rb"):
        pass
