"""Measure what parts of a picture cost, and say how far they scale.

    python parts.py SCENE [--program PATH] [--size WxH] [--spp N] [--folder DIR]

The scene is rendered whole, by several workers, and in several numbers of parts one after
the other; the runs are interleaved and the least time of each counts. The cost of a part and
of the rays are fitted to the times, T = rays + parts * (cost of a part). The model then adds
the time to merge and to move the parts, and finds the number of machines that pays.
"""

from __future__ import annotations

import argparse
import math
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

# Bytes of a pixel in a part.
PIXEL_BYTES = 12
# A network between machines and the folder of the parts, in bytes a second: 1 Gbit/s.
NETWORK = 125e6


class Measured:
    """Runs the program and keeps the least time of each kind of run."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.program = arguments.program
        self.render = ["render", arguments.scene, "--quiet"]
        self.render += ["--size", arguments.size, "--spp", str(arguments.spp)]
        self.folder = Path(arguments.folder)
        self.times: dict[str, list[float]] = {}

    def run(self, words: list[str]) -> float:
        start = time.perf_counter()
        subprocess.run([self.program, *words], check=True)
        return time.perf_counter() - start

    def whole(self) -> float:
        return self.run([*self.render, "-o", str(self.folder / "whole.png")])

    def parts(self, count: int) -> float:
        """The time of all parts, one process after the other, and of their merge."""
        folder = self.folder / f"{count}.parts"
        folder.mkdir(exist_ok=True)
        name = "{:06}.cylpart"
        start = time.perf_counter()
        for number in range(1, count + 1):
            part = ["--part", f"{number}/{count}", "-o", str(folder / name.format(number))]
            self.run([*self.render, *part])
        made = time.perf_counter() - start
        merged = str(self.folder / "merged.png")
        self.note(f"merge {count}", self.run(["merge", str(folder), "-o", merged, "--quiet"]))
        shutil.rmtree(folder)
        return made

    def workers(self, count: int) -> float:
        shared = ["--workers", str(count), "--threads", str(count)]
        return self.run([*self.render, "-o", str(self.folder / "shared.png"), *shared])

    def note(self, what: str, seconds: float) -> None:
        self.times.setdefault(what, []).append(seconds)
        print(f"{what}: {seconds:.3f} s", file=sys.stderr)

    def least(self, what: str) -> float:
        return min(self.times[what])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene")
    parser.add_argument("--program", default=os.environ.get("CYLTRACE_PROGRAM", "cyltrace"))
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--folder", default="parts_benchmark")
    parser.add_argument("--parts", type=int, nargs="+", default=[10, 64, 200])
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    Path(arguments.folder).mkdir(exist_ok=True)
    measured = Measured(arguments)
    for _ in range(arguments.rounds):
        measured.note("whole", measured.whole())
        for count in arguments.parts:
            measured.note(f"parts {count}", measured.parts(count))
        for count in arguments.workers:
            measured.note(f"workers {count}", measured.workers(count))
    report(measured, arguments)


def report(measured: Measured, arguments: argparse.Namespace) -> None:
    whole = measured.least("whole")
    counts = np.array([1, *arguments.parts], dtype=float)
    times = np.array([whole] + [measured.least(f"parts {n}") for n in arguments.parts])
    # Weighted, so that each run counts by its relative error.
    matrix = np.stack([np.ones_like(counts), counts], axis=1) / times[:, None]
    (rays, part), *_ = np.linalg.lstsq(matrix, np.ones_like(times), rcond=None)
    width, height = map(int, arguments.size.split("x"))
    samples = width * height * arguments.spp
    what = f"{arguments.scene}, {arguments.size}, {arguments.spp} samples"
    print(f"{os.cpu_count()} processors; {what}")
    print("| run | seconds | over the whole |")
    print("|---|---|---|")
    for what, seconds in measured.times.items():
        print(f"| {what} | {min(seconds):.2f} to {max(seconds):.2f} | {min(seconds) / whole:.3f} |")
    error = np.max(np.abs(rays + part * counts - times) / times)
    print(f"\nrays {rays:.2f} s, a part {part:.3f} s; the fit is within {100 * error:.1f} %")
    merges = [measured.least(f"merge {n}") for n in arguments.parts]
    merge = min(merges) / (width * height)
    print(f"merge {1e9 * merge:.0f} ns a pixel")
    model(rays / samples, part, merge)


def model(sample: float, part: float, merge: float) -> None:
    """The time of 10^12 samples on many machines like this one.

    A machine makes its parts one after the other. At the end some wait for the last part,
    half a part's time on average. Then one machine merges.
    """
    samples, pixels = 1e12, 65536 * 4096
    print("\n10^12 samples, 65536 x 4096 pixels, parts of at least 20 s:")
    print("| machines | parts | rays | start of parts | moving | merge | all |")
    print("|---|---|---|---|---|---|---|")
    for machines in [1, 10, 100, 1_000, 10_000, 100_000]:
        parts = max(machines, min(8 * machines, math.floor(samples * sample / 20)))
        tracing = samples * sample / machines * (1 + 0.5 * machines / parts)
        starting = part * math.ceil(parts / machines)
        moving = pixels * PIXEL_BYTES / NETWORK
        merging = pixels * merge
        whole = tracing + starting + moving + merging
        times = map(duration, [tracing, starting, moving, merging, whole])
        cells = [f"{machines}", f"{parts}", *times]
        print(f"| {' | '.join(cells)} |")


def duration(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.1f} s"
    if seconds < 7200:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"


if __name__ == "__main__":
    main()
