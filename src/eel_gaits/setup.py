# SPDX-License-Identifier: Apache-2.0
from xml.etree import ElementTree

from setuptools import find_packages, setup

setup(
    name="eel_gaits",
    version=ElementTree.parse("package.xml").findtext("version"),
    python_requires=">=3.11",
    packages=find_packages(),
    package_data={"eel_gaits": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_gaits"]),
        ("share/eel_gaits", ["package.xml"]),
    ],
    install_requires=["setuptools", "numpy", "scipy"],
    extras_require={"test": ["pytest"]},
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="Gaits of elongated swimmers: closed-form curvature laws, and the node that publishes them.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "gait_generator = eel_command:main_of.eel_gaits.ros.node",
            "heading_controller = eel_command:main_of.eel_gaits.ros.heading_controller",
            "pilot = eel_command:main_of.eel_gaits.ros.pilot",
        ]
    },
)
