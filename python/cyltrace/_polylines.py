"""The segments of lines of points."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Ints, shape


def pairs(count: int, offsets: npt.ArrayLike | None, edges: npt.ArrayLike | None) -> Ints:
    """The pairs of points that segments join."""
    if edges is not None:
        if offsets is not None:
            raise ValueError("offsets exclude edges: give one or the other")
        joined = _whole("edges", edges)
        if joined.ndim != 2 or joined.shape[1] != 2:
            raise ValueError(f"edges has the shape {shape(joined.shape)}: it must be (m, 2)")
        outside = np.argwhere((joined < 0) | (joined >= count))
        if len(outside):
            row, column = (int(index) for index in outside[0])
            raise ValueError(
                f"edges[{row}, {column}] is {joined[row, column]}: there are {count} points"
            )
        return joined
    ends = np.array([0, count]) if offsets is None else _whole("offsets", offsets)
    if ends.ndim != 1 or len(ends) == 0 or ends[0] != 0 or ends[-1] != count:
        raise ValueError(f"offsets must begin with 0 and end with the {count} points")
    falling = np.flatnonzero(np.diff(ends) < 0)
    if len(falling):
        row = int(falling[0]) + 1
        raise ValueError(f"offsets[{row}] is {ends[row]}, less than the one before it")
    first = np.ones(count, dtype=np.bool_)
    # The last point of a line begins no segment. A line may be empty.
    first[ends[1:][np.diff(ends) > 0] - 1] = False
    begin = np.flatnonzero(first)
    return np.column_stack([begin, begin + 1]).astype(np.int64)


def _whole(name: str, value: npt.ArrayLike) -> Ints:
    array = np.asarray(value)
    if array.dtype.kind not in "iu" and array.size:
        raise TypeError(f"{name} has the dtype {array.dtype}: it must be integers")
    return array.astype(np.int64)
