"""First hits of rays with cylinders in 60 digits, for the comparison with other programs.

Shares nothing with cyltrace but the definition: the solid is the set of points at most `radius`
from the axis between the planes through `p0` and `p1`; its surface is the wall, with the two
disks if it is closed. Candidates are found in f64 with a margin of 1e-6 radii, which is a million
roundings; each is solved in mpmath.
"""

from __future__ import annotations

import mpmath
import numpy as np

mpmath.mp.dps = 60


def first_hits(
    origins: np.ndarray,
    directions: np.ndarray,
    p0: np.ndarray,
    p1: np.ndarray,
    radius: np.ndarray,
    closed: bool,
) -> tuple[np.ndarray, np.ndarray]:
    """The parameter and the cylinder of the first hit of each ray; `inf` and -1 for a miss."""
    t = np.full(len(origins), np.inf)
    number = np.full(len(origins), -1)
    for row, (origin, direction) in enumerate(zip(origins, directions, strict=True)):
        for candidate in _near(origin, direction, p0, p1, radius):
            found = _first(
                origin, direction, p0[candidate], p1[candidate], radius[candidate], closed
            )
            if found is not None and float(found) < t[row]:
                t[row], number[row] = float(found), candidate
    return t, number


def _near(
    origin: np.ndarray, direction: np.ndarray, p0: np.ndarray, p1: np.ndarray, radius: np.ndarray
) -> np.ndarray:
    """The cylinders whose bounding ball the ray's line comes to."""
    middle, half = (p0 + p1) / 2, np.linalg.norm(p1 - p0, axis=1) / 2
    reach = np.hypot(half, radius) * (1 + 1e-6)
    unit = direction / np.linalg.norm(direction)
    to_middle = middle - origin
    along = to_middle @ unit
    across = (to_middle * to_middle).sum(axis=1) - along * along
    return np.flatnonzero((across <= reach * reach) & (along > -reach))


def _first(
    origin: np.ndarray,
    direction: np.ndarray,
    p0: np.ndarray,
    p1: np.ndarray,
    radius: float,
    closed: bool,
) -> mpmath.mpf | None:
    def exact(vector: np.ndarray) -> list[mpmath.mpf]:
        return [mpmath.mpf(float(number)) for number in vector]

    def dot(one: list[mpmath.mpf], other: list[mpmath.mpf]) -> mpmath.mpf:
        return sum(a * b for a, b in zip(one, other, strict=True))

    o, d, base, top = exact(origin), exact(direction), exact(p0), exact(p1)
    axis = [b - a for a, b in zip(base, top, strict=True)]
    x = [a - b for a, b in zip(o, base, strict=True)]
    r = mpmath.mpf(float(radius))
    aa, ad, ax = dot(axis, axis), dot(axis, d), dot(axis, x)
    # |x + t d|^2 aa - (ax + t ad)^2 = r^2 aa
    a = dot(d, d) * aa - ad * ad
    b = dot(x, d) * aa - ax * ad
    c = (dot(x, x) - r * r) * aa - ax * ax
    found = []
    discriminant = b * b - a * c
    if a > 0 and discriminant >= 0:
        root = mpmath.sqrt(discriminant)
        found += [t for t in ((-b - root) / a, (root - b) / a) if 0 <= ax + t * ad <= aa]
    if closed and ad != 0:
        for height in (mpmath.mpf(0), aa):
            t = (height - ax) / ad
            center = base if height == 0 else top
            off = [o[i] + t * d[i] - center[i] for i in range(3)]
            if dot(off, off) <= r * r:
                found.append(t)
    return min((t for t in found if t >= 0), default=None)
