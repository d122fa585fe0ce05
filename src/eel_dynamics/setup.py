# SPDX-License-Identifier: Apache-2.0
from xml.etree import ElementTree

from setuptools import find_packages, setup

setup(
    name="eel_dynamics",
    version=ElementTree.parse("package.xml").findtext("version"),
    python_requires=">=3.11",
    packages=find_packages(),
    package_data={"eel_dynamics": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_dynamics"]),
        ("share/eel_dynamics", ["package.xml"]),
    ],
    install_requires=["setuptools", "numpy", "scipy", "PyYAML"],
    extras_require={
        "test": ["pytest"],
        "data": ["xarray"],
    },
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="Dynamics of elongated swimmers in water (Boyer, Porez and Leroyer, 2010), as a library and as a node.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "dynamics = eel_command:main_of.eel_dynamics.ros.node",
            "simulate = eel_command:main_of.eel_dynamics.commands.simulate",
        ],
        "eel.commands.swim": [
            "simulate = eel_dynamics.commands.simulate",
            "ballast = eel_dynamics.commands.ballast",
            "urdf = eel_dynamics.commands.urdf",
        ],
        "eel.version": ["core = eel_core:build_info"],
    },
)
