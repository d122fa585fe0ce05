# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name="eel_gym",
    version="0.1.0",
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
