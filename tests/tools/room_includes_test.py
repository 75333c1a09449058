# SPDX-License-Identifier: BSD-3-Clause
"""Rooms include only headers of rooms that they declare, and nothing but tests includes tools/.

    room_includes_test.py ROOMS_FILE
"""
import os
import re
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROOMS = sys.argv.pop(1)
INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.MULTILINE)
# What the Python package may use: it has no rooms of its own for what others have.
BELOW_PYTHON = {"sim", "messages", "bridges", "devices", "experiment", "python"}


def declared_rooms():
    """Returns the rooms that each room uses, by paths."""
    with open(ROOMS, encoding="utf-8") as file:
        return {path: uses.split() for path, uses in (line.rstrip("\n").split(":") for line in file)}


def closure_of(room, rooms):
    todo, found = [room], set()
    while todo:
        if (path := todo.pop()) not in found:
            found.add(path)
            todo += rooms[path]
    return found


def included(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return INCLUDE.findall(file.read())


class RoomIncludes(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        listed = subprocess.run(["git", "ls-files", "*.cpp", "*.hpp"], cwd=ROOT, capture_output=True, text=True,
                                check=True)
        cls.sources = [path for path in listed.stdout.splitlines() if not path.startswith(("tests/", "examples/"))]
        cls.rooms = declared_rooms()

    def test_a_room_includes_only_headers_of_rooms_that_it_declares(self):
        self.assertGreater(len(self.rooms), 100)
        closures = {room: closure_of(room, self.rooms) for room in self.rooms}
        wrong = []
        for path in self.sources:
            room = os.path.dirname(path)
            for header in included(path) if room in self.rooms else []:
                of = os.path.dirname(header)
                if of in self.rooms and of not in closures[room]:
                    wrong.append(f"{path} includes {header}, and {room} does not use {of}")
        self.assertEqual(wrong, [])

    def test_nothing_but_tools_includes_tools(self):
        self.assertEqual([path for path in self.sources
                          if not path.startswith("tools/") and any(h.startswith("tools/") for h in included(path))], [])

    def test_the_python_package_uses_what_is_below_it(self):
        tops = {header.split("/")[0] for path in self.sources if path.startswith("python/") for header in included(path)
                if os.path.isdir(os.path.join(ROOT, header.split("/")[0]))}
        self.assertEqual(tops - BELOW_PYTHON, set())


if __name__ == "__main__":
    unittest.main()
