"""What rows of arrays become."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rows:
    """Rows that become solids of one kind."""

    #: The number of the prototype that gets them.
    prototype: int
    count: int
    #: The number of their material.
    material: int
    #: Whether rows that are no solid are left out.
    skips: bool
