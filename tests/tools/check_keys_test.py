# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_keys names keys, commands and options in pages that do not exist."""
import os
import stat
import subprocess
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# Stands in for the program: prints help as it does.
SHOAL = """#!/bin/sh
case "$*" in
  --help) printf 'Usage: shoal COMMAND\\n\\nCommands:\\n  run  Run a world\\n  log  Look into logs\\n\\n' ;;
  "run --help") printf 'Options:\\n  -h, --help     help\\n  --duration S   seconds; see --speed\\n' ;;
  "log --help") printf 'Commands:\\n  info  Channels\\n\\n' ;;
  "log info --help") printf 'Options:\\n  --types FILE  more\\n' ;;
  *) exit 2 ;;
esac
"""


class CheckKeys(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.page, self.shoal = os.path.join(folder.name, "page.md"), os.path.join(folder.name, "shoal")
        with open(self.shoal, "w", encoding="utf-8") as file:
            file.write(SHOAL)
        os.chmod(self.shoal, stat.S_IRWXU)

    def faults_of(self, text):
        """LINE: what is wrong, up to the `;` before what is known."""
        with open(self.page, "w", encoding="utf-8") as file:
            file.write(text)
        done = subprocess.run([os.path.join(ROOT, "tools/check_keys"), "--program", self.shoal, self.page],
                              capture_output=True, text=True)
        lines = [line.removeprefix(self.page + ":").partition(";")[0] for line in done.stdout.splitlines()[:-1]]
        self.assertEqual((done.returncode, done.stderr), (1 if lines else 0, ""))
        return lines

    def yaml(self, text):
        return self.faults_of(f"```yaml\n{text}\n```\n")

    def test_any_part_of_a_file_may_be_shown(self):
        for text in ("shoal: 1\nname: x", "acoustics: {absorption: {model: thorp}}", "water: {density: eos80}",
                     "- {name: a, type: lidar, beams: 5}", "devices:\n  - {name: a, type: gps}\nzones: []"):
            self.assertEqual(self.yaml(text), [], text)

    def test_an_unknown_key_is_named_at_any_depth(self):
        self.assertEqual(self.yaml("acoustics:\n  absorption: {modell: thorp}"), ["3: unknown key 'modell'"])
        self.assertEqual(self.yaml("devices:\n  - name: a\n    type: lidar\n    thrusters: [b]"),
                         ["5: unknown key 'thrusters'"])  # a key of another type

    def test_an_unknown_word_is_named(self):
        self.assertEqual(self.yaml("acoustics: {absorption: {model: torp}}"), ["2: unknown word 'torp'"])

    def test_an_override_ends_in_a_key(self):
        text = "vehicles:\n  - name: r\n    file: r.yaml\n    overrides: {devices.lidar.%s: 5}"
        self.assertEqual(self.yaml(text % "beams"), [])
        self.assertEqual(self.yaml(text % "beems"), ["5: unknown key 'beems' in 'devices.lidar.beems'"])

    def test_studies_have_the_keys_that_are_read(self):
        self.assertEqual(self.yaml("study: x\nworld: y.yaml\nseeds: 1-3"), [])
        self.assertEqual(self.yaml("study: x\nsead: 1-3"), ["3: unknown key 'sead': experiment/study does not read it"])

    def test_what_is_not_yaml_is_named(self):
        self.assertEqual(self.yaml("a: [1"), ["2: is not YAML: expected ',' or ']', but got '<stream end>'"])

    def test_a_device_that_the_page_adds_may_have_any_keys(self):
        text = "```cpp\nSHOAL_SENSOR(\"probe\", Probe, PingReporter);\n```\n```yaml\n- {name: p, type: %s, wings: 2}\n```\n"
        self.assertEqual(self.faults_of(text % "probe"), [])
        self.assertEqual(len(self.faults_of(text % "gps")), 1)

    def test_commands_and_options_are_those_of_the_help(self):
        self.assertEqual(self.faults_of("```sh\nshoal run x.yaml --duration 5   # --gone\nshoal run x --sped 2; ls --l\n```\n"),
                         ["3: 'shoal run' has no option '--sped'"])
        self.assertEqual(self.faults_of("    build/release/bin/shoal log info x.lcm \\\n      --type y\n"),
                         ["1: 'shoal log info' has no option '--type'"])
        self.assertEqual(self.faults_of("Type `shoal fly`, `tools/run x.yaml --speed 2` or `shoal-fish --x`.\n"),
                         ["1: 'shoal run' has no option '--speed'", "1: 'shoal' has no command 'fly'",
                          "1: there is no program 'shoal-fish'"])


if __name__ == "__main__":
    unittest.main()
