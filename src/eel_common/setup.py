# SPDX-License-Identifier: Apache-2.0
from xml.etree import ElementTree

from setuptools import find_packages, setup

setup(
    name="eel_common",
    version=ElementTree.parse("package.xml").findtext("version"),
    python_requires=">=3.11",
    packages=find_packages(),
    py_modules=["eel_command"],
    package_data={"eel_common": ["py.typed", "ros/fastdds.xml", "ros/testing/loopback_udp.xml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_common"]),
        ("share/eel_common", ["package.xml"]),
    ],
    install_requires=["setuptools", "numpy", "PyYAML"],
    extras_require={"test": ["pytest"], "pictures": ["matplotlib"], "hdf5": ["h5py"]},
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="What every package of the eel simulator uses: numbers with bounds, files, commands, what nodes share.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["eel = eel_command:main_of.eel_common.command.suite"],
        "eel.commands.shell": ["completion = eel_common.command.completion"],
    },
)
