"""The program on this machine: what it says of scenes and parts."""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from typing import Any

from ._error import FarmError
from ._part import find_program, version_of


@dataclass(frozen=True)
class Program:
    """The program ``cyltrace``."""

    path: str
    version: str

    @staticmethod
    def find(stated: str | None) -> Program:
        """Finds the program.

        Raises
        ------
        FarmError
            If there is none, or it does not run.
        """
        try:
            path = find_program(stated)
            return Program(path, version_of(path))
        except (OSError, subprocess.SubprocessError) as error:
            raise FarmError(str(error)) from error

    def files(self, scene: str) -> list[str]:
        """The files that a scene reads."""
        figures = self._json("info", scene)
        if "files" not in figures:
            raise FarmError(f"{self.path} is too old to list the files of a scene: build it again")
        return list(figures["files"])

    def survey(self, folder: str) -> dict[str, Any]:
        """The parts in a folder, as ``cyltrace parts --json`` has them."""
        return self._json("parts", folder, incomplete=1)

    def merge(self, folder: str, words: list[str]) -> int:
        """Merges the parts in a folder. Returns the exit code; the program prints."""
        return subprocess.run([self.path, "merge", folder, *words], check=False).returncode

    def _json(self, *words: str, incomplete: int = 0) -> dict[str, Any]:
        command = [self.path, *words, "--json=-"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode not in (0, incomplete):
            printed = done.stderr.strip() or f"it ended with {done.returncode}"
            raise FarmError(f"`cyltrace {words[0]}`: {printed}")
        return dict(json.loads(done.stdout))
