# SPDX-License-Identifier: BSD-3-Clause
"""Plays an MTN file as the sample of OPEN-R: in a segment with n frames of 16 ms between its keys, 2 n + 2 frames of 8 ms
are sent, the first with the values of the key; the step is the difference divided by 2 n + 2, truncated.  The last key
is never sent."""
import struct


def parse(data):
    """Returns a dictionary: name, creator, design, locators, keys [(n, roll, pitch, yaw, [joints in urad])]."""
    def text(at):
        return data[at + 1:at + 1 + data[at]].decode(), at + 1 + data[at]

    if data[:4] != b"OMTN":
        raise ValueError("no MTN file")
    _, size, _, _, _, keys, frame_ms, _ = struct.unpack_from("<IIIHHHHI", data, 4)
    if frame_ms != 16:
        raise ValueError("frames must be 16 ms")
    section = 4 + size
    name, at = text(section + 8)
    creator, at = text(at)
    design, at = text(at)
    section += struct.unpack_from("<II", data, section)[1]
    joints, = struct.unpack_from("<H", data, section + 8)
    at, locators = section + 10, []
    for _ in range(joints):
        locator, at = text(at)
        locators.append(locator)
    section += struct.unpack_from("<II", data, section)[1]
    at, read = section + 12, []
    for key in range(keys):
        between = 0
        if key > 0:
            between, = struct.unpack_from("<i", data, at)
            at += 4
        roll, pitch, yaw, *values = struct.unpack_from(f"<{3 + joints}i", data, at)
        at += 4 * (3 + joints)
        read.append((between, roll, pitch, yaw, values))
    if at != len(data):
        raise ValueError(f"{len(data) - at} bytes are left")
    return {"name": name, "creator": creator, "design": design, "locators": locators, "keys": read}


def truncated(numerator, denominator):
    quotient = abs(numerator) // denominator
    return quotient if numerator >= 0 else -quotient


def play(data):
    """Returns the locators, and [(values in urad, n of the segment)] for each frame of 8 ms."""
    file = parse(data)
    frames = []
    for before, after in zip(file["keys"], file["keys"][1:]):
        between = after[0]
        steps = 2 * between + 2
        deltas = [truncated(to - from_, steps) for from_, to in zip(before[4], after[4])]
        for frame in range(steps):
            frames.append(([value + frame * delta for value, delta in zip(before[4], deltas)], between))
    return file["locators"], frames
