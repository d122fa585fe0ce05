# SPDX-License-Identifier: Apache-2.0
"""`make evidence`: run the scripts that write pages, tables and pictures of docs; ARGS="NAME ..." chooses some.

Each runs alone too: `python evidence/NAME.py --help`. All together take hours.
"""

import shlex
import subprocess
import sys
from pathlib import Path

from eel_common.wording import not_one_of

FOLDER = Path(__file__).resolve().parent
LAWS = "gazzola", "eloy", "lighthill", "tytell"
PAGES = "--page docs/explanation/{}.md --out docs/images"
SCRIPTS: dict[str, tuple[str, ...]] = {  # name: arguments of each run
    "report_tables": ("",),
    "figures": ("",),
    "laws": (
        *(f"{name} --out docs/images/law_{name}.png" for name in LAWS),
        "gazzola --friction taylor --out docs/images/law_gazzola_taylor.png",
    ),
    "life": (
        "lamprey docs/data/lamprey_midlines.csv --widths docs/data/widths.csv --out docs/images/life_lamprey.png",
    ),
    "robot_swims": ("--out docs/data/robots.csv",),
    "robot_log": (
        "docs/data/amphibot_joints.csv --clock 1.078 --links 0.094x7 --section 0.0275,0.0165 --joint-drag flush "
        "--seen docs/data/amphibot_leds.csv --out docs/images/life_amphibot.png",
    ),
    "steering": (PAGES.format("steering"),),
    "drafting": (PAGES.format("drafting"),),
    "delivered": (PAGES.format("accuracy"),),
    "manoeuvres": ("",),
    "pilot": ("",),
    "tutorial_pictures": ("",),
    "pictures": ("",),
    "fault_table": ("",),
    "midlines": (),  # of a file of yours
    "comparisons": ("",),
}


def main(names: list[str]) -> int:
    """Run the named scripts, or all. Status 2 for an unknown name, else that of the first that fails."""
    for name in names:
        if name not in SCRIPTS:
            print(f"everything.py: {not_one_of('name', name, SCRIPTS)}", file=sys.stderr)
            return 2
    for name in names or SCRIPTS:
        for words in SCRIPTS[name]:
            print(f"[evidence] {name} {words}", flush=True)
            done = subprocess.run([sys.executable, FOLDER / f"{name}.py", *shlex.split(words)])
            if done.returncode:
                return done.returncode
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
