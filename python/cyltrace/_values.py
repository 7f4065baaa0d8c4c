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
    given = array.reshape(-1) if _has_texts(array) else numbers(name, values)
    if len(given) not in (1, count):
        raise ValueError(f"{name} has {len(given)} rows, and there are {count}")
    return np.broadcast_to(given, count).copy()


def solid_values(
    core: _core.Scene, material: int, values: Any, count: int
) -> tuple[Floats | None, bool]:
    """The values of solids of a material, and whether it shows them."""
    if not isinstance(values, dict):
        given = None if values is None else each("values", values, count)
        if given is not None and _has_texts(given):
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
    if _has_texts(given):
        labels = core.labels(name)
        numbers_of = {label: float(number) for number, label in enumerate(labels)}
        # As empty cells of a table.
        numbers_of[""] = np.nan
        shown = np.full(len(given), np.nan)
        for row, text in enumerate(given):
            if text in numbers_of:
                shown[row] = numbers_of[text]
            elif isinstance(text, (str, int, float)) and text == text:
                known = ", ".join(map(repr, labels)) or "none"
                raise ValueError(
                    f"values[{name!r}][{row}] is {text!s:.50}: it is no label of the column; "
                    f"there are {known}"
                )
        given = shown
    core.check_values(name, given)
    return given


def _has_texts(array: npt.NDArray[Any]) -> bool:
    """Whether there are texts among the elements."""
    is_object = array.dtype.kind == "O"
    return array.dtype.kind == "U" or (
        is_object and any(isinstance(one, str) for one in array.flat)
    )
