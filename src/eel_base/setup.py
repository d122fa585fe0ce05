# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name="eel_base",
    version="0.1.0",
    packages=find_packages(),
    py_modules=["eel_command"],
    package_data={"eel_base": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_base"]),
        ("share/eel_base", ["package.xml"]),
    ],
    install_requires=["setuptools", "numpy", "PyYAML"],
    extras_require={"test": ["pytest"], "pictures": ["matplotlib"], "hdf5": ["h5py"]},
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="What every package of the eel simulator uses: numbers with bounds, words of messages, output files.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": ["eel = eel_command:main_of.eel_base.command.suite"],
        "eel.commands.shell": ["completion = eel_base.command.completion"],
    },
)
