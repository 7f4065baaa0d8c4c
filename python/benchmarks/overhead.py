"""What Python costs: `Tracer.closest` beside a Rust program with the same rays and columns.

    cargo build --release -p cyltrace-bench --example columns
    python python/benchmarks/overhead.py target/release/examples/columns [--threads 1]

Both are built with the same settings, run in processes of their own and in turns; the least time
counts. The time is that of the processors, which other programs disturb less than the clock.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from peers import Sticks, rays_of

import cyltrace


def serve(scene: str, rays: str, threads: str) -> None:
    """The same as the Rust program does."""
    tracer = cyltrace.Tracer(cyltrace.load(scene), threads=int(threads))
    numbers = np.fromfile(rays).reshape(-1, 6)
    origins, directions = numbers[:, :3].copy(), numbers[:, 3:].copy()
    print("ready", flush=True)
    columns: list[np.ndarray] = []
    for line in sys.stdin:
        if line == "sum\n":
            print(columns[0][np.isfinite(columns[0])].sum(), flush=True)
            continue
        begin = time.perf_counter()
        hits = tracer.closest(origins, directions)
        columns = [hits.t]
        if line == "all\n":
            columns += [hits.primitive, hits.point, hits.normal]
        print(time.perf_counter() - begin, flush=True)


def processor_time(process: subprocess.Popen[str]) -> float:
    """The time that all threads of a process have computed."""
    # The clock of another process, as clock_getcpuclockid(3) of Linux numbers it.
    return time.clock_gettime((~process.pid << 3) | 2)


def main() -> None:
    if sys.argv[1:2] == ["--serve"]:
        serve(*sys.argv[2:])
        return
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("columns", help="the Rust program")
    parser.add_argument("--sticks", type=int, default=100_000)
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    sticks = Sticks.random(arguments.sticks)
    scene = cyltrace.Scene()
    scene.add_cylinders(sticks.p0, sticks.p1, sticks.radius)
    with tempfile.TemporaryDirectory() as folder:
        path, rays = Path(folder, "sticks.toml"), Path(folder, "rays")
        scene.save(path)
        print("| rays | columns | Rust, ns a ray | Python | overhead | by the clock |")
        print("|---|---|---|---|---|---|")
        for kind in ("coherent", "incoherent"):
            np.hstack(rays_of(kind, arguments.rays)).tofile(rays)
            words = [str(path), str(rays), str(arguments.threads)]
            measure(kind, [arguments.columns, *words], words, arguments)


def measure(kind: str, rust: list[str], words: list[str], arguments: argparse.Namespace) -> None:
    """Prints the rows of a kind of rays."""
    python = [sys.executable, __file__, "--serve", *words]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    processes = [subprocess.Popen(command, **pipes) for command in (rust, python)]
    for process in processes:
        assert process.stdout.readline() == "ready\n"
    for columns in ("t", "all"):
        processor: list[list[float]] = [[], []]
        clock: list[list[float]] = [[], []]
        for _ in range(arguments.rounds):
            for process, spent, seconds in zip(processes, processor, clock, strict=True):
                before = processor_time(process)
                answer = ask(process, columns)
                spent.append(processor_time(process) - before)
                seconds.append(answer)
        np.testing.assert_allclose(*[ask(process, "sum") for process in processes], rtol=1e-9)
        rust_ns, python_ns = (min(spent) * 1e9 / arguments.rays for spent in processor)
        overheads = [min(both[1]) / min(both[0]) - 1 for both in (processor, clock)]
        print(
            f"| {kind} | {columns} | {rust_ns:.0f} | {python_ns:.0f} "
            f"| {100 * overheads[0]:+.1f} % | {100 * overheads[1]:+.1f} % |",
            flush=True,
        )
    for process in processes:
        process.stdin.close()
        process.wait()


def ask(process: subprocess.Popen[str], line: str) -> float:
    process.stdin.write(line + "\n")
    process.stdin.flush()
    return float(process.stdout.readline())


if __name__ == "__main__":
    main()
