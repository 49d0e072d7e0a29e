"""Builds the Python module and the program with CMake (pyproject.toml)."""

import pathlib
import re

from skbuild import setup

root = pathlib.Path(__file__).parent
version = re.search(r"project\(vantage VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]

setup(
    name="vantage",
    version=version,
    description="Next-best-view planning for 3D scanning",
    long_description=(root / "README.md").read_text(encoding="utf-8"),
    long_description_content_type="text/markdown",
    license="BSD-3-Clause",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["vantage"],
    package_dir={"": "python"},
    package_data={"vantage": ["*.pyi", "py.typed", "bin/*"]},
    entry_points={"console_scripts": ["vantage=vantage.program:main"]},
    cmake_install_dir="python",
    cmake_args=["-DVANTAGE_TESTS=OFF", "-DVANTAGE_UNITY=ON", "-DVANTAGE_WHEEL=ON"],
)
