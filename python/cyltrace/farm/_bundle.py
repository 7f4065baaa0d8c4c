"""The files that workers need where they share no folder.

A scene names its files by paths relative to its own. So the workers get them in folders like
those here, below the deepest folder that all of them and the current one are in, and run the
program in the counterpart of the current folder: all relative paths lead to the same files.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import PurePath

from ._error import FarmError

#: What would be right for a file that cannot be sent.
ADVICE = "name it by a path relative to the scene file, or use --shared and a folder that all see"


@dataclass(frozen=True)
class Bundle:
    """Files with their places, and their contents by SHA-256."""

    #: The current folder, and all that paths lead through.
    cwd: str
    folders: list[str]
    #: The SHA-256 of each file.
    files: dict[str, str]
    contents: dict[str, bytes]

    @property
    def key(self) -> str:
        """Names the contents."""
        digests = "".join(sorted(self.contents))
        return hashlib.sha256(digests.encode()).hexdigest()


def relative(path: str) -> str:
    """A path as seen from the current folder."""
    return os.path.relpath(path) if os.path.isabs(path) else path


def bundle(paths: Iterable[str]) -> Bundle:
    """Reads the files of relative paths.

    Raises
    ------
    FarmError
        If a path is absolute, leads back out of a symbolic link, or cannot be read.
    """
    paths = list(paths)
    here = os.getcwd()
    passed = {here}
    for path in paths:
        if os.path.isabs(path):
            raise FarmError(f"the scene names {path!r} by an absolute path: {ADVICE}")
        if os.path.realpath(path) != os.path.realpath(os.path.abspath(path)):
            raise FarmError(f"{path!r} leads through a symbolic link and back by `..`: {ADVICE}")
        passed |= {os.path.abspath(folder) for folder in PurePath(path).parents}
    base = os.path.commonpath(passed)
    files, contents = {}, {}
    for path in paths:
        try:
            with open(path, "rb") as file:
                content = file.read()
        except OSError as error:
            raise FarmError(f"cannot read {path!r}: {error.strerror}") from error
        digest = hashlib.sha256(content).hexdigest()
        files[os.path.relpath(path, base)] = digest
        contents[digest] = content
    folders = sorted(os.path.relpath(folder, base) for folder in passed)
    return Bundle(os.path.relpath(here, base), folders, files, contents)
