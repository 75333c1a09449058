# SPDX-License-Identifier: BSD-3-Clause
"""The README's first command compiles only what a run on land needs; `tools/build_time --first` measures how long.

    first_build_test.py BUILD_FOLDER
"""
import re
import subprocess
import sys
import unittest

BUILD = sys.argv.pop(1)
TARGETS = ["shoal", "shoal-coop-rover"]  # of tools/run worlds/coop_land.yaml --launch
# Today's number is 111.  Whoever needs more measures the minutes, and says what they buy.
MAX_OBJECTS = 115
# What other commands, a live page and other missions need.
LATER = re.compile(r"bridges_(web|foxglove|ros2_converters)|autonomy_(cooperative|mapping|known_map|vision|missions_)|"
                   r"experiment_(drive|study|campaign|replay|report|optimize)|viewer_(?!estimates)|(?<!sim_)(?<!devices_)motion_|verification_|"
                   r"tools_shoal_(view|film|motion|study|files|records|models|page)")


class FirstBuild(unittest.TestCase):

    def setUp(self):
        listed = subprocess.run(["ninja", "-C", BUILD, "-t", "inputs", *TARGETS], capture_output=True, text=True,
                                check=True)
        self.objects = [path for path in listed.stdout.splitlines() if path.endswith((".o", ".gch"))]

    def test_compiles_no_more_objects_than_were_measured(self):
        self.assertGreater(len(self.objects), 50)  # ninja has listed them
        self.assertLessEqual(len(self.objects), MAX_OBJECTS)

    def test_compiles_nothing_of_other_commands(self):
        self.assertEqual([path for path in self.objects if LATER.search(path)], [])


if __name__ == "__main__":
    unittest.main()
