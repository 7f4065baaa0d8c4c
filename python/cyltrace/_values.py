"""Values of solids and placements, which materials may show."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, numbers


def each(name: str, values: npt.ArrayLike, count: int) -> npt.NDArray[Any]:
    """A number or a label for each of ``count`` things."""
    array = np.asarray(values)
    given = array.reshape(-1) if array.dtype.kind == "U" else numbers(name, values)
    if len(given) not in (1, count):
        raise ValueError(f"{name} has {len(given)} rows, and there are {count}")
    return np.broadcast_to(given, count).copy()


def solid_values(
    core: _core.Scene, material: int, values: Any, count: int
) -> tuple[Floats | None, bool]:
    """The values of solids of a material, and whether it shows them."""
    if not isinstance(values, dict):
        given = None if values is None else each("values", values, count)
        if given is not None and given.dtype.kind == "U":
            raise TypeError(f"values has the dtype {given.dtype}: it must be real numbers")
        return given, False
    column = core.column(material)
    if column is None:
        raise ValueError("the material shows no column: values must be numbers, not a dict")
    if list(values) != [column]:
        names = ", ".join(map(repr, values))
        raise ValueError(f"values has {names or 'no column'}: the material shows {column!r}")
    return _column(core, column, values[column], count), True


def placement_values(
    core: _core.Scene, values: dict[str, npt.ArrayLike] | None, count: int
) -> dict[str, Floats]:
    """The values of placements by column."""
    return {name: _column(core, name, one, count) for name, one in (values or {}).items()}


def _column(core: _core.Scene, name: str, values: npt.ArrayLike, count: int) -> Floats:
    """The numbers of a column that a material shows."""
    given = each(f"values[{name!r}]", values, count)
    if given.dtype.kind == "U":
        labels = core.labels(name)
        for row, text in enumerate(given):
            if text not in labels:
                known = ", ".join(map(repr, labels)) or "none"
                raise ValueError(
                    f"values[{name!r}][{row}] is {str(text)!r}: it is no label of the column; "
                    f"there are {known}"
                )
        given = np.array([labels.index(text) for text in given], dtype=np.float64)
    core.check_values(name, given)
    return given
