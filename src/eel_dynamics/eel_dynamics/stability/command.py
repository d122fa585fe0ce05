"""`stability`: two numbers of a swim at a time, over more than any swimmer has: accurate, inaccurate, or stopped.

stability                       # maps into docs/images, table into docs/robustness.md
stability --out out/stability --points 25
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from .explicit import STEPS, treat
from .maps import ACCURATE, INACCURATE, STOPPED, TARGET, maps_of, measure

PAGE = Path("docs/robustness.md")
BEGIN, END = "<!-- maps: written by `stability` -->", "<!-- end of maps -->"
RATIOS = (1e-3, 1e-2, 1e-1, 0.5, 1.0, 10.0, 1e3)


def main(arguments: list[str] | None = None) -> int:
    """Exit status 0; 2 with one line where a folder cannot be written, matplotlib is missing or input is bad."""
    options = _parser().parse_args(arguments)
    try:
        import matplotlib
        from matplotlib.figure import Figure

        from ..figures.style import SETTINGS
        from .drawing import draw
    except ImportError:
        print("stability: matplotlib is missing; install it with: python -m pip install matplotlib", file=sys.stderr)
        return 2
    try:
        if options.points < 2:
            raise ValueError(f"points must be >= 2, got {options.points}")
        folder = Path(options.out)
        folder.mkdir(parents=True, exist_ok=True)
        maps = []
        for item in maps_of(options.points):
            maps.append(measure(item))
            with matplotlib.rc_context(SETTINGS):
                figure = Figure(figsize=(5.6, 4.2), layout="constrained")
                draw(figure, maps[-1])
                for suffix in ("png", "svg"):
                    metadata = {"Date": None} if suffix == "svg" else {"Software": None}
                    figure.savefig(folder / f"stability_{item.name}.{suffix}", metadata=metadata)
        text = report(maps)
        print(text)
        if options.page:
            page = Path(options.page)
            page.write_text(with_maps(page.read_text(encoding="utf-8"), text, maps), encoding="utf-8")
    except (ValueError, OSError) as error:
        print(f"stability: {error}", file=sys.stderr)
        return 2
    return 0


def report(maps) -> str:
    """Counts and worst errors of the maps, then the explicit treatment of the added mass, as Markdown tables."""
    lines = ["| map | accurate | inaccurate | stopped | worst error | most steps |", "|---|---|---|---|---|---|"]
    for each in maps:
        counts = " | ".join(str(np.sum(each.outcome == kind)) for kind in (ACCURATE, INACCURATE, STOPPED))
        lines.append(f"| {each.map.title} | {counts} | {each.worst:.1e} | {each.steps.max()} |")
    lines += ["", f"Accurate: the head within {TARGET:g} of its path (or of the body, if longer) of a finer run's."]
    reasons = sorted({_reason(text) for each in maps for text in each.reason.ravel() if text})
    lines += [f"Reasons of the stops: {'; '.join(reasons) or 'none'}.", ""]
    lines += [
        "The added mass is implicit in the 6 x 6 matrix. Treated explicitly, with the acceleration of the step before, "
        "it is unstable",
        f"wherever the growth per step exceeds 1, whatever the step; after {STEPS} steps:",
        "",
        "| density of the body, by water's | growth per step | explicit acceleration, by the right one | condition of "
        "the 6 x 6 matrix |",
        "|---|---|---|---|",
    ]
    for ratio in RATIOS:
        treated = treat(ratio)
        lines.append(f"| {ratio:g} | {treated.growth:.3g} | {treated.explicit:.3g} | {treated.condition:.3g} |")
    return "\n".join(lines)


def with_maps(page: str, text: str, maps) -> str:
    """The page's text with the tables and pictures between its marker lines."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"{PAGE} must have the lines {BEGIN!r} and {END!r}")
    pictures = "\n".join(f"![{each.map.title}](images/stability_{each.map.name}.svg)" for each in maps)
    return f"{before}{BEGIN}\n{text}\n\n{pictures}\n{END}{after}"


def _reason(text: str) -> str:
    """What failed, without time and value."""
    return text.partition("s: ")[2].partition(" (")[0]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="stability",
        description="Sweep two numbers of a swim at a time and draw where it is accurate, inaccurate, or stops.",
    )
    parser.add_argument("--out", default="docs/images", metavar="FOLDER", help="where to (docs/images)")
    parser.add_argument("--points", type=int, default=13, help="swims along each side of a map (13)")
    parser.add_argument("--page", metavar="FILE", help="page whose part between the marker lines is written anew")
    return parser
