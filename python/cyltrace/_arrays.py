"""Arguments as contiguous arrays of f64, or a ValueError that names what is wrong."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Floats: TypeAlias = npt.NDArray[np.float64]
Ints: TypeAlias = npt.NDArray[np.int64]
Bools: TypeAlias = npt.NDArray[np.bool_]


def real(name: str, value: npt.ArrayLike) -> Floats:
    """The array in f64, C-contiguous; copied only if it is not that already."""
    try:
        array = np.asarray(value)
    except ValueError:
        raise ValueError(f"{name}: its rows have different lengths") from None
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} has the dtype {array.dtype}: it must be real numbers")
    return np.ascontiguousarray(array, dtype=np.float64)


def rows(name: str, value: npt.ArrayLike, width: int = 3) -> Floats:
    """An array of shape (n, width); one vector becomes a single row."""
    array = real(name, value)
    if array.shape == (width,):
        array = array.reshape(1, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(
            f"{name} has the shape {shape(np.shape(value))}: it must be (n, {width}) or ({width},)"
        )
    return array


def numbers(name: str, value: npt.ArrayLike) -> Floats:
    """An array of shape (n,); one number becomes a single element."""
    array = real(name, value)
    if np.ndim(value) > 1:
        raise ValueError(
            f"{name} has the shape {shape(np.shape(value))}: it must be (n,) or a number"
        )
    return array.reshape(-1)


def common_length(**arrays: np.ndarray[Any, Any]) -> int:
    """The number of rows of arrays that have as many, or one for all rows."""
    lengths = {name: len(array) for name, array in arrays.items()}
    many = {length for length in lengths.values() if length != 1}
    if len(many) > 1:
        stated = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ValueError(f"the numbers of rows differ: {stated}")
    return many.pop() if many else 1


def vector(name: str, value: npt.ArrayLike, width: int = 3) -> list[float]:
    """A list of finite numbers."""
    array = real(name, value)
    if array.shape != (width,):
        raise ValueError(f"{name} has the shape {shape(array.shape)}: it must be ({width},)")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} is {array.tolist()}: it must be finite")
    return [float(number) for number in array]


def shape(numbers: tuple[int, ...]) -> str:
    """A shape as NumPy prints it."""
    return str(tuple(int(number) for number in numbers))
