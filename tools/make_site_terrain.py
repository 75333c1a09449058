#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes worlds/terrain/site_2km.png: 2 km x 2 km of rolling ground with a river valley and a leveled yard.

usage: make_site_terrain.py FILE.png

401 x 401 points 5 m apart, 16 bits of grey, black 0 m and white 120 m.  No package beyond Python's own is needed; the
same file comes out every time.
"""
import math
import random
import struct
import sys
import zlib

POINTS, CELL_M, WHITE_M = 401, 5.0, 120.0


def noise(lattice, x, y):
    """Returns value noise between the points of a lattice, with a smooth fade."""
    i, j = math.floor(x), math.floor(y)
    s, t = ((d * d * d * (d * (6 * d - 15) + 10)) for d in (x - i, y - j))
    a, b, c, d = (lattice[(i + k) & 63][(j + m) & 63] for m in (0, 1) for k in (0, 1))
    return (a * (1 - s) + b * s) * (1 - t) + (c * (1 - s) + d * s) * t


def height_m(lattice, x, y):
    hills = sum(0.42**k * noise(lattice, x / (500 / 2**k) + 17 * k, y / (500 / 2**k) + 31 * k) for k in range(6))
    height = 40 + 28 * hills
    # The river meanders along x; its valley is 150 m wide.
    away = y + 500 - 120 * math.sin(x / 260)
    height -= 25 * math.exp(-((away / 75) ** 2))
    # A yard of 120 m around the origin is leveled to 40 m, with banks of 100 m.
    bank = min(1.0, max(0.0, (math.hypot(x, y) - 60) / 100))
    bank = bank * bank * (3 - 2 * bank)
    return 40 + (height - 40) * bank


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def main():
    random.seed(1)
    lattice = [[random.uniform(-1, 1) for _ in range(64)] for _ in range(64)]
    half = (POINTS - 1) / 2
    rows = bytearray()
    for row in range(POINTS):
        rows.append(2)  # PNG filter `up`, which compresses slopes well
        line = [max(0, min(65535, round(65535 / WHITE_M * height_m(lattice, (i - half) * CELL_M, (half - row) * CELL_M))))
                for i in range(POINTS)]
        now = struct.pack(f">{POINTS}H", *line)
        before = now if row == 0 else last
        rows += bytes((a - b) & 255 for a, b in zip(now, before)) if row else now
        last = now
    header = struct.pack(">IIBBBBB", POINTS, POINTS, 16, 0, 0, 0, 0)
    with open(sys.argv[1], "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) +
                   chunk(b"IEND", b""))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
