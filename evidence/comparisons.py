# SPDX-License-Identifier: Apache-2.0
"""`python evidence/comparisons.py`: the falling gait in other people's simulators, and by the paper's own scheme.

python evidence/comparisons.py paper_scheme > benchmarks/reports/DATE.txt
"""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))

import run
from others.against_paper_scheme import paper_scheme
from others.other_simulators import peers


def main(names: list[str]) -> int:
    """Print the named figures, or both, as `make bench` does; they install other people's packages."""
    return run.main(names, {"peers": peers, "paper_scheme": paper_scheme})


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
