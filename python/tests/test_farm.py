"""Results by workers of Dask, among them some that die, against those of one process."""

from __future__ import annotations

import json
import os
import resource
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("distributed", reason="dask.distributed is not installed")

#: No run and nothing that a test waits for takes longer, in seconds.
LONGEST = 100.0

pytestmark = pytest.mark.timeout(150)


def wait_until(condition: Callable[[], Any], what: str) -> Any:
    end = time.monotonic() + LONGEST
    while not (found := condition()):
        assert time.monotonic() < end, f"waited in vain: {what}"
        time.sleep(0.05)
    return found


def is_running(process: int) -> bool:
    """Whether a process runs; one that has ended and was not waited for does not."""
    try:
        status = Path(f"/proc/{process}/stat").read_text()
    except FileNotFoundError:
        return False
    return status.rsplit(")", 1)[1].split()[0] != "Z"


class Farm:
    """Runs of ``python -m cyltrace.farm`` whose program notes what it does.

    The program is a script that runs the real one. For every part, it writes a line to ``log``;
    then it waits while there is a file ``hold.PART``, and dies if there is a file ``die.PART``,
    which it removes, or ``die_always.PART``.
    """

    def __init__(self, program: str, folder: Path) -> None:
        self.real = program
        self.folder = folder
        self._notes = folder / "notes"
        self._notes.mkdir()
        self.program = self._notes / "program"
        self.program.write_text(
            f"""#!/bin/sh
            notes={self._notes}
            for word; do
                case $word in --part=*/*)
                    part=${{word#--part=}}; part=${{part%/*}}
                    echo "$part $$ $PPID" >> $notes/log
                    if [ -e $notes/die.$part ]; then rm $notes/die.$part; kill -9 $$; fi
                    if [ -e $notes/die_always.$part ]; then kill -9 $$; fi
                    while [ -e $notes/hold.$part ]; do sleep 0.05; done;;
                esac
            done
            exec {program} "$@"
            """
        )
        self.program.chmod(0o755)
        self.processes: list[subprocess.Popen[str]] = []

    def note(self, name: str) -> Path:
        path = self._notes / name
        path.touch()
        return path

    def hold(self, part: int) -> Path:
        """Holds a part until the file that is returned is removed."""
        return self.note(f"hold.{part}")

    def log(self) -> list[list[int]]:
        """The part, the process and the worker of every start of the program, in order."""
        path = self._notes / "log"
        lines = path.read_text().splitlines() if path.exists() else []
        return [[int(word) for word in line.split()] for line in lines]

    def starts(self) -> Counter[int]:
        """How often each part was begun."""
        return Counter(part for part, _, _ in self.log())

    def begun(self, part: int) -> tuple[int, int]:
        """Waits until a part is begun. Returns its process and its worker's."""

        def entries() -> list[list[int]]:
            return [entry for entry in self.log() if entry[0] == part]

        _, process, worker = wait_until(entries, f"part {part} begins")[-1]
        return process, worker

    def begin(self, *words: str | Path, **options: Any) -> subprocess.Popen[str]:
        """Begins a run."""
        command = [sys.executable, "-m", "cyltrace.farm", *map(str, words)]
        return self.start(command, **options)

    def start(self, command: list[str], **options: Any) -> subprocess.Popen[str]:
        environment = {**os.environ, "CYLTRACE_PROGRAM": str(self.program)}
        process = subprocess.Popen(
            command,
            env=environment,
            text=True,
            # A group of its own, as in a terminal.
            start_new_session=True,
            **{
                "cwd": self.folder,
                "stderr": subprocess.PIPE,
                "stdout": subprocess.DEVNULL,
                **options,
            },
        )
        self.processes.append(process)
        return process

    def run(self, *words: str | Path, code: int = 0, **options: Any) -> str:
        """Runs to the end. Returns what was printed on standard error."""
        return self.end(self.begin(*words, **options), code)

    def end(self, process: subprocess.Popen[str], code: int = 0) -> str:
        _, printed = process.communicate(timeout=LONGEST)
        assert process.returncode == code, printed
        return printed

    def one_process(self, *words: str | Path) -> None:
        subprocess.run([self.real, *map(str, words), "--quiet"], cwd=self.folder, check=True)

    def scheduler(self, port: int) -> subprocess.Popen[str]:
        words = ["scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard"]
        return self.start([sys.executable, "-m", "dask", *words], stderr=subprocess.DEVNULL)

    def worker(self, port: int, folder: Path) -> subprocess.Popen[str]:
        folder.mkdir(exist_ok=True)
        words = ["worker", f"tcp://127.0.0.1:{port}", "--nthreads", "1", "--no-dashboard"]
        words += ["--local-directory", str(folder)]
        command = [sys.executable, "-m", "dask", *words]
        return self.start(command, stderr=subprocess.DEVNULL, cwd=folder)

    def close(self) -> None:
        for process in self.processes:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.communicate()


@pytest.fixture
def farm(program: str, tmp_path: Path) -> Iterator[Farm]:
    farm = Farm(program, tmp_path)
    yield farm
    farm.close()


@pytest.fixture
def port() -> int:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return int(free.getsockname()[1])


@pytest.fixture
def forest(scenes: Path, tmp_path: Path) -> str:
    """A scene in a folder, with its tables in another."""
    tables = tmp_path / "scenes" / "tables"
    tables.mkdir(parents=True)
    for path in scenes.glob("*.csv"):
        shutil.copy(path, tables)
    text = (scenes / "forest.toml").read_text()
    (tmp_path / "scenes" / "forest.toml").write_text(text.replace('file = "', 'file = "tables/'))
    return "scenes/forest.toml"


@pytest.fixture
def sticks(tmp_path: Path) -> str:
    """A small scene in a folder, with its table in another."""
    tables = tmp_path / "small" / "tables"
    tables.mkdir(parents=True)
    rows = [f"{i % 10},{i // 10},0,{i % 10}.3,{i // 10},1,0.2" for i in range(80)]
    (tables / "sticks.csv").write_text("x0,y0,z0,x1,y1,z1,r\n" + "\n".join(rows) + "\n")
    (tmp_path / "small" / "sticks.toml").write_text(
        """
        [camera]
        position = [5, -9, 7]
        look_at = [5, 4, 0]
        [[cylinder_table]]
        file = "tables/sticks.csv"
        columns = { p0 = ["x0", "y0", "z0"], p1 = ["x1", "y1", "z1"], radius = "r" }
        """
    )
    return "small/sticks.toml"


def table_of_rays(path: Path) -> Path:
    rows = [f"{x / 5},{y / 5},20,0.0{x % 7},0.1,-1" for x in range(50) for y in range(40)]
    path.write_text("ox,oy,oz,dx,dy,dz\n" + "\n".join(rows) + "\n")
    return path


def same_checks(folder: Path) -> bool:
    """Whether two JSON files of checks differ in their times only."""
    expected, found = (
        json.loads((folder / f"{name}.json").read_bytes()) for name in ("expected", "found")
    )
    assert expected.pop("check_s") > 0 and found.pop("check_s") > 0
    return list(found.items()) == list(expected.items())


SMALL = ("--size=160x90", "--spp=2")


@pytest.mark.parametrize("ending", ["png", "exr"])
def test_picture_is_that_of_one_process(farm: Farm, forest: str, ending: str) -> None:
    expected, found = farm.folder / f"expected.{ending}", farm.folder / f"found.{ending}"
    farm.one_process("render", forest, "-o", expected, *SMALL)
    printed = farm.run("render", forest, "-o", found, "--local=2", "--parts=7", *SMALL)
    assert found.read_bytes() == expected.read_bytes()
    assert farm.starts() == dict.fromkeys(range(1, 8), 1)
    assert "7 of 7 parts" in printed
    assert not Path(f"{found}.parts").exists()


def test_table_and_check_are_those_of_one_process(farm: Farm, sticks: str) -> None:
    table_of_rays(farm.folder / "rays.csv")
    farm.one_process("trace", sticks, "--rays", "rays.csv", "-o", "expected.csv", "--all")
    farm.run("trace", sticks, "--rays=rays.csv", "-o", "found.csv", "--local=2", "--all")
    found = (farm.folder / "found.csv").read_bytes()
    assert found == (farm.folder / "expected.csv").read_bytes()
    assert found.count(b"\n") > 2000

    farm.one_process("check", sticks, "--rays=300", "--json=expected.json")
    farm.run("check", sticks, "-o", "found.json", "--local=2", "--parts=3", "--rays=300")
    assert same_checks(farm.folder)


@pytest.mark.parametrize("allowed", [0, 3])
def test_killed_worker(
    farm: Farm, forest: str, allowed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even if the scheduler gives a part up with its first worker."""
    monkeypatch.setenv("DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES", str(allowed))
    farm.one_process("render", forest, "-o", "expected.png", *SMALL)
    held = farm.hold(3)
    run = farm.begin("render", forest, "-o", "found.png", "--local=2", "--parts=6", *SMALL)
    process, worker = farm.begun(3)
    os.kill(worker, signal.SIGKILL)
    wait_until(lambda: not is_running(process), "the program ends with its worker")
    held.unlink()
    printed = farm.end(run)
    assert ("workers died" in printed) == (allowed == 0)
    assert farm.starts()[3] == 2
    assert (farm.folder / "found.png").read_bytes() == (farm.folder / "expected.png").read_bytes()


def test_scheduler_restarted(farm: Farm, forest: str, port: int, tmp_path: Path) -> None:
    farm.one_process("render", forest, "-o", "expected.png", *SMALL)
    held = farm.hold(4)
    scheduler, worker = farm.scheduler(port), farm.worker(port, tmp_path / "first")
    run = farm.begin(
        *("render", forest, "-o", "found.png", f"--scheduler=tcp://127.0.0.1:{port}"),
        *("--shared", "--parts=6", *SMALL),
    )
    process, _ = farm.begun(4)
    parts = tmp_path / "found.png.parts"
    before = {path.name for path in parts.glob("*.cylpart")}
    assert before
    scheduler.kill()
    wait_until(lambda: not is_running(process), "the program ends with the connection")
    wait_until(lambda: worker.poll() is not None, "the worker ends with the connection")
    held.unlink()
    farm.scheduler(port)
    farm.worker(port, tmp_path / "second")
    printed = farm.end(run)
    assert "lost" in printed
    assert all(farm.starts()[int(name.split(".")[0])] == 1 for name in before)
    assert (tmp_path / "found.png").read_bytes() == (tmp_path / "expected.png").read_bytes()


def test_damaged_part_is_made_again(farm: Farm, forest: str) -> None:
    words = ("render", forest, "-o", "found.png", "--local=2", "--keep-parts", *SMALL)
    farm.run(*words, "--parts=5")
    found, parts = farm.folder / "found.png", farm.folder / "found.png.parts"
    expected = found.read_bytes()
    found.unlink()
    damaged, short = parts / "2.cylpart", parts / "4.cylpart"
    content = damaged.read_bytes()
    middle = len(content) // 2
    changed = bytes([content[middle] ^ 1])
    damaged.write_bytes(content[:middle] + changed + content[middle + 1 :])
    short.write_bytes(short.read_bytes()[:-9])
    (parts / ".cyltrace-left").write_bytes(content[:middle])
    (parts / "3.cylpart").unlink()
    before = farm.starts()
    # The number of parts is that of the folder.
    printed = farm.run(*words)
    assert farm.starts() - before == {2: 1, 3: 1, 4: 1}
    assert "2 of 5 parts are there" in printed and "2.cylpart" in printed
    assert found.read_bytes() == expected


def test_parts_of_other_settings_are_not_mixed(farm: Farm, forest: str) -> None:
    words = ("render", forest, "-o", "found.png", "--local=2", "--keep-parts", "--size=160x90")
    farm.run(*words, "--parts=3", "--spp=1")
    picture = farm.folder / "found.png"
    expected = picture.read_bytes()
    printed = farm.run(*words, "--spp=2", code=2)
    assert "parts of 2 results" in printed and "spp" in printed
    printed = farm.run(*words, "--parts=4", "--spp=1", code=2)
    assert "use --parts 3" in printed
    assert picture.read_bytes() == expected
    # Those of the first run are still of use; the part that did not fit is gone.
    before = farm.starts()
    farm.run(*words, "--spp=1")
    assert farm.starts() - before == {1: 1}
    assert picture.read_bytes() == expected


def test_files_are_sent_where_nothing_is_shared(
    farm: Farm, sticks: str, port: int, tmp_path: Path
) -> None:
    farm.scheduler(port)
    storage = tmp_path / "worker"
    farm.worker(port, storage)
    (tmp_path / "elsewhere").mkdir()
    rays = table_of_rays(tmp_path / "elsewhere" / "rays.csv")
    farm.one_process("trace", sticks, "--rays", rays, "-o", "expected.csv")
    farm.one_process("check", sticks, "--rays=100", "--json=expected.json")
    held = farm.hold(2)
    words = (f"--scheduler=tcp://127.0.0.1:{port}", "--parts=2")
    run = farm.begin("trace", tmp_path / sticks, "--rays", rays, "-o", "found.csv", *words)
    farm.begun(2)
    # The worker has its own files.
    (laid_out,) = storage.glob("**/small/sticks.toml")
    assert (laid_out.parent / "tables" / "sticks.csv").is_file()
    held.unlink()
    farm.end(run)
    assert (tmp_path / "found.csv").read_bytes() == (tmp_path / "expected.csv").read_bytes()
    farm.run("check", sticks, "-o", "found.json", "--rays=100", *words)
    assert same_checks(tmp_path)

    scene, table = tmp_path / sticks, tmp_path / "small" / "tables" / "sticks.csv"
    scene.write_text(scene.read_text().replace("tables/sticks.csv", str(table)))
    printed = farm.run("render", sticks, "-o", "found.png", *words, code=2)
    assert f"{table}' by an absolute path" in printed and "--shared" in printed


def test_worker_killed_that_alone_has_the_files(
    farm: Farm, forest: str, port: int, tmp_path: Path
) -> None:
    farm.one_process("render", forest, "-o", "expected.png", *SMALL)
    farm.scheduler(port)
    farm.worker(port, tmp_path / "worker")
    held = farm.hold(2)
    words = (f"--scheduler=tcp://127.0.0.1:{port}", "--parts=3", *SMALL)
    run = farm.begin("render", forest, "-o", "found.png", *words)
    _, worker = farm.begun(2)
    # Its nanny starts another one.
    os.kill(worker, signal.SIGKILL)
    held.unlink()
    farm.end(run)
    assert farm.starts()[1] == 1
    assert (tmp_path / "found.png").read_bytes() == (tmp_path / "expected.png").read_bytes()


def test_worker_that_joins(farm: Farm, forest: str, port: int, tmp_path: Path) -> None:
    farm.one_process("render", forest, "-o", "expected.png", *SMALL)
    held = farm.hold(1)
    words = (f"--scheduler=tcp://127.0.0.1:{port}", "--parts=5", *SMALL)
    # Neither a scheduler nor a worker is there yet.
    run = farm.begin("render", forest, "-o", "found.png", *words)
    farm.scheduler(port)
    farm.worker(port, tmp_path / "first")
    _, first = farm.begun(1)
    farm.worker(port, tmp_path / "second")
    parts = tmp_path / "found.png.parts"
    wait_until(lambda: len(list(parts.glob("*.cylpart"))) == 4, "the second makes the others")
    held.unlink()
    printed = farm.end(run)
    assert "waiting for" in printed
    assert {worker for part, _, worker in farm.log() if part != 1}.isdisjoint({first})
    assert (tmp_path / "found.png").read_bytes() == (tmp_path / "expected.png").read_bytes()


def test_refused_part_is_not_tried_again(farm: Farm, forest: str) -> None:
    printed = farm.run("render", forest, "-o", "found.png", "--local=2", "--spp=0", code=2)
    assert "--spp" in printed and "on the worker tcp://" in printed
    assert set(farm.starts().values()) == {1}


def test_program_that_dies(farm: Farm, forest: str) -> None:
    farm.note("die.2")
    words = ("render", forest, "-o", "found.png", "--local=2", "--parts=3", *SMALL)
    printed = farm.run(*words)
    assert "part 2/3: the program died" in printed and "SIGKILL" in printed
    assert farm.starts() == {1: 1, 2: 2, 3: 1}
    farm.note("die_always.1")
    printed = farm.run(*words, code=2)
    assert "part 1/3: the program died 3 times" in printed
    assert farm.starts()[1] == 4


@pytest.mark.parametrize("is_local", [True, False])
def test_interrupted_run_goes_on(
    farm: Farm, forest: str, is_local: bool, port: int, tmp_path: Path
) -> None:
    farm.one_process("render", forest, "-o", "expected.png", *SMALL)
    where = "--local=1" if is_local else f"--scheduler=tcp://127.0.0.1:{port}"
    if not is_local:
        farm.scheduler(port)
        farm.worker(port, tmp_path / "worker")
    held = farm.hold(4)
    words = ("render", forest, "-o", "found.png", where, "--parts=6", *SMALL)
    run = farm.begin(*words)
    process, worker = farm.begun(4)
    # As a terminal does, to all processes of the run.
    os.killpg(run.pid, signal.SIGINT)
    printed = farm.end(run, code=130)
    assert "the same command" in printed and "Traceback" not in printed
    wait_until(lambda: not is_running(process), "the program ends")
    assert is_running(worker) == (not is_local)
    held.unlink()
    farm.run(*words)
    assert farm.starts() == {1: 1, 2: 1, 3: 1, 4: 2, 5: 1, 6: 1}
    assert (tmp_path / "found.png").read_bytes() == (tmp_path / "expected.png").read_bytes()


def test_one_run_at_a_time(farm: Farm, forest: str) -> None:
    held = farm.hold(1)
    words = ("render", forest, "-o", "found.png", "--local=1", "--parts=2", *SMALL)
    run = farm.begin(*words)
    farm.begun(1)
    assert "another run" in farm.run(*words, code=2)
    # The program's own workers have the same folder and the same lock.
    command = [farm.real, "render", forest, "-o", "found.png", "--workers=1", "--resume", *SMALL]
    program = subprocess.run(command, cwd=farm.folder, stderr=subprocess.PIPE, text=True)
    assert program.returncode == 2 and "another run" in program.stderr
    held.unlink()
    farm.end(run)
    assert not (farm.folder / "found.png.parts").exists()


def test_full_disk(farm: Farm, forest: str) -> None:
    words = ("render", forest, "-o", "found.exr", "--local=1", "--parts=2", *SMALL)

    def limit() -> None:
        # A part has 86 kB.
        resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))

    printed = farm.run(*words, code=2, preexec_fn=limit)
    assert "part 1/2" in printed and "large" in printed
    left = [path.name for path in (farm.folder / "found.exr.parts").iterdir()]
    assert left == ["lock"]
    # The same where the part is sent and written here, after the worker.
    printed = farm.run(*words, "--no-shared", code=2, preexec_fn=limit)
    assert "part 1/2" in printed and "large" in printed
    farm.run(*words)
    farm.one_process("render", forest, "-o", "expected.exr", *SMALL)
    assert (farm.folder / "found.exr").read_bytes() == (farm.folder / "expected.exr").read_bytes()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["render"], "the scene file follows render"),
        (["draw", "scene.toml"], "use render, trace or check"),
        (["render", "--spp=4", "scene.toml", "-o", "x.png"], "the scene file follows render"),
        (["render", "scene.toml", "-o", "x.jpg"], "must end in .png or .exr"),
        (["trace", "scene.toml", "--rays=-", "-o", "x.csv"], "name one"),
        (["render", "scene.toml", "-o", "x.png", "--part=1/2"], "leave it out"),
        (["render", "scene.toml", "-o", "x.png", "--local=0"], "from 1 to 1024"),
        (["render", "scene.toml", "-o", "no/x.png"], "cannot make the folder"),
        (["render", "scene.toml", "-o", "x.png", "--program=none"], "there is no program 'none'"),
        (
            ["render", "x.toml", "-o", "x.png", "--scheduler=tcp://127.0.0.1:9", "--shared"]
            + ["--patience=0"],
            "there is no scheduler at tcp://127.0.0.1:9",
        ),
    ],
)
def test_wrong_arguments(farm: Farm, words: list[str], message: str) -> None:
    assert message in farm.run(*words, code=2)
