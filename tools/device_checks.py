#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes docs/develop/device_checks.md: what each device is checked against, by the names of its tests.

    tools/device_checks.py            writes the page
    tools/device_checks.py --check    says whether it is up to date; exit code 1: it is not

The devices are those of docs/reference/devices.md, which a test keeps up to date.  A test belongs to a device when it is in
a file named after it (`lidar_test.cpp`) or in a suite named after it (`Lidar`); a name that begins like an error is a check of
bad input, one that speaks of a spread is a statistic.
"""
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent
page = root / "docs/develop/device_checks.md"
bad_input = re.compile(r"Refuse|SaysWhatIsWrong|Ignores|DoesNotExist|^Names|Needs|ThereIsOne|BadKey|BadParameters")
statistic = re.compile(r"Noise|Spread|Variance|Mean(?!s)|Allan|Wander|Share|Probab|Statistic|Drift|Speckle|Fading|BitErrors")

head = """<!-- Written by tools/device_checks.py; a test fails when it is stale. -->
# What each device is checked against

The tests of each device, by their names: against something one can computes on paper, with statistics, and with bad
input. They are in `tests/devices`. Beside these, `EveryDevice` runs each device of the registry in its own world,
saves and restores it; `EveryActuator`, `SensorFault`, `ActuatorFault`, `ActuatorLatency`, `SensorLatency`, `Watchdog`,
`Power`, `Jitter` and `Dropout` check the layer around all devices.

| device | closed form and behavior | statistics | bad input |
|---|---|---|---|
"""


def tests_of(path):
    found = re.findall(r"\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)", path.read_text())
    return [(suite, name) for suite, name in found if not name.startswith("DISABLED_")]


def text():
    devices = re.findall(r"^## ([a-z0-9_]+)$", (root / "docs/reference/devices.md").read_text(), re.M)
    files = {path: tests_of(path) for path in sorted((root / "tests/devices").rglob("*_test.cpp"))}
    rows, missing = "", []
    for device in devices:
        suite_name = "".join(word.capitalize() for word in device.split("_"))
        suites = {suite_name, "EmergencyStop" if device == "estop" else suite_name}
        columns = [[], [], []]
        for path, tests in files.items():
            own_file = path.name == device + "_test.cpp"
            for suite, name in tests:
                if not own_file and suite not in suites:
                    continue
                column = 2 if bad_input.search(name) else 1 if statistic.search(name) else 0
                columns[column].append(f"`{suite}.{name}`")
        if not any(columns):
            missing.append(device)
        rows += f"| `{device}` | " + " | ".join(", ".join(sorted(set(column))) for column in columns) + " |\n"
    return head + rows, missing


def main():
    desired, missing = text()
    for device in missing:
        print(f"device '{device}' has no test: neither tests/devices/*/{device}_test.cpp nor a suite of its name",
              file=sys.stderr)
    if sys.argv[1:] == ["--check"]:
        stale = page.read_text() != desired
        if stale:
            print("docs/develop/device_checks.md is stale: run tools/device_checks.py", file=sys.stderr)
        return 1 if stale or missing else 0
    page.write_text(desired)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
