#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of docs/reference/known_limits.md: each limit names tests that fail when it is gone, and these are there.

A row ends with a comment: `<!-- Suite.Name; file_test.py: test_name; file_test.js: title of a test;
bad_worlds/file.yaml -->`, or `<!-- no test: reason -->`.  Limits that are the absence of a key or of a word of the file
formats are tested here, by the schemas: whoever adds such a key reads the row and mends it.
"""
import json
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs/reference/known_limits.md"
TESTS = ROOT / "tests"

# Rows about other programs, other machines, or figures that are measured, not tested.
ROWS_WITHOUT_TEST = 8


def rows():
    """Returns (limit, comment) of each row of the tables."""
    found = []
    for line in PAGE.read_text().splitlines():
        if line.startswith("| ") and not line.startswith("| limit |"):
            comment = re.search(r" <!-- (.*?) --> \|$", line)
            found.append((line.split(" | ")[0][2:], comment and comment[1]))
    return found


def gtests():
    return {".".join(test) for path in TESTS.rglob("*.cpp")
            for test in re.findall(r"^(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\(\s*(\w+),\s*(\w+)", path.read_text(), re.M)}


def is_there(name, known):
    if name.startswith("bad_worlds/"):
        return (TESTS / name).is_file()
    file, colon, title = name.partition(": ")
    if not colon:
        return name in known
    text = "".join(path.read_text() for path in TESTS.rglob(file))
    return f"def {title}(" in text if file.endswith(".py") else f"'{title}'" in text


class Page(unittest.TestCase):
    def test_each_limit_names_tests_that_are_there(self):
        known = gtests()
        self.assertGreater(len(rows()), 70)
        for limit, comment in rows():
            with self.subTest(limit):
                self.assertIsNotNone(comment, "names no test")
                if not comment.startswith("no test: "):
                    self.assertEqual([name for name in comment.split("; ") if not is_there(name, known)], [])

    def test_few_limits_have_no_test(self):
        without = [limit for limit, comment in rows() if comment and comment.startswith("no test: ")]
        self.assertLessEqual(len(without), ROWS_WITHOUT_TEST, without)


def schema(kind):
    return json.loads((ROOT / f"docs/reference/schema/{kind}.schema.json").read_text())


def words_of(property):
    """Returns the words of a choice, which may also be a parameter."""
    return set(property.get("enum") or property["anyOf"][0]["enum"])


def keys_of(part):
    """Returns the keys of a part of a schema, at any depth, and the words of its choices."""
    if isinstance(part, list):
        return {key for each in part for key in keys_of(each)}
    if not isinstance(part, dict):
        return set()
    found = set(part.get("properties", {})) | {word for word in part.get("enum", []) if isinstance(word, str)}
    return found | {key for each in part.values() for key in keys_of(each)}


class Formats(unittest.TestCase):
    """Each is about a row of the page: mend it when such a key is added."""

    @classmethod
    def setUpClass(cls):
        cls.world, cls.vehicle = schema("world")["properties"], schema("vehicle")["properties"]
        cls.definitions = schema("world")["definitions"]

    def assertLacks(self, part, *words):
        self.assertEqual(sorted(key for key in keys_of(part) if any(word in key for word in words)), [])

    def device(self, name):
        return {key: value for key, value in self.definitions["device_" + name]["properties"].items()
                if key not in ("latency_s",)}

    def test_bodies_are_rigid(self):
        shapes = words_of(self.vehicle["bodies"]["items"]["properties"]["parts"]["items"]["properties"]["shape"])
        joints = words_of(self.vehicle["joints"]["items"]["properties"]["type"])
        self.assertEqual(shapes, {"box", "sphere", "capsule", "cylinder", "plane", "mesh", "terrain"})
        self.assertEqual(joints, {"fixed", "ball", "hinge", "hinge2", "universal", "slider"})
        self.assertLacks([self.world["contacts"], self.world["objects"], self.vehicle["bodies"]], "young", "stretch",
                         "flexible", "tyre", "tire", "sink")

    def test_water_has_no_keys_for_what_is_left_out(self):
        hydrodynamics = self.vehicle["bodies"]["items"]["properties"]["hydrodynamics"]
        self.assertLacks(hydrodynamics, "radiation", "diffraction", "slam", "flood", "tank", "memory", "retardation",
                         "frequency", "bottom", "wall", "interaction")
        water = {**self.world["medium"]["properties"], "current": {}}  # a current refers to a depth of its water
        self.assertLacks(water, "stokes", "drift", "bound", "breaking", "refract", "fetch", "internal")

    def test_currents_and_waves_have_no_other_types(self):
        medium = self.world["medium"]["properties"]
        currents = medium["current"]["items"]["properties"]
        self.assertEqual(words_of(currents["type"]),
                         {"constant", "profile", "power_law", "wind_driven", "gauss_markov", "vortex", "grid"})
        self.assertEqual(words_of(medium["waves"]["properties"]["type"]), {"regular", "jonswap", "pierson_moskowitz"})
        self.assertLacks(currents, "time_file", "times", "depth_file", "depths", "netcdf")

    def test_sound_has_no_keys_for_what_is_left_out(self):
        acoustics = self.world["acoustics"]["properties"]
        self.assertLacks(acoustics, "scatter", "slope", "profiles", "code", "doppler")
        self.assertEqual(set(acoustics["noise"]["properties"]), {"shipping", "wind_mps", "offset_dB"})

    def test_sonars_have_one_straight_way(self):
        for sonar in ("sonar", "multibeam", "imaging_sonar", "side_scan"):
            self.assertLacks({"properties": self.device(sonar)}, "side_lobe", "multipath", "echoes", "doppler", "profile",
                             "propagation")

    def test_the_radar_has_one_straight_way(self):
        self.assertLacks({"properties": self.device("marine_radar")}, "side_lobe", "multipath", "lobing", "rain", "doppler",
                         "correlation", "material")

    def test_cameras_see_water_only_by_a_key(self):
        self.assertLacks({"properties": self.device("camera")}, "gpu")
        self.assertNotIn("water", self.definitions["device_camera"].get("required", []))
        self.assertNotIn("default", self.device("camera")["water"])
        self.assertLacks([self.world["light"], self.world["materials"]], "reflection", "refract", "soft", "water")

    def test_the_autopilot_names_no_sensor(self):
        self.assertLacks({"properties": self.device("autopilot")}, "sensor", "estimate", "gps", "imu", "dvl")

    def test_the_world_has_one_gravity_and_no_turning_earth(self):
        gravities = [key for key in keys_of(self.world["physics"]) if "gravity" in key]
        self.assertEqual(gravities, ["gravity_mps2"])
        self.assertLacks([self.world["origin"], self.world["physics"]], "earth", "rotation", "magnetic", "declination")


class Project(unittest.TestCase):
    def test_the_page_lacks_what_its_list_of_features_lacks(self):
        features = (ROOT / "docs/develop/view_features.md").read_text()
        for missing in ("Angles and WGS84 are not built", "| paths of sound, shadow zones | not built",
                        "studies, WebXR | not built"):
            self.assertIn(missing, features)

    def test_only_one_program_links_a_bus_of_ros(self):
        files = [ROOT / "CMakeLists.txt", *ROOT.glob("*/CMakeLists.txt"), *(ROOT / "cmake").glob("*.cmake")]
        text = "".join(path.read_text() for path in files)
        for library in ("rclcpp", "ament", "fastrtps", "zenoh"):
            self.assertNotIn(library, text)
        rooms = re.findall(r"shoal_room\([^)]*CycloneDDS::ddsc\)", text)
        self.assertEqual([room.split()[0] for room in rooms], ["shoal_room(dds"])

    def test_the_module_is_for_one_python_and_has_no_sanitizers(self):
        text = (ROOT / "CMakeLists.txt").read_text()
        self.assertIn("if(SHOAL_PYTHON AND NOT SHOAL_SANITIZE)", text)
        self.assertIn("find_program(SHOAL_PYTHON_INTERPRETER python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)", text)

    def test_the_build_asks_for_packages_of_debian(self):
        self.assertIn("Debian 12", (ROOT / "tools/apt-packages.txt").read_text().splitlines()[0])
        self.assertFalse([path for path in (ROOT / ".github/workflows").glob("*.yml")
                          if re.search(r"runs-on: *(macos|windows)", path.read_text())])


if __name__ == "__main__":
    unittest.main()
