"""A worker makes one part: it runs the program and returns what became of it.

The code of this file is sent with the tasks, so that workers need not have the package. It
imports nothing of the package, and tasks take and return plain values.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypedDict

#: How often a worker looks whether its task is cancelled, in seconds.
PAUSE = 0.2

#: How long a program may take to end that is asked to, in seconds.
GRACE = 5.0

#: The exit code of a program that could not run: its input is wrong, and would be again.
COULD_NOT_RUN = 2

#: Becomes the program after arranging for the signal SIGTERM when the worker dies. The worker
#: may have died before that, then nothing is run.
LAUNCHER = """
import ctypes, os, signal, sys
PR_SET_PDEATHSIG = 1
ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
if os.getppid() == int(sys.argv[1]):
    os.execv(sys.argv[2], sys.argv[2:])
"""

#: What became of a part. It is ``made``: its bytes follow unless the folder is shared. The
#: program has ``refused`` it, which it would again; or the program ``died``. The reason follows.
Answer: TypeAlias = tuple[Literal["made", "refused", "died"], Any]


class Job(TypedDict):
    """What all parts of a run have in common."""

    #: The program; None if each machine finds its own.
    program: str | None
    #: What ``cyltrace --version`` prints on the client.
    version: str
    #: The command and its arguments, without the part and its file.
    words: list[str]
    #: The number of parts.
    of: int
    #: The threads of the program; None for the worker's share of its machine.
    threads: int | None
    #: The folder in which the program runs: in the shared file system, or in ``files``.
    cwd: str
    #: The shared folder of the parts, None if nothing is shared.
    parts: str | None
    #: The paths of files where nothing is shared, and the SHA-256 of their contents.
    files: dict[str, str]
    #: The folders that paths lead through, whether files are in them or not.
    folders: list[str]


def part_name(number: int, of: int) -> str:
    """The name of a part's file, as `cyltrace render --workers` has them."""
    return f"{number:0{len(str(of))}}.cylpart"


def find_program(stated: str | None) -> str:
    """The path of the program: the stated one, the one in CYLTRACE_PROGRAM, or `cyltrace`."""
    name = stated or os.environ.get("CYLTRACE_PROGRAM") or "cyltrace"
    path = shutil.which(name)
    if path is None:
        raise FileNotFoundError(
            f"there is no program {name!r}: build it by `cargo build --release` in a clone of "
            "cyltrace, and name target/release/cyltrace by --program PATH, by the environment "
            "variable CYLTRACE_PROGRAM, or by PATH"
        )
    return os.path.abspath(path)


def version_of(program: str) -> str:
    """What ``cyltrace --version`` prints."""
    shown = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    return shown.stdout.strip()


def make_part(number: int, job: Job, contents: dict[str, bytes] | None = None) -> Answer:
    """The task: makes a part. ``contents`` has the contents of files by their SHA-256."""
    from distributed import get_worker

    worker = get_worker()
    try:
        program = find_program(job["program"])
        version = version_of(program)
    except (OSError, subprocess.SubprocessError) as error:
        return "refused", f"on the worker {worker.address}, {error}"
    if version != job["version"]:
        return "refused", (
            f"{program} on the worker {worker.address} is {version!r}, and this machine has "
            f"{job['version']!r}: all machines need the same version"
        )
    try:
        if job["parts"] is not None:
            output = os.path.join(job["parts"], part_name(number, job["of"]))
            return _run(worker, program, number, job, Path(job["cwd"]), output)
        root = _laid_out(Path(worker.local_directory), job, contents or {})
        with tempfile.TemporaryDirectory(prefix="part-", dir=root.parent) as scratch:
            output = os.path.join(scratch, "part")
            answer, detail = _run(worker, program, number, job, root / job["cwd"], output)
            return answer, Path(output).read_bytes() if answer == "made" else detail
    except OSError as error:
        return "died", f"on the worker {worker.address}, {error}"


def _run(worker: Any, program: str, number: int, job: Job, cwd: Path, output: str) -> Answer:
    """Runs the program in a folder and waits for it, or ends it if the task is cancelled."""
    from dask.system import CPU_COUNT

    if not cwd.is_dir():
        return "refused", (
            f"the worker {worker.address} has no folder {str(cwd)!r}: use --no-shared, which sends "
            "the scene's files"
        )
    threads = job["threads"] or max(1, CPU_COUNT // worker.state.nthreads)
    name, *words = job["words"]
    command = [program, name, f"--part={number}/{job['of']}", f"--output={output}", "--resume"]
    command += ["--quiet", f"--threads={threads}", *words]
    if sys.platform == "linux":
        command = [sys.executable, "-IS", "-c", LAUNCHER, str(os.getpid()), *command]
    process = subprocess.Popen(
        command,
        cwd=cwd,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        # Ctrl-C in a terminal reaches the client, which cancels the tasks.
        start_new_session=True,
    )
    key = worker.get_current_task()
    while True:
        try:
            _, printed = process.communicate(timeout=PAUSE)
            break
        except subprocess.TimeoutExpired:
            if _is_cancelled(worker, key):
                _end(process)
                return "died", f"the worker {worker.address} ended it"
    text = printed.decode(errors="replace").strip()
    code = process.returncode
    if code == 0:
        return "made", None
    if code == COULD_NOT_RUN:
        return "refused", f"on the worker {worker.address}: {text}"
    how = f"by {signal.Signals(-code).name}" if code < 0 else f"with exit code {code}"
    return "died", f"on the worker {worker.address} {how}" + (f": {text}" if text else "")


def _is_cancelled(worker: Any, key: Any) -> bool:
    """Whether nobody needs the task any more."""
    task = worker.state.tasks.get(key)
    ends = worker.status.name in ("closing", "closed", "stopping", "stopped", "failed")
    return ends or task is None or task.state == "cancelled"


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ends a program, which removes what it has not finished."""
    process.terminate()
    try:
        process.communicate(timeout=GRACE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()


def _laid_out(storage: Path, job: Job, contents: dict[str, bytes]) -> Path:
    """The folder with the files of the job, which the first task of a worker makes."""
    named = repr((sorted(job["files"].items()), job["folders"]))
    root = storage / "cyltrace" / hashlib.sha256(named.encode()).hexdigest()
    if root.is_dir():
        return root
    root.parent.mkdir(exist_ok=True)
    new = Path(tempfile.mkdtemp(prefix="files-", dir=root.parent))
    try:
        for folder in job["folders"]:
            (new / folder).mkdir(parents=True, exist_ok=True)
        for name, digest in job["files"].items():
            if hashlib.sha256(contents[digest]).hexdigest() != digest:
                raise OSError(f"the content of {name!r} was changed on its way")
            (new / name).write_bytes(contents[digest])
        new.rename(root)
    except OSError:
        shutil.rmtree(new, ignore_errors=True)
        # Another task may have been first.
        if not root.is_dir():
            raise
    return root
