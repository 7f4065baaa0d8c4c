"""cyltrace beside other ray tracers that Python has, on the same random sticks.

    pip install ./python mpmath trimesh embreex raysect mitsuba
    python python/benchmarks/peers.py [--sticks 100000] [--rays 1000000] [--rounds 3]
    python python/benchmarks/peers.py --draw peers.json     # after that, with matplotlib

Every program is timed on one thread, in turns, and the least time counts. Wrong hits are those
of a sample against `oracle.py`, in 60 digits: another stick, or hit for miss. The error is the
distance along the ray, in radii, the 99th percentile. Each program runs in a process of its own,
whose greatest memory is reported.

trimesh traces a mesh of 32 sides through embreex. Raysect takes one ray at a time. Mitsuba's
cylinders have no disks; it is compared with open cylinders.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from figure import draw

Query = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray | None]]


@dataclass
class Sticks:
    """Random sticks in the unit cube, 2 n^(-1/3) long and a twentieth of that in radius."""

    p0: np.ndarray
    p1: np.ndarray
    radius: float

    @staticmethod
    def random(count: int) -> Sticks:
        rng = np.random.default_rng(1)
        p0 = rng.uniform(size=(count, 3))
        axis = rng.normal(size=(count, 3))
        length = 2 * count ** (-1 / 3)
        p1 = p0 + length * axis / np.linalg.norm(axis, axis=1, keepdims=True)
        return Sticks(p0, p1, length / 20)


def rays_of(kind: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Rays of a camera, row by row, or between random points."""
    rng = np.random.default_rng(2)
    if kind == "incoherent":
        origins = rng.uniform(size=(count, 3))
        return origins, rng.normal(size=(count, 3))
    side = int(np.ceil(np.sqrt(count)))
    x, z = np.meshgrid(np.linspace(-0.35, 0.35, side), np.linspace(-0.35, 0.35, side))
    directions = np.column_stack([x.ravel(), np.ones(side * side), z.ravel()])[:count]
    return np.tile([0.5, -1.0, 0.5], (count, 1)), directions


def cyltrace_query(sticks: Sticks, closed: bool) -> Query:
    import cyltrace

    scene = cyltrace.Scene()
    scene.add_cylinders(sticks.p0, sticks.p1, sticks.radius, "both" if closed else "none")
    tracer = cyltrace.Tracer(scene, threads=1)

    def query(origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        hits = tracer.closest(origins, directions)
        return hits.t, hits.primitive

    return query


def trimesh_query(sticks: Sticks, sides: int = 32) -> Query:
    import trimesh

    angle = 2 * np.pi * np.arange(sides) / sides
    axis = sticks.p1 - sticks.p0
    unit = axis / np.linalg.norm(axis, axis=1, keepdims=True)
    other = np.where(np.abs(unit[:, :1]) < 0.5, [[1.0, 0, 0]], [[0, 1.0, 0]])
    u = np.cross(unit, other)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(unit, u)
    around = sticks.radius * (
        np.cos(angle)[None, :, None] * u[:, None] + np.sin(angle)[None, :, None] * v[:, None]
    )
    # Of each stick: the ring at p0, the ring at p1, and the two middles.
    rings = [sticks.p0[:, None] + around, sticks.p1[:, None] + around]
    vertices = np.concatenate([*rings, sticks.p0[:, None], sticks.p1[:, None]], axis=1)
    here, there = np.arange(sides), (np.arange(sides) + 1) % sides
    wall = [(here, there, there + sides), (here, there + sides, here + sides)]
    disks = [
        (there, here, np.full(sides, 2 * sides)),
        (here + sides, there + sides, np.full(sides, 2 * sides + 1)),
    ]
    faces = np.concatenate([np.column_stack(part) for part in [*wall, *disks]])
    every = faces[None] + (2 * sides + 2) * np.arange(len(vertices))[:, None, None]
    mesh = trimesh.Trimesh(vertices.reshape(-1, 3), every.reshape(-1, 3), process=False)
    assert type(mesh.ray).__module__ == "trimesh.ray.ray_pyembree"

    def query(origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        points, ray, triangle = mesh.ray.intersects_location(
            origins, directions, multiple_hits=False
        )
        t, number = np.full(len(origins), np.inf), np.full(len(origins), -1)
        d = directions[ray]
        t[ray] = ((points - origins[ray]) * d).sum(axis=1) / (d * d).sum(axis=1)
        number[ray] = triangle // len(faces)
        return t, number

    return query


def raysect_query(sticks: Sticks) -> Query:
    from raysect.core import Point3D, Ray, Vector3D, World, rotate_basis, translate
    from raysect.primitive import Cylinder

    world = World()
    for p0, p1 in zip(sticks.p0, sticks.p1, strict=True):
        axis = p1 - p0
        across = [1, 0, 0] if abs(axis[0]) < 0.5 * np.linalg.norm(axis) else [0, 1, 0]
        turn = rotate_basis(Vector3D(*axis), Vector3D(*across))
        Cylinder(sticks.radius, float(np.linalg.norm(axis)), world, translate(*p0) * turn)
    world.build_accelerator()

    def query(origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, None]:
        t = np.full(len(origins), np.inf)
        for row, (o, d) in enumerate(zip(origins.tolist(), directions.tolist(), strict=True)):
            hit = world.hit(Ray(Point3D(*o), Vector3D(*d)))
            if hit is not None:
                t[row] = hit.ray_distance
        return t, None

    return query


def mitsuba_query(sticks: Sticks, variant: str) -> Query:
    import drjit
    import mitsuba as mi

    mi.set_variant(variant)
    shapes = {
        f"stick{row}": {
            "type": "cylinder",
            "p0": p0,
            "p1": p1,
            "radius": sticks.radius,
        }
        for row, (p0, p1) in enumerate(zip(sticks.p0.tolist(), sticks.p1.tolist(), strict=True))
    }
    scene = mi.load_dict({"type": "scene", **shapes})
    if variant.startswith("scalar"):

        def one_by_one(origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, None]:
            t = np.full(len(origins), np.inf)
            for row, (o, d) in enumerate(zip(origins.tolist(), directions.tolist(), strict=True)):
                t[row] = scene.ray_intersect_preliminary(mi.Ray3f(o, d)).t
            return t, None

        return one_by_one
    drjit.set_thread_count(1)

    def query(origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, None]:
        ray = mi.Ray3f(mi.Point3f(origins.T), mi.Vector3f(directions.T))
        return np.array(scene.ray_intersect_preliminary(ray).t, dtype=np.float64), None

    return query


#: How each program is set up, whether its cylinders are closed, and the rays that it gets: those
#: that take one at a time get fewer.
PROGRAMS: dict[str, tuple[Callable[[Sticks], Query], bool, float]] = {
    "cyltrace": (lambda sticks: cyltrace_query(sticks, True), True, 1.0),
    "trimesh over embreex": (trimesh_query, True, 1.0),
    "Raysect": (raysect_query, True, 0.02),
    "cyltrace, open": (lambda sticks: cyltrace_query(sticks, False), False, 1.0),
    "Mitsuba llvm_ad_rgb": (lambda sticks: mitsuba_query(sticks, "llvm_ad_rgb"), False, 1.0),
    "Mitsuba scalar_rgb": (lambda sticks: mitsuba_query(sticks, "scalar_rgb"), False, 0.05),
}


def serve(name: str, sticks: Sticks, count: int) -> None:
    """Answers one line a request: traces, and prints the time. The process of one program."""
    make, _, share = PROGRAMS[name]
    before = time.perf_counter()
    query = make(sticks)
    print(json.dumps({"build_s": time.perf_counter() - before}), flush=True)
    for line in sys.stdin:
        kind, save = line.split()
        origins, directions = rays_of(kind, max(1, int(count * share)))
        begin = time.perf_counter()
        t, number = query(origins, directions)
        spent = time.perf_counter() - begin
        if save != "-":
            origins, directions = sample(kind, count)
            t, number = query(origins, directions)
            np.savez(save, t=t, number=np.full(len(t), -2) if number is None else number)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000
        print(json.dumps({"s": spent / (max(1, int(count * share))), "peak_mb": peak}), flush=True)


def sample(kind: str, count: int, most: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """Some of the rays, evenly spread."""
    origins, directions = rays_of(kind, count)
    step = max(1, count // most)
    return origins[::step], directions[::step]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--sticks", type=int, default=100_000)
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", action="append", choices=PROGRAMS, help="may be repeated")
    parser.add_argument("--output", type=Path, default=Path("peers.json"))
    parser.add_argument(
        "--draw", type=Path, metavar="JSON", help="draw the rows of an earlier run beside them"
    )
    parser.add_argument("--serve", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.draw:
        draw(json.loads(arguments.draw.read_text()), arguments.draw.with_suffix(".svg"))
        return
    sticks = Sticks.random(arguments.sticks)
    if arguments.serve:
        serve(arguments.serve, sticks, arguments.rays)
        return

    from oracle import first_hits

    radii = np.full(arguments.sticks, sticks.radius)
    names = arguments.only or list(PROGRAMS)
    processes = {}
    for name in names:
        command = [sys.executable, __file__, "--serve", name]
        command += ["--sticks", str(arguments.sticks), "--rays", str(arguments.rays)]
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        processes[name] = process
        print(f"{name}: built in {answer(process)['build_s']:.1f} s", file=sys.stderr)
    rows = []
    for kind in ("coherent", "incoherent"):
        times = {name: [] for name in names}
        peaks = {}
        for turn in range(arguments.rounds):
            for name, process in processes.items():
                save = f"{arguments.output}.{len(name)}{kind}.npz" if turn == 0 else "-"
                process.stdin.write(f"{kind} {save.replace(' ', '_')}\n")
                process.stdin.flush()
                found = answer(process)
                times[name].append(found["s"])
                peaks[name] = found["peak_mb"]
        origins, directions = sample(kind, arguments.rays)
        for name in names:
            closed = PROGRAMS[name][1]
            true_t, true_number = first_hits(
                origins, directions, sticks.p0, sticks.p1, radii, closed
            )
            path = Path(f"{arguments.output}.{len(name)}{kind}.npz")
            with np.load(path) as found:
                t, number = found["t"], found["number"]
            path.unlink()
            hit, true_hit = np.isfinite(t), np.isfinite(true_t)
            both = hit & true_hit
            off = np.abs(t[both] - true_t[both]) * np.linalg.norm(directions[both], axis=1)
            off /= sticks.radius
            # Half a radius beside the truth is another stick, or the other side of this one.
            other = np.where(number[both] == -2, off > 0.5, number[both] != true_number[both])
            rows.append(
                {
                    "program": name,
                    "rays": kind,
                    "rays_per_s": 1 / min(times[name]),
                    "spread": max(times[name]) / min(times[name]),
                    "wrong": int((hit != true_hit).sum() + other.sum()),
                    "of": len(t),
                    "error_p99_radii": float(np.quantile(off[~other], 0.99)),
                    "peak_mb": peaks[name],
                }
            )
    for process in processes.values():
        process.stdin.close()
        process.wait()
    arguments.output.write_text(json.dumps(rows, indent=1) + "\n")
    print(table(rows))


def answer(process: subprocess.Popen[str]) -> dict[str, float]:
    line = process.stdout.readline()
    if not line:
        raise SystemExit(f"a program ended with exit code {process.wait()}; see above")
    return json.loads(line)


def table(rows: list[dict[str, object]]) -> str:
    """The rows as Markdown."""
    lines = [
        "| program | rays | million rays/s | wrong | error, radii (99 %) | peak memory |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        lines.append(
            f"| {row['program']} | {row['rays']} | {row['rays_per_s'] / 1e6:.3f} "
            f"| {row['wrong']} of {row['of']} | {row['error_p99_radii']:.1e} "
            f"| {row['peak_mb']:.0f} MB |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    main()
