# SPDX-License-Identifier: Apache-2.0
"""Sequences: laws that follow one another, in Python or from a YAML file.

    sequence([(straight(), 8.0), (turning(), 4.0), (still(), None)], blend=0.5)

    name: patrol              # of the law; the file's name where it is left out
    blend: 0.5                # s, from one step to the next (0.5)
    steps:
      - gait: straight        # any gait, with `set` as in `eel simulate --set`
        set: {period: 0.8}
        duration: 8.0         # s; the last step may leave it out, and then lasts
      - gait: turning
        set: {left_bend: 0.5}
        duration: 4.0
        blend: 1.0            # into this step
        scale: 0.8            # times the curvature (1)
        mirror: yaw           # or pitch
        delay: 0.5            # s, by which the gait's own time begins later (0)
      - together:             # the sum of several
          - gait: straight
          - gait: rolling
            scale: 0.2
        duration: 3.0
      - repeat: 2             # times (1)
        steps:                # steps of their own, each with a duration
          - {gait: straight, duration: 2.0}
          - {gait: still, duration: 1.0}

The curvature is twice differentiable in time.
"""

from collections.abc import Iterable, Sequence
from typing import Any

from eel_base.quantity import positive
from eel_base.wording import shown

from eel_gaits.laws.law import MAXIMUM_TERMS, Law
from eel_gaits.laws.term import Term

BLEND = 0.5  # s


def sequence(steps: Iterable[Sequence[Any]], *, blend: float = BLEND, name: str = "sequence") -> Law:
    """The law in which the `steps` follow one another.

    steps: rows (law, duration [s]) or (law, duration [s], blend [s] into this step). The last duration may be None: the
    step then lasts. Otherwise the body becomes straight at its end.
    blend: [s], into each step without one of its own, and at the end. `ValueError` names the step that does not fit.
    """
    rows = [(*step, blend)[:3] for step in steps]
    for index, (_, _, into) in enumerate(rows):
        positive(f"steps[{index}]: blend", into)
    fades = [float(into) for _, _, into in rows[1:]] + [positive("blend", blend)]  # out of each step
    terms: list[Term] = []
    at = 0.0
    for index, (law, duration, into) in enumerate(rows):
        try:
            if not isinstance(law, Law):
                raise ValueError(f"a step must begin with a Law, got {shown(law)}")
            law = law.delayed(at)
            if index:
                law = law.ramped_in(at, at + float(into))
            if duration is not None:
                at += positive("duration", duration)
                law = law.ramped_out(at, at + fades[index])
            elif index + 1 < len(rows):
                raise ValueError("duration must be given for all steps but the last, got None")
            terms += law.terms
            if len(terms) > MAXIMUM_TERMS:
                raise ValueError(f"the law has more than {MAXIMUM_TERMS} terms")
        except ValueError as error:
            raise ValueError(f"steps[{index}]: {error}") from None
    return Law(*terms, name=name)
