"""What the tests share."""

from __future__ import annotations

import importlib.util
import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

#: Modules that need Dask.
collect_ignore_glob = [] if importlib.util.find_spec("distributed") else ["cyltrace/farm/*"]


@pytest.fixture(autouse=True)
def elsewhere(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Runs every test and example in a folder of its own, where it may leave files."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture(autouse=True)
def interrupts() -> Iterator[None]:
    """Ctrl-C raises KeyboardInterrupt, even where the tests run in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def scenes() -> Path:
    """The folder of the sample scenes."""
    return ROOT / "scenes"


@pytest.fixture
def program() -> str:
    """The program `cyltrace` of the same checkout."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    stated = os.environ.get("CYLTRACE_PROGRAM", str(target / "release" / "cyltrace"))
    found = shutil.which(stated)
    if found is None:
        pytest.skip(f"{stated} is not there: build it with `cargo build --release`")
    return found
