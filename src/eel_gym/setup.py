# SPDX-License-Identifier: Apache-2.0
from xml.etree import ElementTree

from setuptools import find_packages, setup

setup(
    name="eel_gym",
    version=ElementTree.parse("package.xml").findtext("version"),
    python_requires=">=3.11",
    packages=find_packages(),
    package_data={"eel_gym": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_gym"]),
        ("share/eel_gym", ["package.xml"]),
    ],
    install_requires=["setuptools", "gymnasium"],
    extras_require={"test": ["pytest"]},
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="Environments of Gymnasium: an elongated swimmer that learns.",
    license="Apache-2.0",
)
