#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes a bathymetry file for a part of shape terrain: an ESRI ASCII grid in the frame of a world, heights up.

usage: make_bathymetry.py import FILE OUT.asc --origin LAT,LON --size X,Y --cell M
                          [--depth-positive-down] [--offset M] [--srs SRS] [--band N]
       make_bathymetry.py synthetic OUT.asc

import     takes any raster that GDAL reads (GeoTIFF, NetCDF, gridded XYZ, S-102, ...), by gdalwarp of the Debian package
           gdal-bin.  The middle of the grid is the world's origin at LAT,LON (degrees); x is east, y north, on the plane
           that touches the Earth there (azimuthal equidistant projection); the Earth's curvature, 8 cm at 1 km, is left
           out.  NetCDF with several variables: NETCDF:"FILE":VARIABLE.  Points that lie scattered: gdal_grid first.
  --size X,Y             meters to the east and to the north, each a whole number of cells
  --cell M               distance of two heights
  --depth-positive-down  the file has depths; without it, heights (negative under water)
  --offset M             added to the heights, such as of a chart datum under the still surface
  --srs SRS              coordinate system of a file that does not say it, such as EPSG:4326
  --band N               of a file with several; default 1
synthetic  writes worlds/terrain/bathymetry.asc, the same file every time: 400 m x 300 m, a slope from 4 m to 25 m with
           sand waves, a channel and two mounds.

In the world: {shape: terrain, terrain: {source: ascii, file: terrain/OUT.asc, origin: map, map_origin_m: [0, 0],
holes: linear}}
"""
import argparse
import math
import os
import shutil
import subprocess
import sys
import tempfile

NODATA = -9999


def die(text):
    sys.exit("make_bathymetry.py: " + text)


def pair(text):
    try:
        a, b = (float(word) for word in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' must be two numbers with a comma between them")
    return a, b


def run(command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        die(f"{command[0]}: {result.stderr.strip() or 'failed'}")


def write_grid(path, rows, cell_m, left_m, bottom_m):
    """`rows` from north to south; left and bottom: the center of the south-west cell."""
    with open(path, "w") as out:
        out.write(f"ncols {len(rows[0])}\nnrows {len(rows)}\nxllcenter {left_m:g}\nyllcenter {bottom_m:g}\n"
                  f"cellsize {cell_m:g}\nNODATA_value {NODATA}\n")
        for row in rows:
            out.write(" ".join(str(NODATA) if z is None else f"{z:.2f}".rstrip("0").rstrip(".") for z in row) + "\n")


def read_grid(path):
    """Reads the output of gdal_translate: six lines of header at most, then rows."""
    nodata, rows = None, []
    with open(path) as file:
        for line in file:
            words = line.split()
            if words and words[0][0].isalpha() and words[0].lower() != "nan":
                if words[0].lower() == "nodata_value":
                    nodata = float(words[1])
            elif words:
                rows.append([float(word) for word in words])
    return [[None if z == nodata or math.isnan(z) else z for z in row] for row in rows]


def import_raster(options):
    for program in ("gdalwarp", "gdal_translate"):
        if shutil.which(program) is None:
            die(f"there is no {program}; install it with: apt-get install gdal-bin")
    latitude, longitude = options.origin
    if not (abs(latitude) <= 90 and abs(longitude) <= 360):
        die("--origin must be latitude,longitude in degrees")
    if not options.cell > 0:
        die(f"--cell must be > 0, got {options.cell:g}")
    half = [size / 2 for size in options.size]
    for size in options.size:
        if not size > 0 or abs(size / options.cell - round(size / options.cell)) > 1e-6:
            die(f"--size must be whole numbers of cells, got {size:g} m of {options.cell:g} m")
    if not options.file.startswith(("NETCDF:", "HDF5:")) and not os.path.exists(options.file):
        die(f"there is no file '{options.file}'")
    here = f"+proj=aeqd +lat_0={latitude} +lon_0={longitude} +x_0=0 +y_0=0 +datum=WGS84 +units=m"
    edge = options.cell / 2  # heights of GDAL's cells are at their centers
    with tempfile.TemporaryDirectory() as folder:
        band, warped, text = (os.path.join(folder, name) for name in ("band.vrt", "warped.tif", "grid.asc"))
        run(["gdal_translate", "-q", "-of", "VRT", "-b", str(options.band), options.file, band])
        command = ["gdalwarp", "-q", "-t_srs", here, "-te", *(str(v) for v in (-half[0] - edge, -half[1] - edge,
                   half[0] + edge, half[1] + edge)), "-tr", str(options.cell), str(options.cell), "-r", "bilinear", "-ot", "Float32",
                   "-dstnodata", str(NODATA)]
        if options.srs:
            command += ["-s_srs", options.srs]
        run(command + [band, warped])
        run(["gdal_translate", "-q", "-of", "AAIGrid", warped, text])
        rows = read_grid(text)
    if all(z is None for row in rows for z in row):
        die("the file has no heights around --origin; check --origin and --srs")
    sign = -1 if options.depth_positive_down else 1
    rows = [[None if z is None else sign * z + options.offset for z in row] for row in rows]
    write_grid(options.out, rows, options.cell, -half[0], -half[1])
    known = [z for row in rows for z in row if z is not None]
    holes = sum(z is None for row in rows for z in row)
    print(f"{options.out}: {len(rows[0])} x {len(rows)} heights from {min(known):.2f} to {max(known):.2f} m"
          + (f", {holes} holes" if holes else ""))
    if max(known) > 0 and min(known) >= 0:
        print("all of it is above the surface: are these depths? then --depth-positive-down")


def synthetic_m(x, y):
    """Returns the height of the sea floor; x east, y north, the shore in the south."""
    depth = 14.5 + 0.07 * y
    depth -= 0.35 * math.sin((0.8 * x + 0.6 * y) / 25 * 2 * math.pi)  # sand waves, 25 m long
    depth += 3 * math.exp(-(((x - 40 - 30 * math.sin(y / 60)) / 18) ** 2))  # a channel that winds to the north
    for mound_x, mound_y, radius, height in ((-90, 40, 22, 4.5), (110, -30, 15, 3.5)):
        depth -= height * math.exp(-((x - mound_x) ** 2 + (y - mound_y) ** 2) / (2 * radius**2))
    return -depth


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    raster = commands.add_parser("import", usage=__doc__)
    raster.add_argument("file")
    raster.add_argument("out")
    raster.add_argument("--origin", type=pair, required=True)
    raster.add_argument("--size", type=pair, required=True)
    raster.add_argument("--cell", type=float, required=True)
    raster.add_argument("--depth-positive-down", action="store_true")
    raster.add_argument("--offset", type=float, default=0)
    raster.add_argument("--srs")
    raster.add_argument("--band", type=int, default=1)
    commands.add_parser("synthetic", usage=__doc__).add_argument("out")
    # `--origin -33.8,151.2` would be read as an option by argparse.
    words, options_with_numbers = [], ("--origin", "--size", "--offset")
    for word in sys.argv[1:]:
        if words and words[-1] in options_with_numbers:
            words[-1] += "=" + word
        else:
            words.append(word)
    options = parser.parse_args(words)
    if options.command == "import":
        return import_raster(options)
    cell = 4
    rows = [[synthetic_m(x, y) for x in range(-200, 201, cell)] for y in range(150, -151, -cell)]
    write_grid(options.out, rows, cell, -200, 150 - cell * (len(rows) - 1))


if __name__ == "__main__":
    main()
