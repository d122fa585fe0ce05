# SPDX-License-Identifier: Apache-2.0
from xml.etree import ElementTree

from setuptools import find_packages, setup

setup(
    name="eel_viz",
    version=ElementTree.parse("package.xml").findtext("version"),
    python_requires=">=3.11",
    packages=find_packages(),
    package_data={"eel_viz": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_viz"]),
        ("share/eel_viz", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="Shows and records a swimmer: every topic into Rerun or a rosbag2 file.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "visualiser = eel_command:main_of.eel_viz.ros.node",
            "markers = eel_command:main_of.eel_viz.ros.markers",
            "record = eel_command:main_of.eel_viz.ros.record",
            "eel_echo = eel_command:main_of.eel_viz.ros.echo",
            "replay = eel_command:main_of.eel_viz.bags.replay",
            "render = eel_command:main_of.eel_viz.pictures.render",
        ],
        "eel.commands.look": [
            "record = eel_viz.ros.record",
            "echo = eel_viz.ros.echo",
            "replay = eel_viz.bags.replay",
            "render = eel_viz.pictures.render",
        ],
        "eel_dynamics.drawing": ["rerun = eel_viz.recording.library:to_rerun"],
        "eel_dynamics.bags": [
            "messages = eel_viz.bags.swimmer_messages:swimmer_messages",
            "joints = eel_viz.bags.swimmer_messages:joint_states",
        ],
    },
)
