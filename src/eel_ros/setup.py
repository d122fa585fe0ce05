# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name="eel_ros",
    version="0.1.0",
    packages=find_packages(),
    package_data={"eel_ros": ["fastdds.xml", "py.typed", "testing/loopback_udp.xml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_ros"]),
        ("share/eel_ros", ["package.xml"]),
    ],
    install_requires=["setuptools", "numpy"],
    extras_require={"test": ["pytest"]},
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="What every node of the eel simulator shares: parameters, command line, callbacks, end.",
    license="Apache-2.0",
)
