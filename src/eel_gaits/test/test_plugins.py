# SPDX-License-Identifier: Apache-2.0
"""Gaits of other packages, named in the entry-point group eel_gaits.gaits."""

import sys

import pytest
from eel_gaits.gaits.registry import load_gaits
from eel_gaits.gaits.settings import Settings

from eel_gaits import GAITS, gait

SOURCE = """
from dataclasses import dataclass
from eel_gaits import Quantities, Term, quantity, register

@dataclass(frozen=True, kw_only=True)
class Wiggle(Quantities):
    bend: float = quantity(2.0, unit="rad/m", description="amplitude of a wiggle", minimum=0.0, maximum=20.0)

@register(Wiggle)
def wiggle(numbers):
    "A wave of one amplitude."
    return (Term(amplitude=(numbers.bend,), wavelength=1.0, period=1.0),)
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """package(entry) installs a module wiggly with this entry; its gaits are gone when the test ends."""

    def install(entry):
        (tmp_path / "wiggly.py").write_text(SOURCE)
        folder = tmp_path / "wiggly-1.0.dist-info"
        folder.mkdir()
        (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: wiggly\nVersion: 1.0\n")
        (folder / "entry_points.txt").write_text(f"[eel_gaits.gaits]\n{entry}\n")
        monkeypatch.syspath_prepend(tmp_path)

    yield install
    GAITS.pop("wiggle", None)
    sys.modules.pop("wiggly", None)


def test_a_gait_of_another_package_is_one_of_the_gaits(package):
    package("wiggle = wiggly:wiggle")
    load_gaits()
    assert gait("wiggle", bend=3.0).terms[0].amplitude == (3.0,) and gait("wiggle").name == "wiggle"
    with pytest.raises(ValueError, match="bend must be <= 20 rad/m, got 21"):
        gait("wiggle", bend=21.0)
    settings = Settings(gait="wiggle", chosen={"bend": 4.0})
    assert settings.law().terms[0].amplitude == (4.0,) and "bend" in Settings.known_names()


@pytest.mark.parametrize("entry", ["wiggle = wiggly:wobble", "wobble = wiggly:wiggle", "wiggle = nowhere:wiggle"])
def test_a_gait_that_cannot_be_loaded_is_left_out_with_a_warning(package, entry):
    package(entry)
    with pytest.warns(UserWarning, match=r"gait '\w+' is left out: "):
        load_gaits()
    assert gait("falling")
