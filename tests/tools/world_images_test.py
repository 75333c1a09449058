# SPDX-License-Identifier: BSD-3-Clause
"""Checks that docs/guides/shipped_worlds.md shows every shipped world, and that its commands are those of its images."""
import importlib.machinery
import importlib.util
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOOL = os.path.join(ROOT, "tools", "make_world_images")
IMAGES = os.path.join(ROOT, "docs", "guides", "worlds")


def load_tool():
    loader = importlib.machinery.SourceFileLoader("make_world_images", TOOL)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("make_world_images", loader))
    loader.exec_module(module)
    return module


class WorldImages(unittest.TestCase):
    def setUp(self):
        self.tool = load_tool()
        with open(self.tool.PAGE, encoding="utf-8") as file:
            self.page = file.read()
        self.worlds = self.tool.worlds_of(self.page)

    def test_every_shipped_world_is_on_the_page(self):
        shipped = {name[:-len(".yaml")] for folder in ("worlds", "worlds/benchmark")
                   for name in os.listdir(os.path.join(ROOT, folder)) if name.endswith(".yaml")}
        self.assertEqual({name for name in shipped if not re.search(rf"\b{name}\b", self.page)}, set())
        self.assertEqual(set(self.worlds) - shipped, set())
        self.assertGreaterEqual(len(self.worlds), 22)

    def test_every_image_is_there_and_its_commands_write_it(self):
        images = {name for name in os.listdir(IMAGES)}
        self.assertEqual(images, {name + ".png" for name in self.worlds})
        for name, commands in self.worlds.items():
            self.assertIn(f"](worlds/{name}.png)", self.page)
            for command in commands:
                words = shlex.split(command)
                self.assertIn(words[:2], (["shoal", "run"], ["shoal", "snap"]), command)
                self.assertTrue({name, "benchmark/" + name} & set(words) if "--log" not in words
                                else name + ".lcm" in words, command)
            self.assertEqual(shlex.split(commands[-1])[-2:], ["--out", name + ".png"])

    def test_the_images_are_small(self):
        sizes = {name: os.path.getsize(os.path.join(IMAGES, name)) for name in os.listdir(IMAGES)}
        self.assertLess(max(sizes.values()), 150e3, sizes)
        self.assertLess(sum(sizes.values()), 3e6)

    def test_a_failing_command_is_reported(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertIn("exit code 3", self.tool.make("x", ["sh -c 'exit 3'"], folder, folder))
            self.assertIn("no command wrote x.png", self.tool.make("x", ["true"], folder, folder))

    def test_an_unknown_world_is_refused(self):
        done = subprocess.run([sys.executable, TOOL, "nowhere"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("'nowhere' has no commands", done.stderr)


if __name__ == "__main__":
    unittest.main()
