"""The command line."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from dataclasses import dataclass

from ._error import FarmError

#: Parts for each part that is made at a time: at the end a worker is idle for half a part on
#: average.
PARTS_PER_WORKER = 8

#: The greatest number of parts.
GREATEST_PARTS = 1_000_000

#: Options of the program that the farm itself uses.
OWN = ("--part", "--resume", "--workers", "--replay", "--report")

USAGE = "python -m cyltrace.farm {render,trace,check} SCENE -o OUT [OPTIONS] [OPTIONS OF cyltrace]"


@dataclass
class Arguments:
    """The command line."""

    command: str
    scene: str
    #: The options that name a file which each part reads.
    inputs: dict[str, str]
    output: str
    #: Options that are passed on.
    options: list[str]
    #: The number of workers on this machine; None if there is a scheduler.
    local: int | None
    scheduler: str | None
    parts: int | None
    program: str | None
    shared: bool
    threads: int | None
    patience: float
    keeps_parts: bool
    json: str | None
    quiet: bool


def parse(words: Sequence[str]) -> Arguments:
    """Reads the command line. Help and wrong arguments end the program.

    Raises
    ------
    FarmError
        If arguments do not fit together.
    """
    parser = _parser()
    if not words or words[0] in ("-h", "--help"):
        parser.parse_args(["--help"])
    command, *rest = words
    if command not in ("render", "trace", "check"):
        parser.error(f"{command!r} is no command: use render, trace or check")
    if rest[:1] in (["-h"], ["--help"]):
        parser.parse_args(["--help"])
    if not rest or rest[0].startswith("-"):
        parser.error(f"the scene file follows {command}")
    scene, *rest = rest
    if command == "trace":
        for name in ("--rays", "--points"):
            parser.add_argument(name, metavar="FILE")
    known, options = parser.parse_known_args(rest)
    for option in options:
        if option.split("=")[0] in OWN:
            parser.error(f"{option} is of one process: leave it out")
    named = {name: getattr(known, name, None) for name in ("rays", "points")}
    if command == "render" and os.path.splitext(known.output)[1] not in (".png", ".exr"):
        raise FarmError(f"-o {known.output}: the name of a picture must end in .png or .exr")
    if "-" in (known.output, *named.values()):
        raise FarmError("-: parts are made of files and merged to a file, name one")
    return Arguments(
        command,
        scene,
        {f"--{name}": path for name, path in named.items() if path is not None},
        known.output,
        options,
        known.local,
        known.scheduler,
        known.parts,
        known.program,
        known.scheduler is None if known.shared is None else known.shared,
        known.threads,
        known.patience,
        known.keep_parts,
        known.json,
        known.quiet,
    )


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m cyltrace.farm",
        usage=USAGE,
        description="Renders, traces or checks a scene in parts by the workers of Dask. OUT has "
        "the bytes that one process would have written (for a check, those of --json OUT). The "
        "same command again goes on where an earlier one ended. Other options are those of "
        "`cyltrace render`, `trace` or `check`.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        required=True,
        help="the result; parts are in the folder OUT.parts until it is complete",
    )
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--local",
        metavar="N",
        type=_count(1024),
        help="start N workers on this machine [default: as many as it has cores]",
    )
    where.add_argument(
        "--scheduler", metavar="ADDRESS", help="use the workers of this scheduler, tcp://HOST:8786"
    )
    parser.add_argument(
        "--parts",
        metavar="N",
        type=_count(GREATEST_PARTS),
        help=f"divide the work into N parts [default: {PARTS_PER_WORKER} for each worker]",
    )
    parser.add_argument(
        "--threads",
        metavar="N",
        type=_count(1024),
        help="threads of the program for each part [default: the cores of a machine, divided by "
        "the parts that it makes at a time]",
    )
    parser.add_argument(
        "--shared",
        action=argparse.BooleanOptionalAction,
        help="whether workers see the current folder, the scene and OUT.parts under the same "
        "paths [default: with --local]; otherwise, the scene's files are sent to them",
    )
    parser.add_argument(
        "--program",
        metavar="PATH",
        help="the program, here and on all workers [default: $CYLTRACE_PROGRAM, else cyltrace]",
    )
    parser.add_argument(
        "--patience",
        metavar="SECONDS",
        type=float,
        default=600.0,
        help="wait so long for a scheduler or a worker [default: 600]",
    )
    parser.add_argument("--keep-parts", action="store_true", help="do not remove OUT.parts")
    parser.add_argument("--json", metavar="FILE", help="write the figures of `cyltrace merge`")
    parser.add_argument("-q", "--quiet", action="store_true", help="print errors only")
    return parser


class _count:
    """Reads a number from 1 to a greatest one."""

    def __init__(self, greatest: int) -> None:
        self._greatest = greatest

    def __call__(self, text: str) -> int:
        number = int(text) if text.isdecimal() else 0
        if not 1 <= number <= self._greatest:
            raise argparse.ArgumentTypeError(
                f"{text!r} must be a whole number from 1 to {self._greatest}"
            )
        return number
