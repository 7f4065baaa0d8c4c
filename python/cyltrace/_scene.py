"""Scenes."""

from __future__ import annotations

import os
from typing import Literal

from . import _core
from ._look import Look
from ._prototype import Prototype


class Scene(Look, Prototype):
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

        Solids, placements, materials, camera, lights, drawings and the values that materials show
        are kept to the last bit, with the numbers of solids and placements. Other ``values`` are
        not part of a scene file.

        Parameters
        ----------
        path : str or path
            Ends in ``.toml``. Tables get its name and ``_cylinders_1.csv`` and the like.

        Raises
        ------
        OSError
            If a file cannot be written. Then none is changed.
        ValueError
            If the scene states what a scene file cannot, a material shows a column in which
            nothing has a value, or the file would have more than
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
