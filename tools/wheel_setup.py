# SPDX-License-Identifier: BSD-3-Clause
"""setup.py of the wheel that tools/package makes: the package, its libraries, worlds and license texts as they are."""

import os

import setuptools


class BuiltElsewhere(setuptools.Distribution):
    """A package with a module that is compiled already."""

    def has_ext_modules(self):
        return True


def files_below(folder, target):
    """Returns data_files for all files below a folder."""
    return [(os.path.join(target, os.path.relpath(at, folder)), [os.path.join(at, name) for name in sorted(names)])
            for at, _, names in sorted(os.walk(folder)) if names]


setuptools.setup(
    name="shoal",
    version=os.environ["SHOAL_VERSION"],
    description="Simulator of many vehicles on land, at the surface and under water",
    license="BSD-3-Clause",
    python_requires=">=3.11",
    install_requires=["numpy"],
    extras_require={"plots": ["matplotlib", "pandas"]},
    packages=["shoal"],
    package_data={"shoal": ["*.so", "*.pyi", "py.typed", "libs/*"]},
    # The module looks for worlds and vehicles in share/shoal of the environment that it is in.
    data_files=files_below("shared", "share/shoal") + files_below("notices", "share/doc/shoal"),
    distclass=BuiltElsewhere,
    options={"bdist_wheel": {"plat_name": os.environ["SHOAL_PLATFORM"]}},
)
