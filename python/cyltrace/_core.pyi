"""The part in Rust. It takes contiguous f64 arrays whose shapes have been checked; a single row
serves all rows."""

import os
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._picture import Pixels, Request
from ._rows import Rows

Floats = npt.NDArray[np.float64]
Codes = npt.NDArray[np.uint8]
Ints = npt.NDArray[np.int64]
Bools = npt.NDArray[np.bool_]
Progress = Callable[[int, int], object] | None
#: The number of the first solid, and the rows that were left out.
Added = tuple[int, list[int]]

#: Columns of hits: `t`, normals, and places.
Answer = tuple[Floats, Floats | None, tuple[npt.NDArray[np.int8], Ints, Ints, Ints] | None]
Closest = Callable[[Floats, Floats, Floats, Floats], Answer]

VERSION: str
CLASSES: list[str]
GREATEST_RAYS: int
SOLIDS: list[str]
PARTS: list[str]
#: The name of each channel, its words a pixel, and whether these are floats.
CHANNELS: list[tuple[str, int, bool]]

class Solid:
    @staticmethod
    def cylinder(p0: list[float], p1: list[float], radius: float) -> Solid: ...
    @staticmethod
    def cone(p0: list[float], p1: list[float], radius0: float, radius1: float) -> Solid: ...
    @staticmethod
    def rounded_cone(p0: list[float], p1: list[float], radius0: float, radius1: float) -> Solid: ...
    @staticmethod
    def sphere(center: list[float], radius: float) -> Solid: ...
    @staticmethod
    def cuboid(center: list[float], half_widths: list[float], quaternion: list[float]) -> Solid: ...
    @staticmethod
    def union(parts: list[Solid]) -> Solid: ...
    @staticmethod
    def intersection(parts: list[Solid]) -> Solid: ...
    @staticmethod
    def difference(parts: list[Solid]) -> Solid: ...
    def depth(self) -> int: ...
    def contains(self, point: list[float]) -> bool: ...

class Scene:
    def __new__(cls, records: str) -> Scene: ...
    @staticmethod
    def load(path: str | os.PathLike[str]) -> Scene: ...
    def save(self, folder: str | os.PathLike[str], stem: str) -> None: ...
    def add_prototype(self, name: str) -> int: ...
    def state(self, key: str, value: object) -> None: ...
    def set_environment(
        self,
        width: int,
        height: int,
        pixels: npt.NDArray[np.float32],
        strength: float,
        rotate_degrees: float,
    ) -> None: ...
    def column(self, material: int) -> str | None: ...
    def labels(self, column: str) -> list[str]: ...
    def check_values(self, column: str, values: Floats) -> None: ...
    def set_solid_values(
        self, prototype: int, material: int, first: int, values: Floats
    ) -> None: ...
    def set_placement_values(
        self, prototype: int, column: str, first: int, values: Floats
    ) -> None: ...
    def check_shown(self) -> None: ...
    def add_cylinders(
        self,
        rows: Rows,
        p0: Floats,
        p1: Floats,
        radius: Floats,
        caps: Codes,
    ) -> Added: ...
    def add_cones(
        self,
        rows: Rows,
        p0: Floats,
        p1: Floats,
        radius0: Floats,
        radius1: Floats,
        caps: Codes,
    ) -> Added: ...
    def add_rounded_cones(
        self,
        rows: Rows,
        p0: Floats,
        p1: Floats,
        radius0: Floats,
        radius1: Floats,
    ) -> Added: ...
    def add_spheres(
        self,
        rows: Rows,
        center: Floats,
        radius: Floats,
    ) -> Added: ...
    def add_cuboids(
        self,
        rows: Rows,
        center: Floats,
        half_widths: Floats,
        quaternion: Floats,
    ) -> Added: ...
    def add_disks(
        self,
        rows: Rows,
        center: Floats,
        normal: Floats,
        radius: Floats,
    ) -> Added: ...
    def add_composition(self, prototype: int, solid: Solid, material: int) -> int: ...
    def add_placements(self, prototype: int, of: int, matrices: Floats) -> int: ...
    def prototype_names(self) -> list[str]: ...
    def material_names(self) -> list[str]: ...
    def counts(self, prototype: int) -> tuple[int, int]: ...
    def next_primitive(self, prototype: int) -> int: ...
    def cylinders(self, prototype: int) -> tuple[Floats, Floats, Floats, Ints]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def skipped_rows(self) -> int: ...

class Tracer:
    def __new__(cls, scene: Scene, threads: int | None, layout: str, exact: bool) -> Tracer: ...
    @property
    def bounds(self) -> tuple[list[float], list[float]]: ...
    @property
    def engine(self) -> tuple[str, str]: ...
    @property
    def threads(self) -> int: ...
    def closest(
        self,
        origins: Floats,
        directions: Floats,
        t_min: Floats,
        t_max: Floats,
        progress: Progress = None,
    ) -> Found: ...
    def occluded(
        self,
        origins: Floats,
        directions: Floats,
        t_min: Floats,
        t_max: Floats,
        progress: Progress = None,
    ) -> Bools: ...
    def all_hits(
        self,
        origins: Floats,
        directions: Floats,
        t_min: Floats,
        t_max: Floats,
        progress: Progress = None,
    ) -> tuple[Found, Ints]: ...
    def contains(self, points: Floats, progress: Progress = None) -> Bools: ...
    def locate(
        self, points: Floats, progress: Progress = None
    ) -> tuple[Ints, npt.NDArray[np.int8], Ints, tuple[Ints, Ints], Ints]: ...

class Found:
    def __len__(self) -> int: ...
    def column(self, name: str) -> Any: ...
    def vectors(self) -> tuple[Floats, Floats]: ...
    def take(self, positions: Ints) -> Found: ...
    def spawn(self, directions: Floats) -> Floats: ...

class Check:
    def json(self) -> str: ...
    def text(self) -> str: ...
    def verdict(self) -> str: ...
    def write_page(self, path: str | os.PathLike[str], scene: str) -> None: ...

def check(
    tracer: Tracer,
    intersector: tuple[str, Closest] | None,
    rays: int,
    classes: list[str] | None,
    segments: list[int],
    seed: int,
    max_memory: int,
    progress: Progress = None,
) -> Check: ...
def check_hits(
    tracer: Tracer,
    origins: Floats,
    directions: Floats,
    t_min: Floats,
    t_max: Floats,
    t: Floats,
    tolerance: float | None,
    progress: Progress = None,
) -> Check: ...
def parse_size(text: str) -> int: ...

class Insets: ...

class Rendered:
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def colors(self) -> npt.NDArray[np.float32]: ...
    @property
    def has_opacity(self) -> bool: ...
    @property
    def words(self) -> npt.NDArray[np.uint32]: ...
    @property
    def reached(self) -> tuple[float, int] | None: ...
    @property
    def insets(self) -> Insets: ...

def render(tracer: Tracer, request: Request, progress: Progress = None) -> Rendered: ...
def png(pixels: Pixels) -> bytes: ...
def write_picture(
    path: str | os.PathLike[str], pixels: Pixels, exposure: float, tonemap: str
) -> None: ...
