"""Rounds of tasks, until all parts are there.

A round submits a task for every part that is missing. It ends when all its tasks have ended or
when the connection is lost. Then the folder shows what is still missing, and another round
begins.
"""

from __future__ import annotations

from ._cluster import connected
from ._error import ConnectionLost, FarmError
from ._round import Round, Run

#: Rounds in a row without a new part, after which another one would not help.
MOST_IDLE_ROUNDS = 5


def make_all(run: Run, address: str) -> None:
    """Makes all parts that are missing.

    Raises
    ------
    FarmError
        If a part cannot be made.
    """
    of, note = run.job["of"], run.display.note
    missing = _missing(run)
    run.display.begin(len(run.done), of)
    # Parts of an earlier run may be of another scene or other settings. One part is made, or
    # verified by the program, and compared with them before the others.
    run.compares = bool(run.done)
    todo, idle = missing or [1], 0
    while todo:
        before = len(todo)
        try:
            with connected(address, run.patience, note) as client:
                if run.compares:
                    Round(run, client).make(todo[:1])
                    todo = todo[1:]
                Round(run, client).make(todo)
        except ConnectionLost as lost:
            note(f"{lost}; what is missing is made in another round")
        todo = _missing(run)
        idle = idle + 1 if len(todo) >= before else 0
        if idle == MOST_IDLE_ROUNDS:
            raise FarmError(
                f"{len(todo)} parts, such as {todo[0]}/{of}, are still not in "
                f"{str(run.folder.path)!r} after {idle} rounds"
            )


def _missing(run: Run) -> list[int]:
    """The parts that are not there or damaged."""
    present, of = run.folder.present(), run.job["of"]
    if present.of not in (None, of):
        raise FarmError(
            f"{str(run.folder.path)!r} has parts 1/{present.of} to {present.of}/{present.of}: use "
            f"--parts {present.of}, or remove it"
        )
    for reason in present.damaged:
        run.display.note(reason)
    run.done = set(present.numbers)
    return [number for number in range(1, of + 1) if number not in run.done]
