# SPDX-License-Identifier: Apache-2.0
"""Pages say what the code does: each constant that a page quotes, in the words around it, as the code has it."""

import math
from pathlib import Path

import pytest
from eel_common.ros.loop.channel import LIVE_DEPTH
from eel_common.ros.loop.clock_ticks import TICK
from eel_common.ros.serving import LARGEST_MESSAGE
from eel_dynamics.accuracy import accuracy, error_estimate
from eel_dynamics.accuracy.sudden_changes import UNSEEN
from eel_dynamics.curvature.curvature_samples import MOST_POINTS as MOST_POINTS_OF_A_SAMPLE
from eel_dynamics.curvature.law_follower import DEFAULT_TRANSITION
from eel_dynamics.model.fins.fins import Fin
from eel_dynamics.ros.inputs.law_messages import LARGEST_LAW
from eel_dynamics.ros.loop import law_adopter, sample_output
from eel_dynamics.ros.parameters import DynamicsParameters
from eel_dynamics.runs import companion
from eel_dynamics.runs.observed_swim import LEAST_COMPARED
from eel_dynamics.runs.settled_duration import MOST_PERIODS
from eel_gaits.film.beat import FEWEST_BEATS
from eel_gaits.laws.law import MAXIMUM_TERMS
from eel_gaits.pilot.goals import MOST_POINTS as MOST_POINTS_OF_A_PATH
from eel_gaits.pilot.settings import PilotSettings
from eel_gaits.sources.function_law import STEP
from eel_gaits.sources.period import LONGEST_GAP
from eel_studies.gradients.gradient import KINKED_STEP
from eel_viz.limit import RECENT
from eel_viz.scene3d.track import AXES_LENGTH, LENGTH
from eel_viz.settings import Settings
from eel_viz.views.blueprint import REPEATED_FROM

import eel_core

ROOT = Path(__file__).resolve().parents[1]
WORDS = {1: "one", 2: "two", 3: "three", 4: "four", 5: "five"}
SIDES = {0.25: "a quarter"}


def power(value: float) -> str:
    """A power of ten as pages write it: 1e-4."""
    return f"{value:.0e}".replace("e-0", "e-")


QUOTED = {
    "docs/explanation/accuracy.md": (
        *(f"| {power(target)} (`{name}`) |" for name, target in accuracy.PRESETS.items() if target > 1e-8),
        ", ".join(f"`{name}` {power(target)}" for name, target in accuracy.PRESETS.items()),
        f"The tolerance of a step is a {accuracy.STEPS_ERRORS:g}th of the target",
        f"gets a {accuracy.SAFE_STEPS_ERRORS:g}th. Of a robot it is a {accuracy.ROBOT_STEPS:g}th.",
        f"The body gets {accuracy.POINTS_PER_DECADE:g} points per length for each decade",
        f"begins with {accuracy.COARSE_POINTS[0]:g} for each decade, less {-accuracy.COARSE_POINTS[1]:g}.",
        f"all {accuracy.POINTS_PER_DECADE:g} stay",
        f"at a target of {power(accuracy.CUBIC_TARGET)} or below",
        f"It has {accuracy.LOOSER:g} times the tolerance, or {accuracy.LOOSER_THAN_FINE:g} times one of at most "
        f"{accuracy.FINE:g}; {accuracy.FEWER_POINTS:g} of the points per length, or {accuracy.FEWER_OF_FEW:g} of fewer "
        f"than {accuracy.FEW_POINTS:g}; and longest steps that are {accuracy.LONGER_STEPS:g} times as long.",
        f"above the target divided by {companion.ACCEPTED:g}, the run becomes the companion of a finer one, up to "
        f"{companion.MOST_REFINEMENTS} times",
        f"companion has {accuracy.ROBOT_LOOSER:g} times the tolerance.",
        f"Torque is compared at {LEAST_COMPARED} gaps or more",
        f"at a random instant in every {1e3 * STEP:g} ms",
        f"What lasts {2e3 * STEP:g} ms or longer",
        f"takes steps of at most {1e3 * UNSEEN:g} ms by such a torque",
        f"10^{{{math.log10(error_estimate.FLOOR):g}}} \\, m \\, l^2 / T^2",
    ),
    "docs/howto/bending.md": (f"compares it at {LEAST_COMPARED} gaps or more",),
    "docs/howto/controllers.md": (
        f"publishes sample 0 {round(1.0 / sample_output.START_PERIOD)} times a second",
        f"A sample more than {law_adopter.LONGEST_WAY:g} s (or two periods",
        f"at most `subscriber_timeout` ({DynamicsParameters().subscriber_timeout:g} s)",
    ),
    "docs/appendix/robustness.md": (f"{DynamicsParameters().subscriber_timeout:g} s at most",),
    "docs/howto/fins.md": (
        f"{WORDS[eel_core.MOST_SERVOS]} servos at most have a time constant",
        rf"C_D = {Fin.friction_drag:g} + (1 - k)\,\frac{{L^2}}{{{Fin.efficiency:g}\,\pi\Lambda}} + "
        rf"{Fin.normal_drag:g}\,k\,S^2",
    ),
    "docs/howto/motions.md": (
        f"a gap exceeds {SIDES[LONGEST_GAP]} of the fastest period",
        f"in {WORDS[FEWEST_BEATS]} beats or more",
        f"the body follows a quintic of {WORDS[int(DEFAULT_TRANSITION)]} second",
    ),
    "docs/howto/pilot.md": (
        f"swims through the points, {MOST_POINTS_OF_A_PATH:,} at most",
        f"a look-ahead of {PilotSettings().look_ahead:g} body lengths",
        f"way points reached within {SIDES[PilotSettings().reach]} of the length",
    ),
    "docs/howto/sweeps.md": (f"{MOST_PERIODS} periods at most",),
    "docs/howto/visualiser.md": (
        f"which fits the last {RECENT / 1e9:g} s",
        f"The path of the head fades over {LENGTH:g} s",
        f"repeats the later {100.0 * (1.0 - REPEATED_FROM):g} % of the swim",
        f"`skin_rate` (default {Settings().skin_rate:g} Hz)",
        f"`rate` samples per second ({Settings().rate:g})",
    ),
    "docs/reference/nodes.md": (
        f"every {1e3 * TICK:g} ms while the simulation waits",
        f"the last {LIVE_DEPTH} messages",
        f"Messages of more than {LARGEST_MESSAGE >> 20} MB (laws: {LARGEST_LAW / 2**20:g} MB) are left out",
        f"A law has at most {MAXIMUM_TERMS:,} terms, a sample {MOST_POINTS_OF_A_SAMPLE:,} points, a goal "
        f"{MOST_POINTS_OF_A_PATH:,}.",
    ),
    "docs/tutorials/motors.md": (f"is a difference over {100.0 * KINKED_STEP:g} % of the number",),
    "SECURITY.md": (
        f"visualiser's data (port {Settings().port}) and web viewer ({Settings().web_port})",
        *(f" -L {port}:127.0.0.1:{port} " for port in (Settings().port, Settings().web_port)),
    ),
}


@pytest.mark.parametrize("page", QUOTED)
def test_a_page_quotes_the_constants_of_the_code(page):
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    assert [words for words in QUOTED[page] if words not in text] == []


def test_options_say_the_lengths_that_are_drawn():
    said = Settings.__dataclass_fields__
    assert f"{AXES_LENGTH:g} m long" in said["frames"].metadata["description"]
    assert f"in the last {LENGTH:g} s" in said["wake"].metadata["description"]
