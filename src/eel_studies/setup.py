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
    },
    zip_safe=False,
    maintainer="Eel simulator maintainers",
    maintainer_email="maintainers@eel-simulator.example.org",
    description="Studies of elongated swimmers: sweeps, optimisation, identification, gradients, steering, accuracy.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "midlines = eel_studies.midlines.command:main",
            "figures = eel_studies.figures.command:main",
            "identify = eel_studies.identification.command:main",
            "optimise = eel_studies.optimisation.command:main",
            "sweep = eel_studies.sweeps.command:main",
            "stability = eel_studies.stability.command:main",
            "steering = eel_studies.steering.command:main",
            "tradeoff = eel_studies.tradeoff.command:main",
        ]
    },
)
