# SPDX-License-Identifier: Apache-2.0
"""The middleware's profile: taken where the user has none, and one that Fast DDS reads."""

import os
import xml.etree.ElementTree as ElementTree

import pytest
from eel_ros.fastdds_profile import PROFILE, VARIABLE, use_prompt_repair


@pytest.fixture(autouse=True)
def no_profile(monkeypatch):
    for name in (VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE"):
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)


def test_profile_is_set(monkeypatch):
    use_prompt_repair()
    assert os.environ[VARIABLE] == str(PROFILE)


@pytest.mark.parametrize("name", [VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE"])
def test_the_users_profile_stays(monkeypatch, name):
    monkeypatch.setenv(name, "mine.xml")
    use_prompt_repair()
    assert os.environ.get(VARIABLE) in (None, "mine.xml")
    assert os.environ[name] == "mine.xml"


def test_heartbeats_are_quicker_than_the_farewell_is_long():
    space = {"dds": "http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"}
    writer = ElementTree.parse(PROFILE).getroot().find("dds:data_writer", space)
    assert writer.get("is_default_profile") == "true"
    period = writer.find("dds:times/dds:heartbeatPeriod", space)
    seconds = int(period.find("dds:sec", space).text) + 1e-9 * int(period.find("dds:nanosec", space).text)
    assert 0.0 < seconds <= 0.1
