"""Point clouds of lidar written as they come: ``.npz`` and, with laspy, ``.las``."""

from __future__ import annotations

import importlib.util
import tempfile
from collections.abc import Iterable
from contextlib import ExitStack

import numpy as np

#: A return: its place, the share of the pulse's rays, its number among those of its pulse, their
#: number, the number of its tree (-1 on the ground) and of its pulse.
RETURN = np.dtype(
    [("xyz", "f8", 3), ("intensity", "f4"), ("number", "u1"), ("of", "u1")]
    + [("tree", "i4"), ("pulse", "i8")]
)


def write(chunks: Iterable[np.ndarray], output: str) -> int:
    """Writes arrays of :data:`RETURN` to ``output.npz`` and ``output.las``, and returns the
    number of points. Only one chunk is in memory at a time."""
    with ExitStack() as files:
        raw = files.enter_context(tempfile.TemporaryFile())
        las = None
        if importlib.util.find_spec("laspy"):
            import laspy

            header = laspy.LasHeader(point_format=6, version="1.4")
            header.scales = np.full(3, 0.001)
            header.add_extra_dim(laspy.ExtraBytesParams("tree", "int32"))
            las = files.enter_context(laspy.open(f"{output}.las", mode="w", header=header))
        else:
            print("laspy is not installed: no LAS file is written")
        for points in chunks:
            points.tofile(raw)
            if las is not None:
                record = laspy.ScaleAwarePointRecord.zeros(len(points), header=header)
                record.x, record.y, record.z = points["xyz"].T
                record.intensity = np.round(65535 * points["intensity"])
                record.return_number, record.number_of_returns = points["number"], points["of"]
                # The classes of ground and of high vegetation.
                record.classification = np.where(points["tree"] < 0, 2, 5)
                record.gps_time, record.tree = 1e-6 * points["pulse"], points["tree"]
                las.write_points(record)
        raw.flush()
        count = raw.tell() // RETURN.itemsize
        points = np.memmap(raw, RETURN, "r", shape=(count,)) if count else np.empty(0, RETURN)
        np.savez(f"{output}.npz", points=points)
    return count
