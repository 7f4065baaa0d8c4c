"""The figure of `peers.py`: speed and error of each program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

#: Colors that people with any color vision can tell apart (Okabe and Ito).
RIGHT, WRONG = "#0072b2", "#d55e00"

#: Programs whose labels are below their points, as others are close above.
BELOW = ("cyltrace", "Mitsuba llvm_ad_rgb")


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    """Draws a panel for each kind of rays. Needs matplotlib."""
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    # The same rows give the same file.
    matplotlib.rcParams.update({"svg.hashsalt": "peers", "svg.fonttype": "none"})
    kinds = list(dict.fromkeys(row["rays"] for row in rows))
    figure, panels = plt.subplots(
        1, len(kinds), figsize=(10, 4), sharex=True, sharey=True, squeeze=False
    )
    for kind, panel in zip(kinds, panels[0], strict=True):
        panel.set(title=f"{kind} rays", xlabel="error of 99 % of hits, in radii", xscale="log")
        panel.grid(color="#e3e6ea")
        panel.set_axisbelow(True)
        for row in rows:
            if row["rays"] != kind:
                continue
            x, y = row["error_p99_radii"], row["rays_per_s"] / 1e6
            wrong = row["wrong"]
            panel.plot(x, y, "o", color=WRONG if wrong else RIGHT)
            text = f"{row['program']}, {wrong} of {row['of']} wrong" if wrong else row["program"]
            is_right_half, is_above = x > 1e-9, row["program"] not in BELOW
            panel.annotate(
                text,
                (x, y),
                (-7 if is_right_half else 7, 4 if is_above else -4),
                textcoords="offset points",
                ha="right" if is_right_half else "left",
                va="bottom" if is_above else "top",
                fontsize=8,
            )
    panels[0][0].set(
        ylabel="million rays per second", yscale="log", xlim=(3e-15, 1), ylim=(0.05, 20)
    )
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
