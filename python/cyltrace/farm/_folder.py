"""The folder of the parts, beside the output until that is complete."""

from __future__ import annotations

import fcntl
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from ._error import FarmError
from ._part import part_name
from ._program import Program

#: The names of files that the program, or this package, has not finished.
UNFINISHED = ".cyltrace-"
#: The file that a run locks, as ``cyltrace render --workers`` does, so that no other works there.
LOCK = "lock"


@dataclass(frozen=True)
class Present:
    """The valid parts in a folder."""

    #: How many parts the result is divided into; None if there is no part.
    of: int | None
    numbers: frozenset[int]
    #: Why parts cannot be used.
    damaged: list[str]


class Folder:
    """The folder ``OUT.parts``."""

    def __init__(self, output: str, program: Program) -> None:
        self.path = Path(os.path.abspath(output) + ".parts")
        self._program = program
        self._lock: IO[str] | None = None

    def create(self) -> None:
        """Makes the folder if it is not there, and locks it until this program ends.

        Raises
        ------
        FarmError
            If it cannot be made, or another run works in it.
        """
        try:
            self.path.mkdir(exist_ok=True)
            self._lock = (self.path / LOCK).open("w")
        except OSError as error:
            raise FarmError(
                f"cannot make the folder {str(self.path)!r}: {error.strerror}"
            ) from error
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise FarmError(f"another run is making the parts in {str(self.path)!r}") from error
        except OSError:
            # A file system without locks.
            pass

    def present(self) -> Present:
        """The parts that are there.

        Raises
        ------
        FarmError
            If they do not all belong to one result.
        """
        survey = self._program.survey(str(self.path))
        results = survey["results"]
        if len(results) > 1:
            raise FarmError(
                f"{str(self.path)!r} has parts of {len(results)} results"
                f"{_difference(results[0]['settings'], results[1]['settings'])}: remove it, or "
                "choose another output"
            )
        damaged = [
            str(one["reason"])
            for one in survey["damaged"]
            if not os.path.basename(one["file"]).startswith(UNFINISHED)
        ]
        parts = results[0]["parts"] if results else []
        of = {int(part["of"]) for part in parts}
        if len(of) > 1:
            raise FarmError(f"{str(self.path)!r} has parts of several divisions: remove it")
        numbers = [
            int(part["part"])
            for part in parts
            if os.path.basename(part["file"]) == part_name(part["part"], part["of"])
        ]
        return Present(of.pop() if of else None, frozenset(numbers), damaged)

    def write(self, number: int, of: int, content: bytes) -> None:
        """Writes a part: it is complete when it gets its name.

        Raises
        ------
        FarmError
            If it cannot be written.
        """
        path = self.path / part_name(number, of)
        try:
            handle, temporary = tempfile.mkstemp(prefix=UNFINISHED, dir=self.path)
            try:
                with open(handle, "wb") as file:
                    file.write(content)
                    file.flush()
                    os.fsync(file.fileno())
                os.rename(temporary, path)
            except OSError:
                os.unlink(temporary)
                raise
        except OSError as error:
            raise FarmError(f"cannot write {str(path)!r}: {error.strerror}") from error

    def has(self, number: int, of: int) -> bool:
        """Whether a part has its name here."""
        return (self.path / part_name(number, of)).exists()

    def remove_part(self, number: int, of: int) -> None:
        """Removes a part if it is there."""
        (self.path / part_name(number, of)).unlink(missing_ok=True)

    def clean(self) -> None:
        """Removes what programs that died have not finished."""
        for path in self.path.glob(f"{UNFINISHED}*"):
            path.unlink(missing_ok=True)

    def remove(self, of: int) -> None:
        """Removes the parts, and the folder unless other files are in it."""
        self.clean()
        for number in range(1, of + 1):
            self.remove_part(number, of)
        if all(path.name == LOCK for path in self.path.iterdir()):
            (self.path / LOCK).unlink(missing_ok=True)
            self.path.rmdir()


def _difference(first: dict[str, object], second: dict[str, object]) -> str:
    """The settings that differ, in brackets."""
    keys = [key for key in {**first, **second} if first.get(key) != second.get(key)]
    if not keys:
        return " (of other contents of the scene's files, or another version of cyltrace)"
    shown = [f"{key} {first.get(key)} and {second.get(key)}" for key in keys]
    return f" ({', '.join(shown)})"
