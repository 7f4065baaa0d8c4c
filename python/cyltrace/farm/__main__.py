"""``python -m cyltrace.farm``."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from ._arguments import PARTS_PER_WORKER, Arguments, parse
from ._bundle import Bundle, bundle, relative
from ._display import Display
from ._error import FarmError
from ._folder import Folder
from ._part import Job
from ._program import Program

#: The exit codes of the program: a wrong answer, and arguments or input that are wrong.
CHECK_FAILED = 1
COULD_NOT_RUN = 2


def main(words: list[str] | None = None) -> int:
    """Runs the command line. Returns the exit code, that of ``cyltrace merge`` in the end."""
    try:
        arguments = parse(sys.argv[1:] if words is None else words)
        with _ended_by_signals():
            return _run(arguments)
    except FarmError as error:
        print(f"error: {error}", file=sys.stderr)
        return COULD_NOT_RUN
    except _Signal as received:
        print("interrupted; the same command makes the parts that are missing", file=sys.stderr)
        return 128 + received.number


def _run(arguments: Arguments) -> int:
    try:
        from ._cluster import hush
    except ImportError as error:
        raise FarmError(f"{error}: `pip install 'cyltrace[farm]'` installs Dask") from error
    hush()
    program = Program.find(arguments.program)
    folder = Folder(arguments.output, program)
    display = Display(arguments.quiet)
    files = _bundle(arguments, program)
    folder.create()
    try:
        of = _make(arguments, program, folder, files, display)
    finally:
        display.end()
    folder.clean()
    words = [f"--output={arguments.output}"]
    words += [f"--json={arguments.json}"] if arguments.json else []
    words += ["--quiet"] if arguments.quiet else []
    code = program.merge(str(folder.path), words)
    if code not in (0, CHECK_FAILED):
        print(f"the parts are in {str(folder.path)!r}", file=sys.stderr)
    elif not arguments.keeps_parts:
        folder.remove(of)
    return code


def _bundle(arguments: Arguments, program: Program) -> Bundle | None:
    """The files that workers need; their paths on the command line become relative."""
    if arguments.shared:
        return None
    arguments.scene = relative(arguments.scene)
    arguments.inputs = {name: relative(path) for name, path in arguments.inputs.items()}
    scene = arguments.scene
    return bundle([scene, *program.files(scene), *arguments.inputs.values()])


def _make(
    arguments: Arguments, program: Program, folder: Folder, files: Bundle | None, display: Display
) -> int:
    """Makes all parts. Returns their number."""
    from dask.system import CPU_COUNT

    from ._cluster import await_workers, connected, local_cluster
    from ._driver import make_all
    from ._round import Run

    threads, stated = arguments.threads, arguments.program
    with ExitStack() as stack:
        if arguments.scheduler is None:
            workers = arguments.local or CPU_COUNT
            threads = threads or max(1, CPU_COUNT // workers)
            stated = program.path
            address = stack.enter_context(local_cluster(workers))
        else:
            address = arguments.scheduler
        of = arguments.parts or folder.present().of
        if of is None:
            with connected(address, arguments.patience, display.note) as client:
                of = PARTS_PER_WORKER * await_workers(client, arguments.patience, display.note)
        job: Job = {
            "program": stated,
            "version": program.version,
            "words": [
                arguments.command,
                *(f"{name}={path}" for name, path in arguments.inputs.items()),
                *arguments.options,
                "--",
                arguments.scene,
            ],
            "of": of,
            "threads": threads,
            "cwd": files.cwd if files else os.getcwd(),
            "parts": None if files else str(folder.path),
            "files": files.files if files else {},
            "folders": files.folders if files else [],
        }
        make_all(Run(job, folder, files, arguments.patience, display), address)
    return of


class _Signal(BaseException):
    """Ctrl-C, or SIGTERM."""

    def __init__(self, number: int) -> None:
        self.number = number


@contextmanager
def _ended_by_signals() -> Iterator[None]:
    """Turns signals into exceptions, so that all that was begun is ended."""

    def raise_signal(number: int, _frame: object) -> None:
        # Another signal ends this program at once.
        signal.signal(number, signal.SIG_DFL)
        raise _Signal(number)

    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:
            signal.signal(number, raise_signal)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


if __name__ == "__main__":
    sys.exit(main())
