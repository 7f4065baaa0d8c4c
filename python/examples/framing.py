"""The camera and the light for pictures of the examples: the whole scene on white."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from cyltrace import Scene, Tracer


def frame(scene: Scene, view: npt.ArrayLike, pixels: int = 900) -> tuple[int, int]:
    """Aims an orthographic camera along ``view``, with z upward, so that the scene fills the
    picture. The sky is white, and the sun is above the viewer's left shoulder.

    Returns the picture's width and height; the longer one is ``pixels``.
    """
    tracer = Tracer(scene)
    least, greatest = tracer.bounds
    middle, radius = (least + greatest) / 2, float(np.linalg.norm(greatest - least)) / 2
    along = np.asarray(view, dtype=np.float64) / np.linalg.norm(view)
    right = np.cross(along, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    plane = np.array([right, np.cross(right, along)])
    # Rays through a grid over the bounding sphere find where the scene is in it.
    cells = 400
    ticks = (2 * np.arange(cells) + 1 - cells) / cells * radius
    grid = np.stack(np.meshgrid(ticks, ticks), axis=-1).reshape(-1, 2)
    eye = middle - 1.5 * radius * along
    hit = grid[tracer.occluded(eye + grid @ plane, along)]
    if len(hit) == 0:
        hit = np.array([[-radius, -radius], [radius, radius]])
    low, high = hit.min(axis=0), hit.max(axis=0)
    width, height = 1.03 * (high - low) + 8 * radius / cells
    shift = (low + high) / 2 @ plane
    scene.set_camera(eye + shift, middle + shift, orthographic=True, height=float(height))
    scene.set_sky([1, 1, 1])
    scene.set_sun(0.6 * plane[1] - 0.5 * right - along, strength=2.5)
    scale = pixels / max(width, height)
    return max(1, round(scale * width)), max(1, round(scale * height))
