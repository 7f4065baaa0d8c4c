"""What ends a run."""

from __future__ import annotations


class FarmError(Exception):
    """A run cannot go on. The text is for people: what is wrong, where, what would be right."""


class ConnectionLost(Exception):
    """The scheduler, or data that it kept, is gone; another round makes the missing parts."""
