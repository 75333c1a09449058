# SPDX-License-Identifier: BSD-3-Clause
"""Plays a .mot file by the rule of Tekkotsu: each output has its own keys, linear between them in value and weight.  At
the start the values at time 0 are those of the robot, of every output that has a key with a weight; after its last key
an output holds."""
import math


def parse(text):
    """Returns {output: {time in ms: (value, weight)}}; there are no other files, and names are whole."""
    keys, time_ms, unit = {}, 1, 1.0
    lines = text.splitlines()
    if lines[0] != "#MSq":
        raise ValueError("no motion sequence")
    for line in lines[1:]:
        if line.startswith("#END"):
            return keys
        words = line.split()
        if not words or line.startswith("#"):
            continue
        command = words[0].lower()
        if command in ("advancetime", "delay"):
            time_ms += int(words[1])
        elif command == "settime":
            time_ms = int(words[1])
        elif command == "radians":
            unit = 1.0
        elif command == "degrees":
            unit = math.pi / 180
        else:
            weight = float(words[2]) if len(words) > 2 else 1.0
            keys.setdefault(words[0].rstrip("~"), {})[time_ms] = (float(words[1]) * unit, weight)
    raise ValueError("needs #END")


def value_at(keys, posture, time_ms):
    """Value and weight of an output; `posture`: its value at the start."""
    times = sorted(keys)
    weight_at_start = keys[0][1] if 0 in keys else 0.0
    course = [(0, (posture, weight_at_start))] + [(time, keys[time]) for time in times if time > 0]
    for (from_ms, before), (to_ms, after) in zip(course, course[1:]):
        if from_ms <= time_ms < to_ms:
            share = (time_ms - from_ms) / (to_ms - from_ms)
            return tuple(a + share * (b - a) for a, b in zip(before, after))
    return course[-1][1]


def play(text, step_ms, posture):
    """Returns [(time in ms, {output: (value, weight)})] for each step until the end; `posture`: {output: value}."""
    keys = parse(text)
    end_ms = max(max(times) for times in keys.values())
    played = []
    for time_ms in range(0, end_ms + step_ms, step_ms):
        played.append((min(time_ms, end_ms), {name: value_at(of_output, posture.get(name, 0.0), min(time_ms, end_ms))
                                              for name, of_output in keys.items()}))
    return played
