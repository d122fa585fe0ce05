# SPDX-License-Identifier: Apache-2.0
"""Writes data/falling.json: the head after the falling gait, by the reference. From the root of the repository:

    source setup.bash && python src/eel_dynamics/test/make_reference_data.py

Some minutes; names of cases as arguments make these alone. `converged_to` is the greatest change of any component
of the state at any of the times from the coarser of two runs: the kinks of V|V| and the jump of the printed c_f(Re)
bound it.
"""

import json
import sys
from pathlib import Path

import numpy as np
from cases import FALLING_BREAKS, falling_law
from reference import Reference, boyer_body, scene

TIMES = (0.0, 1.0, 2.0, 5.0, 10.0)
OUT = Path(__file__).parent / "data" / "falling.json"


CASES = {  # settings of the scene, then (tolerance in time, panels per span, nodes per panel) of two runs
    "no drag": ({"resistive": False}, (1e-11, 2, 16), (1e-12, 3, 16)),
    "laminar": ({"friction": "laminar"}, (1e-9, 12, 10), (1e-10, 20, 10)),
    "printed": ({"friction": "printed"}, (1e-7, 12, 10), (1e-8, 20, 10)),
}


def run(settings, rtol, panels, nodes):
    reference = Reference(boyer_body(), scene(**settings), panels_per_span=panels, nodes_per_panel=nodes)
    return np.hstack(reference.march(falling_law(), TIMES, rtol=rtol, breaks=FALLING_BREAKS))


def main(names):
    out = json.loads(OUT.read_text()) if OUT.exists() else {}
    out.update(times=TIMES, columns="position (3) m, quaternion x y z w, head twist (Omega, V) rad/s, m/s")
    for name in names or CASES:
        settings, coarse, fine = CASES[name]
        states = run(settings, *fine)
        error = float(np.max(np.abs(states - run(settings, *coarse))))
        out[name] = {"scene": settings, "state": states.tolist(), "converged_to": error}
        position = np.array2string(states[-1, :3], precision=8)
        print(f"{name}: position at 10 s {position} m, coarse run differs by {error:.1e}")
        OUT.write_text(json.dumps(out, indent=1) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
