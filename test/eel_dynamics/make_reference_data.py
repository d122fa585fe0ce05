"""Writes data/falling.json: the head after the falling gait, by the reference. From the root of the repository:

    source setup.bash && python test/eel_dynamics/make_reference_data.py

Some minutes. Laminar friction and no cross-flow drag limit the convergence to 1e-10 or so; see `converged_to`.
"""

import json
from pathlib import Path

import numpy as np
from cases import FALLING_BREAKS, falling_law
from reference import Reference, boyer_body, scene

TIMES = (0.0, 1.0, 2.0, 5.0, 10.0)
OUT = Path(__file__).parent / "data" / "falling.json"


def run(settings, rtol, **space):
    reference = Reference(boyer_body(), scene(**settings), **space)
    return np.hstack(reference.march(falling_law(), TIMES, rtol=rtol, breaks=FALLING_BREAKS))


def main():
    cases = {"no drag": dict(resistive=False), "laminar": dict(friction="laminar"), "printed": dict(friction="printed")}
    out = {"times": TIMES, "columns": "position (3), quaternion x y z w, head twist (Omega, V)"}
    for name, settings in cases.items():
        fine = name == "no drag"
        coarse = run(settings, 1e-9 if fine else 1e-7, panels_per_span=1 if fine else 2, nodes_per_panel=12)
        best = run(settings, 1e-12 if fine else 1e-9, panels_per_span=1 if fine else 4, nodes_per_panel=16)
        error = float(np.max(np.abs(best - coarse)))
        out[name] = {"scene": settings, "state": best.tolist(), "converged_to": error}
        print(f"{name}: position at 10 s {np.array2string(best[-1, :3], precision=8)} m, coarse run differs by {error:.1e}")
        OUT.write_text(json.dumps(out, indent=1) + "\n")


if __name__ == "__main__":
    main()
