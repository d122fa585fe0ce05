# SPDX-License-Identifier: Apache-2.0
"""Names in messages are shown and nothing else: no path, no format, no markup; files are where the user said."""

import os
import re

import pytest
from eel_common.wording import shown
from eel_gaits.ros.messages import law_to_message
from eel_viz.recording.reading import read
from swim_client import LIMIT, SwimClient

from eel_gaits import Law, Ramp, Term
from eel_msgs.msg import CurvatureLaw
from eel_viz import entities

NAMES = (
    "../../outside",
    "/tmp/outside.rrd",
    "%s%s%n%d",
    "{0} {name} {self.__class__}",
    "**bold** <script> [link](http://x) `code` # title",
    "two\nlines\r\x1b[31m",
    "",
    "n" * 200,
)
TOO_LONG = "x" * 1_000_000


def files_in(folder) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


@pytest.mark.fault(
    "names",
    "a law's name that looks like a path, a format, markup or control characters",
    "shown as it is, nothing else",
)
@pytest.mark.fault("names", "a law's name of 1 MB", "refused: at most 200 characters; no log line grows with it")
@pytest.mark.fault("names", "any run", "no file is written but those that the user named")
def test_names_are_only_names(start, fresh_domain, tmp_path, monkeypatch):
    here = tmp_path / "a" / "b" / "c"
    here.mkdir(parents=True)
    monkeypatch.chdir(here)
    monkeypatch.setenv("HOME", str(tmp_path / "a"))
    before = files_in(tmp_path)
    visualiser = start("visualiser", "--ros-args", "-p", "sink:=[save]", "-p", "recording:=run.rrd")
    visualiser.wait_for_output("saving to", LIMIT)
    dynamics = start("dynamics", "--ros-args", "-p", "wait_for_subscribers:=2")
    swim = SwimClient(domain=fresh_domain, topics=("curvature",))
    for name in NAMES:
        swim.laws.publish(law_to_message(Law(Term(amplitude=(0.1,), envelope=(Ramp(0.0, 1.0, 1.0),)), name=name)))
        swim.until(lambda name=name: f"law {shown(name)} adopted" in dynamics.output(), f"law {name!r}")
    swim.until(lambda: swim.received["/diagnostics"] and swim.diagnosis()[2]["law"] == NAMES[-1], "the last name")
    swim.laws.publish(CurvatureLaw(name=TOO_LONG))
    swim.until(lambda: "name must have at most 200 characters, got 1000000" in dynamics.output(), "the refusal")
    statuses = swim.received["/diagnostics"]  # it lasts two seconds, in which a busy machine may take several
    swim.until(lambda: any(swim.diagnosis(each)[0] == 2 for each in statuses), "the refusal in the diagnostics")
    swim.until_time(1.5, "curvature")
    swim.close()
    for node in (visualiser, dynamics):
        assert node.interrupt() == 0 and "Traceback" not in node.output(), node.output()
        assert max(map(len, node.output().splitlines())) < 1000

    assert files_in(tmp_path) - before - {"visualiser-0.txt", "dynamics-1.txt"} == {os.path.join("a/b/c", "run.rrd")}
    logged = [row[0] for row in read("run.rrd", entities.LOG)["text"]]
    for name in NAMES:
        assert f"law {name!r} published"[:80] in {text[:80] for text in logged}, name
    assert max(map(len, logged)) < 1000
    told = [row[0] for row in read("run.rrd", entities.RUN)["text"]]
    assert told and max(map(len, told)) < 2000
    bare = [re.sub(r"\\.", "", text) for text in told]  # without what is escaped
    assert not any("**bold**" in text or "<script>" in text or "](http" in text for text in bare)
