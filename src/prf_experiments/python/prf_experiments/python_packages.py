# SPDX-License-Identifier: BSD-3-Clause
"""Python packages that Debian lacks, from the environment .venv that ./run_experiment and ./run_tests set up."""
import glob
import os
import sys

ROOT = os.path.join(os.path.dirname(os.path.realpath(__file__)), *[os.pardir] * 4)


def reach() -> None:
    """Lets imports find them."""
    found = glob.glob(os.path.join(ROOT, ".venv", "lib", "python3*", "site-packages"))
    sys.path[:0] = [folder for folder in found if folder not in sys.path]


def how_to_get(*names: str) -> str:
    """What to do when one of them cannot be imported."""
    return (f"needs the Python {'packages' if len(names) > 1 else 'package'} {' and '.join(names)}, which Debian "
            f"lacks: ./run_tests installs them into .venv, elsewhere `pip install {' '.join(names)}` does")
