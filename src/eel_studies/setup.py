# SPDX-License-Identifier: Apache-2.0
from xml.etree import ElementTree

from setuptools import find_packages, setup

COMMANDS = {  # commands of `eel` in the order of its list, with their folders
    "sweep": "sweeps",
    "optimise": "optimisation",
    "identify": "identification",
    "roll-hold": "roll_hold",
    "motors": "motors",
    "terms": "scene_terms",
    "tradeoff": "tradeoff",
    "stability": "stability",
}
OF_EEL_ALONE = ("roll-hold",)  # no executables of their own

setup(
    name="eel_studies",
    version=ElementTree.parse("package.xml").findtext("version"),
    python_requires=">=3.11",
    packages=find_packages(),
    package_data={"eel_studies": ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/eel_studies"]),
        ("share/eel_studies", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    extras_require={
        "test": ["pytest"],
        "cluster": ["dask", "distributed", "xarray"],
        "cma": ["cma"],
        "pictures": ["matplotlib"],
    },
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="Studies of elongated swimmers: sweeps, optimisation, identification, gradients, steering, accuracy.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            f"{name} = eel_command:main_of.eel_studies.{folder}.command"
            for name, folder in COMMANDS.items()
            if name not in OF_EEL_ALONE
        ],
        "eel.commands.swim": ["compare = eel_studies.comparison.command"],
        "eel.commands.study": [f"{name} = eel_studies.{folder}.command" for name, folder in COMMANDS.items()],
    },
)
