# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name="eel_model",
    version="0.1.0",
    packages=find_packages(),
    package_data={"eel_model": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_model"]),
        ("share/eel_model", ["package.xml"]),
    ],
    install_requires=["setuptools", "numpy", "scipy"],
    extras_require={"test": ["pytest"]},
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="What a run of an elongated swimmer is told: body, fins, robot, physics, flow of the water.",
    license="Apache-2.0",
)
