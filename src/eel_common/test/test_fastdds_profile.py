# SPDX-License-Identifier: Apache-2.0
"""The middleware's profile: taken where the user has none, and one that Fast DDS reads."""

import os
import sys
import xml.etree.ElementTree as ElementTree

import pytest
from eel_common.ros.fastdds_profile import PROFILE, VARIABLE, use_profile


@pytest.fixture(autouse=True)
def no_profile(monkeypatch):
    for name in (VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE"):
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)


def test_profile_is_set(monkeypatch):
    use_profile()
    assert os.environ[VARIABLE] == str(PROFILE)


@pytest.mark.parametrize("name", [VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE"])
def test_the_users_profile_stays(monkeypatch, name):
    monkeypatch.setenv(name, "mine.xml")
    use_profile()
    assert os.environ.get(VARIABLE) in (None, "mine.xml")
    assert os.environ[name] == "mine.xml"


SPACE = {"dds": "http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"}


def period(element) -> float:
    return int(element.find("dds:sec", SPACE).text) + 1e-9 * int(element.find("dds:nanosec", SPACE).text)


def test_heartbeats_are_quicker_than_the_farewell_is_long():
    writer = ElementTree.parse(PROFILE).getroot().find("dds:data_writer", SPACE)
    assert writer.get("is_default_profile") == "true"
    assert 0.0 < period(writer.find("dds:times/dds:heartbeatPeriod", SPACE)) <= 0.1


def test_announcements_last_longer_than_the_slowest_node_takes_to_start():
    participant = ElementTree.parse(PROFILE).getroot().find("dds:participant", SPACE)
    assert participant.get("is_default_profile") == "true"
    announcements = participant.find("dds:rtps/dds:builtin/dds:discovery_config/dds:initialAnnouncements", SPACE)
    every = period(announcements.find("dds:period", SPACE))
    assert every <= 0.1 and every * int(announcements.find("dds:count", SPACE).text) >= 5.0


def test_fast_dds_takes_the_profile(start, tmp_path):
    """It names what it cannot read."""
    node = "import rclpy; rclpy.init(); rclpy.create_node('node'); print('made')"
    bad = tmp_path / "bad.xml"
    bad.write_text(PROFILE.read_text().replace("initialAnnouncements", "announcementsAtFirst"))
    said = []
    for profile in (PROFILE, bad):
        process = start("env", f"{VARIABLE}={profile}", sys.executable, "-c", node)
        assert process.wait(90.0) == 0 and "made" in process.output(), process.output()
        said.append("XMLPARSER" in process.output())
    assert said == [False, True]
