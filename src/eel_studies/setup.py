# SPDX-License-Identifier: Apache-2.0
from setuptools import find_packages, setup

setup(
    name="eel_studies",
    version="0.1.0",
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
    zip_safe=False,
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="Studies of elongated swimmers: sweeps, optimisation, identification, gradients, steering, accuracy.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "midlines = eel_command:main_of.eel_studies.midlines.command",
            "life = eel_command:main_of.eel_studies.life.command",
            "figures = eel_command:main_of.eel_studies.figures.command",
            "identify = eel_command:main_of.eel_studies.identification.command",
            "optimise = eel_command:main_of.eel_studies.optimisation.command",
            "sweep = eel_command:main_of.eel_studies.sweeps.command",
            "stability = eel_command:main_of.eel_studies.stability.command",
            "steering = eel_command:main_of.eel_studies.steering.command",
            "terms = eel_command:main_of.eel_studies.scene_terms.command",
            "tradeoff = eel_command:main_of.eel_studies.tradeoff.command",
        ],
        "eel.commands.swim": ["compare = eel_studies.comparison.command"],
        "eel.commands.study": [
            "sweep = eel_studies.sweeps.command",
            "optimise = eel_studies.optimisation.command",
            "identify = eel_studies.identification.command",
            "steering = eel_studies.steering.command",
            "terms = eel_studies.scene_terms.command",
            "tradeoff = eel_studies.tradeoff.command",
            "stability = eel_studies.stability.command",
            "midlines = eel_studies.midlines.command",
            "life = eel_studies.life.command",
            "replay-joints = eel_studies.replay.command",
            "laws = eel_studies.laws.command",
            "figures = eel_studies.figures.command",
        ],
    },
)
