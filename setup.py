# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Builds the Python package with CMake: the target _adasplats of python/CMakeLists.txt.

CMAKE_ARGS adds options (such as -DADASPLATS_USE_CUDA=OFF), CMAKE_BUILD_PARALLEL_LEVEL bounds the
jobs; ccache is used where it is installed. Needs what scripts/setup.sh installs.
"""
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext


class CMakeBuild(build_ext):
    """Lets CMake write the module where setuptools wants it."""

    def build_extension(self, ext):
        if self.editable_mode:
            raise SystemExit("editable installs are not supported: build with CMake and set "
                             "PYTHONPATH=build/release/python")
        source = Path(__file__).resolve().parent
        package = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        build = Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        options = [
            "-DCMAKE_BUILD_TYPE=Release",
            f"-DPython_EXECUTABLE={sys.executable}",
            f"-DADASPLATS_PYTHON_DIR={package}",
            "-DADASPLATS_BUILD_PYTHON=ON",
            "-DADASPLATS_BUILD_APP=OFF",
            "-DADASPLATS_BUILD_TESTS=OFF",
            "-DADASPLATS_BUILD_BENCH=OFF",
            "-DADASPLATS_VIEWER=OFF",
            "-DADASPLATS_WERROR=OFF",
            *shlex.split(os.environ.get("CMAKE_ARGS", "")),
        ]
        try:  # where pip fetched pybind11 instead of the distribution's
            import pybind11
            options.append(f"-Dpybind11_DIR={pybind11.get_cmake_dir()}")
        except ImportError:
            pass
        if shutil.which("ninja"):
            options.append("-GNinja")
        jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count() or 1))
        subprocess.run(["cmake", "-S", str(source), "-B", str(build), *options], check=True)
        subprocess.run(["cmake", "--build", str(build), "--target", "_adasplats", "--parallel",
                        jobs], check=True)


setup(
    packages=["adasplats"],
    package_dir={"": "python"},
    package_data={"adasplats": ["*.pyi", "py.typed"]},
    ext_modules=[Extension("adasplats._adasplats", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    zip_safe=False,
)
