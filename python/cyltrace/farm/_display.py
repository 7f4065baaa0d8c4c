"""The progress on standard error: a bar on a terminal, a line each tenth elsewhere."""

from __future__ import annotations

import sys
import time

#: Columns of the bar.
WIDTH = 30


def duration(seconds: float) -> str:
    """A time as 7 s, 1:05 or 2:03:09."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


class Display:
    """Shows how many parts are there."""

    def __init__(self, quiet: bool) -> None:
        self._quiet = quiet
        self._is_terminal = sys.stderr.isatty()
        self._shown = ""
        self._start = time.monotonic()
        self._total = self._done = self._at_start = self._tenths = 0

    def begin(self, done: int, total: int) -> None:
        """Parts that were there before are not counted in the time that is left."""
        self._done, self._at_start, self._total = done, done, total
        self._tenths = 10 * done // total
        self._start = time.monotonic()
        if done:
            self.note(f"{done} of {total} parts are there from an earlier run")

    def set(self, done: int) -> None:
        """Shows the number of parts that are there."""
        self._done = done
        if self._is_terminal:
            self.refresh()
            return
        tenths = 10 * done // self._total
        if tenths > self._tenths:
            self._tenths = tenths
            self._print(f"{done} of {self._total} parts{self._times()}\n")

    def refresh(self) -> None:
        """Draws the bar again, with the time."""
        if not self._is_terminal or not self._total:
            return
        filled = WIDTH * self._done // self._total
        bar = "█" * filled + "░" * (WIDTH - filled)
        self._replace(f"{bar} {self._done}/{self._total} parts{self._times()}")

    def note(self, text: str) -> None:
        """Prints a line."""
        self._replace("")
        self._print(f"{text}\n")
        self.refresh()

    def end(self) -> None:
        """Removes the bar; a line of a run that is complete stays."""
        self._replace("")
        if self._is_terminal and self._total and self._done == self._total:
            self._print(f"{self._total} parts{self._times()}\n")
        self._total = 0

    def _times(self) -> str:
        elapsed, made = time.monotonic() - self._start, self._done - self._at_start
        text = f", {duration(elapsed)}"
        if made and self._done < self._total:
            left = elapsed / made * (self._total - self._done)
            text += f", about {duration(left)} left"
        return text

    def _replace(self, text: str) -> None:
        if self._is_terminal and text != self._shown:
            # Goes to the first column and clears the line.
            self._print(f"\r\x1b[K{text}")
            self._shown = text

    def _print(self, text: str) -> None:
        if not self._quiet:
            sys.stderr.write(text)
            sys.stderr.flush()
