# SPDX-License-Identifier: BSD-3-Clause
"""Checks tools/make_bathymetry.py.  Without gdalwarp the import is left out: exit code 77."""
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOOL = os.path.join(ROOT, "tools", "make_bathymetry.py")


def run(*words):
    return subprocess.run([sys.executable, TOOL, *words], capture_output=True, text=True)


def grid_of(path):
    lines = open(path).read().splitlines()
    header = {line.split()[0]: float(line.split()[1]) for line in lines[:6]}
    return header, [[float(word) for word in line.split()] for line in lines[6:]]


def check_that_the_shipped_file_is_what_the_tool_makes(folder):
    made = os.path.join(folder, "made.asc")
    assert run("synthetic", made).returncode == 0
    with open(made) as a, open(os.path.join(ROOT, "worlds", "terrain", "bathymetry.asc")) as b:
        assert a.read() == b.read(), "worlds/terrain/bathymetry.asc is stale"


def check_that_a_plane_of_depths_comes_out_as_heights_in_meters(folder):
    # Depth 10 m at 43 N 10 E, and 1 m more for each 100 m to the north: a degree of latitude has 111092 m there
    # (WGS 84), a degree of longitude 81541 m.
    points, out = os.path.join(folder, "plane.xyz"), os.path.join(folder, "plane.asc")
    with open(points, "w") as file:
        for j in range(20, -21, -1):
            for i in range(-20, 21):
                file.write(f"{10 + i * 4e-4:.7f} {43 + j * 4e-4:.7f} {10 + 0.01 * j * 4e-4 * 111092:.5f}\n")
    made = run("import", points, out, "--origin", "43,10", "--size", "400,200", "--cell", "10",
               "--depth-positive-down", "--srs", "EPSG:4326")
    assert made.returncode == 0, made.stderr
    header, rows = grid_of(out)
    assert (header["ncols"], header["nrows"], header["xllcenter"], header["yllcenter"]) == (41, 21, -200, -100)
    for row in range(21):
        north_m = 100 - 10 * row
        for height in rows[row]:
            # Two decimals in the file, and the length of a degree changes by 2e-5 over the grid.
            assert abs(height + 10 + 0.01 * north_m) < 0.006, (row, height)
    west = run("import", points, out, "--origin", "-43,10", "--size", "400,200", "--cell", "10", "--srs", "EPSG:4326")
    assert west.returncode == 1 and "no heights around --origin" in west.stderr, west.stderr
    odd = run("import", points, out, "--origin", "43,10", "--size", "405,200", "--cell", "10")
    assert odd.returncode == 1 and "whole numbers of cells" in odd.stderr, odd.stderr


def main():
    with tempfile.TemporaryDirectory() as folder:
        check_that_the_shipped_file_is_what_the_tool_makes(folder)
        if shutil.which("gdalwarp") is None:
            missing = run("import", "x.tif", "x.asc", "--origin", "0,0", "--size", "10,10", "--cell", "1")
            assert missing.returncode == 1 and "apt-get install gdal-bin" in missing.stderr, missing.stderr
            print("gdalwarp is not installed: the import is not checked")
            sys.exit(77)
        check_that_a_plane_of_depths_comes_out_as_heights_in_meters(folder)


if __name__ == "__main__":
    main()
