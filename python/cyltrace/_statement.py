"""Keys of a scene file from Python's values. The loader of scene files validates what they mean."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import real, vector

#: The keys that are three numbers.
_VECTORS = {
    "position",
    "look_at",
    "up",
    "direction",
    "color",
    "ground",
    "background",
    "center",
    "point",
    "normal",
    "missing",
}


def statement(**keys: Any) -> dict[str, Any]:
    """The keys that are not None."""
    return {name: _value(name, value) for name, value in keys.items() if value is not None}


def _value(name: str, value: Any) -> Any:
    if isinstance(value, dict):
        return statement(**value)
    if isinstance(value, (str, bool)):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, (list, tuple)) and value and all(isinstance(one, str) for one in value):
        return list(value)
    if name in _VECTORS:
        return vector(name, value)
    array = real(name, value)
    if not np.isfinite(array).all():
        raise ValueError(f"{name} is {np.asarray(value).tolist()}: it must be finite")
    # Whole numbers stay whole, which counts need.
    numbers = np.asarray(value)
    return numbers.tolist() if numbers.dtype.kind in "iu" else array.reshape(numbers.shape).tolist()
