# SPDX-License-Identifier: BSD-3-Clause
"""Plays a .motion file by the rule of Webots: at each control step the poses at `elapsed` are commanded, linear between
two lines, then the step is added.  A motion ends, or its loop goes back to 0, in the step at or after the end."""


def parse(text):
    """Returns the names of devices, and [(time in ms, [value or None])]."""
    lines = text.splitlines()
    head = lines[0].split(",")
    if head[:2] != ["#WEBOTS_MOTION", "V1.0"]:
        raise ValueError("no .motion file")
    poses = []
    for line in lines[1:]:
        if not line:
            break
        words = line.split(",")
        time_ms = 0
        for part, unit in zip(reversed(words[0].split(":")), (1, 1000, 60000)):
            time_ms += int(part) * unit
        poses.append((time_ms, [None if word == "*" else float(word) for word in words[2:]]))
    return head[2:], poses


def value_at(poses, joint, elapsed):
    if elapsed <= poses[0][0]:
        return poses[0][1][joint]
    if elapsed >= poses[-1][0]:
        return poses[-1][1][joint]
    for (from_ms, before), (to_ms, after) in zip(poses, poses[1:]):
        if from_ms <= elapsed <= to_ms:
            if before[joint] is None or after[joint] is None:
                return None
            return before[joint] + (elapsed - from_ms) * (after[joint] - before[joint]) / (to_ms - from_ms)
    raise AssertionError("times must increase")


def play(text, step_ms, loop_steps=None):
    """Returns the names, and the commanded values of each control step; `loop_steps`: so many steps of a loop."""
    names, poses = parse(text)
    duration = poses[-1][0]
    commands, elapsed = [], 0
    while loop_steps is None or len(commands) < loop_steps:
        commands.append([value_at(poses, joint, elapsed) for joint in range(len(names))])
        if elapsed >= duration:
            if loop_steps is None:
                break
            elapsed = 0
        else:
            elapsed += step_ms
    return names, commands
