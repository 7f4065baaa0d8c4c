"""Compares cyltrace's pictures with Mitsuba's: light, and time at equal error.

    pip install mitsuba numpy
    python scripts/mitsuba_compare.py target/release/cyltrace scenes/forest.toml --integrator path

Both render the scene in turns, a round with a seed of its own, on all threads. For each round there
are two pictures, so that the differences between rounds measure the noise.

- Blocks of 16 x 16 pixels: the difference of the means in standard errors, Welch's t. Of n blocks
  and three colors, the greatest is 3 to 4 if the light is the same.
- Time at equal error: the product of the time of a picture and the mean variance of its pixels.
  That of Mitsuba's independent samples does not depend on their number; that of cyltrace falls.
  The ratio says how many times longer Mitsuba takes for the same error. Its spread is from halves
  of the rounds.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import tempfile
import tomllib
from pathlib import Path

import mitsuba as mi
import numpy as np


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("scene", type=Path)
    parser.add_argument("--integrator", default="path", choices=["path", "sun"])
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=8)
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--glass", help="this material is glass in both")
    options = parser.parse_args()
    mi.set_variant(options.variant)
    import mitsuba_scene as translated

    document = tomllib.loads(options.scene.read_text())
    size = tuple(map(int, options.size.split("x")))
    described = translated.describe(document, options.scene.parent, options.glass)
    described["sensor"] = translated.sensor(document["camera"], size)
    depth = 2 if options.integrator == "sun" else 16
    described["integrator"] = {"type": "path", "max_depth": depth}
    scene = mi.load_dict(described)

    pictures: dict[str, list[np.ndarray]] = {"cyltrace": [], "mitsuba": []}
    times: dict[str, list[float]] = {"cyltrace": [], "mitsuba": []}
    with tempfile.TemporaryDirectory() as folder:
        own = own_scene(options, Path(folder))
        for seed in range(options.rounds):
            picture, seconds = cyltrace(options, own, Path(folder), seed)
            pictures["cyltrace"].append(picture)
            times["cyltrace"].append(seconds)
            picture, seconds = mitsuba(scene, options.spp, seed)
            pictures["mitsuba"].append(picture)
            times["mitsuba"].append(seconds)
    report(pictures, times)


def own_scene(options: argparse.Namespace, folder: Path) -> Path:
    """The scene with a sun without an extent, in the folder."""
    text = options.scene.read_text().replace("[sun]", "[sun]\nangle_degrees = 0", 1)
    if options.glass:
        name = f'name = "{options.glass}"\nkind = "diffuse"'
        if name not in text:
            raise SystemExit(f"no diffuse material {options.glass}")
        start = text.index(name)
        end = text.index("\n\n", start)
        text = text[:start] + f'name = "{options.glass}"\nkind = "glass"' + text[end:]
    # Files are relative to the folder of the scene.
    beside = options.scene.parent.resolve()
    files = r'\b(file|image)\s*=\s*"([^"]*)"'
    text = re.sub(files, lambda found: f'{found[1]} = "{beside / found[2]}"', text)
    path = folder / "compared.toml"
    path.write_text(text)
    return path


def cyltrace(
    options: argparse.Namespace, scene: Path, folder: Path, seed: int
) -> tuple[np.ndarray, float]:
    picture, figures = folder / "picture.exr", folder / "figures.json"
    command = [
        str(options.program), "render", str(scene), "-o", str(picture), "--size", options.size,
        "--spp", str(options.spp), "--seed", str(seed), "--integrator", options.integrator,
        "--json", str(figures), "--quiet",
    ]  # fmt: skip
    subprocess.run(command, check=True)
    pixels = np.array(mi.Bitmap(str(picture)), dtype=np.float64)[..., :3]
    return pixels, json.loads(figures.read_text())["render_s"]


def mitsuba(scene: object, spp: int, seed: int) -> tuple[np.ndarray, float]:
    import time

    start = time.perf_counter()
    pixels = np.array(mi.render(scene, spp=spp, seed=seed), dtype=np.float64)[..., :3]
    return pixels, time.perf_counter() - start


def report(pictures: dict[str, list[np.ndarray]], times: dict[str, list[float]]) -> None:
    stacks = {name: np.stack(list_) for name, list_ in pictures.items()}
    blocks = {name: blocks_of(stack) for name, stack in stacks.items()}
    rounds = len(stacks["cyltrace"])
    means = {name: block.mean(axis=0) for name, block in blocks.items()}
    errors = {name: block.std(axis=0, ddof=1) / rounds**0.5 for name, block in blocks.items()}
    spread = np.hypot(errors["cyltrace"], errors["mitsuba"])
    apart = means["cyltrace"] - means["mitsuba"]
    is_noisy = spread > 1e-6 * means["mitsuba"]
    scores = apart[is_noisy] / spread[is_noisy]
    print(f"{scores.size} means of blocks: greatest difference {np.abs(scores).max():.1f} standard")
    print(f"errors, root mean square {np.sqrt((scores**2).mean()):.2f}")
    same = np.abs(apart[~is_noisy]) / np.maximum(means["mitsuba"][~is_noisy], 1e-9)
    print(f"blocks without noise: greatest relative difference {same.max(initial=0):.1e}")
    whole = {name: stack.mean() for name, stack in stacks.items()}
    ratio = whole["cyltrace"] / whole["mitsuba"] - 1
    print(f"mean of the picture: {ratio:+.2e} relative")
    for name in stacks:
        least, greatest = min(times[name]), max(times[name])
        variance = stacks[name].var(axis=0, ddof=1).mean()
        print(f"{name}: {least:.2f} to {greatest:.2f} s, variance {variance:.3e}")
    halves = [slice(0, rounds // 2), slice(rounds // 2, rounds), slice(0, rounds)]
    ratios = [cost(stacks, times, half) for half in halves]
    print(f"Mitsuba takes {ratios[2]:.1f} times as long at equal error")
    print(f"({ratios[0]:.1f} and {ratios[1]:.1f} in the halves)")


def cost(stacks: dict[str, np.ndarray], times: dict[str, list[float]], rounds: slice) -> float:
    costs = {
        name: stack[rounds].var(axis=0, ddof=1).mean() * np.median(times[name][rounds])
        for name, stack in stacks.items()
    }
    return costs["mitsuba"] / costs["cyltrace"]


def blocks_of(stack: np.ndarray) -> np.ndarray:
    """The means of blocks of 16 x 16 pixels of pictures."""
    rounds, height, width, colors = stack.shape
    cut = stack[:, : height // 16 * 16, : width // 16 * 16]
    return cut.reshape(rounds, height // 16, 16, width // 16, 16, colors).mean(axis=(2, 4))


if __name__ == "__main__":
    main()
