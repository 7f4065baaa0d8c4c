"""Placements as matrices."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, common_length, real, rows, shape

#: The identity as a quaternion `x, y, z, w`.
NO_TURN = (0.0, 0.0, 0.0, 1.0)


def stated(value: npt.ArrayLike) -> Floats:
    array = real("matrices", value)
    if array.shape == (4, 4):
        array = array.reshape(1, 4, 4)
    if array.ndim != 3 or array.shape[1:] != (4, 4):
        raise ValueError(
            f"matrices has the shape {shape(np.shape(value))}: it must be (n, 4, 4) or (4, 4)"
        )
    return array


def composed(
    positions: npt.ArrayLike | None,
    quaternions: npt.ArrayLike | None,
    scales: npt.ArrayLike | None,
) -> Floats:
    """Matrices that scale, then turn, then move."""
    position = rows("positions", (0.0, 0.0, 0.0) if positions is None else positions)
    quaternion = rows("quaternions", NO_TURN if quaternions is None else quaternions, 4)
    scale = real("scales", 1.0 if scales is None else scales)
    stated = scale.shape
    if scale.ndim < 2:
        scale = scale.reshape(-1, 1)
    if scale.ndim != 2 or scale.shape[1] not in (1, 3):
        raise ValueError(
            f"scales has the shape {shape(stated)}: it must be (n,), (n, 3) or a number"
        )
    count = common_length(positions=position, quaternions=quaternion, scales=scale)
    length = np.sqrt((quaternion * quaternion).sum(axis=1, keepdims=True))
    wrong = np.flatnonzero(~((length > 0) & np.isfinite(length)))
    if len(wrong):
        row = int(wrong[0])
        raise ValueError(
            f"quaternions[{row}] is {quaternion[row].tolist()}: it must be finite and not zero"
        )
    x, y, z, w = (quaternion / length).T
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)
    matrices = np.zeros((count, 4, 4))
    matrices[:, :3, :3] = turn * scale[:, np.newaxis, :]
    matrices[:, :3, 3] = position
    matrices[:, 3, 3] = 1.0
    return matrices
