# SPDX-License-Identifier: BSD-3-Clause
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

ROOMS = ["export", "faults", "judge", "record", "report", "rivals", "robot", "run", "soak", "sweep", "teach"]

setup(**generate_distutils_setup(
    package_data={"prf_experiments.report": ["templates/*"]},
    packages=["prf_experiments", *("prf_experiments." + room for room in ROOMS)],
    package_dir={"": "python"}))
