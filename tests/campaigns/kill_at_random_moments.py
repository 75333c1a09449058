#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills recorded runs (SIGKILL) at random moments: each record must be readable, and lose at most a second.

Each run is started with --record, at the world's full speed, at real time or at a tenth of it, and killed a random
time after its record was made.  Then its record is read three times:

  shoal log info       whole events up to the end; at most one event that was cut off
  liblcm               the same number of events by lcm_eventlog_read_next_event()
  this script          the time of the last event, and the bytes behind it

Loss is wall time: from the last write into the record to the kill, for what was not written then is lost; and in a
paced run also from the last event's moment to the kill.  The record is made before the first step, so this counts the
start of the run as lost, too: an upper bound.

examples:
  tests/campaigns/kill_at_random_moments.py --shoal build/release/bin/shoal         1000 kills
  tests/campaigns/kill_at_random_moments.py --kills 50 --keep /tmp/killed           keep the records that are bad

The exit code is 1 when a record could not be read or lost more than a second.
"""
import argparse
import concurrent.futures
import ctypes
import os
import random
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time

WORLDS = ["minimal", "coop_land", "coop_underwater", "segway"]  # shipped
SPEEDS = {"full speed": "max", "real time": "1", "a tenth of it": "0.1"}
LIMIT_S = 1.0
SYNC = 0xEDA1DA01
HEAD = struct.Struct(">IqqII")


class LcmEvent(ctypes.Structure):
    _fields_ = [("number", ctypes.c_int64), ("timestamp", ctypes.c_int64), ("channel_length", ctypes.c_int32),
                ("data_length", ctypes.c_int32), ("channel", ctypes.c_char_p), ("data", ctypes.c_void_p)]


def lcm_library():
    library = ctypes.CDLL("liblcm.so.1")
    library.lcm_eventlog_create.restype = ctypes.c_void_p
    library.lcm_eventlog_create.argtypes = [ctypes.c_char_p, ctypes.c_char_p]
    library.lcm_eventlog_read_next_event.restype = ctypes.POINTER(LcmEvent)
    library.lcm_eventlog_read_next_event.argtypes = [ctypes.c_void_p]
    library.lcm_eventlog_free_event.argtypes = [ctypes.POINTER(LcmEvent)]
    library.lcm_eventlog_destroy.argtypes = [ctypes.c_void_p]
    return library


def count_by_lcm(library, path):
    log = library.lcm_eventlog_create(path.encode(), b"r")
    if not log:
        return None
    count = 0
    while event := library.lcm_eventlog_read_next_event(log):
        count += 1
        library.lcm_eventlog_free_event(event)
    library.lcm_eventlog_destroy(log)
    return count


def read_events(path):
    """Events, time of the first and the last one in us, bytes behind the last whole one; ValueError when damaged."""
    with open(path, "rb") as file:
        data = file.read()
    at, count, first, last = 0, 0, None, None
    while at + HEAD.size <= len(data):
        sync, number, utime, channel, payload = HEAD.unpack_from(data, at)
        if sync != SYNC or number != count:
            raise ValueError(f"byte {at}: not event {count}")
        if at + HEAD.size + channel + payload > len(data):
            break
        at += HEAD.size + channel + payload
        first, last, count = utime if first is None else first, utime, count + 1
    return count, first, last, len(data) - at


def kill_one(shoal, library, folder, number, seed, keep):
    """One run; gives its speed, its world, and what came of its record."""
    rng = random.Random(seed * 1_000_003 + number)
    world, kind = rng.choice(WORLDS), rng.choice(list(SPEEDS))
    # Mostly short: writing begins at once.  Slow runs are also watched over some seconds.
    after_s = rng.uniform(0, 0.9) if rng.random() < 0.7 else rng.uniform(0.9, 4)
    record = os.path.join(folder, f"{number}.lcm")
    command = [shoal, "run", world, "--bus", "none", "--no-serial-ports", "--duration", "forever", "--speed", SPEEDS[kind],
               "--record", record, "--no-keys", "--quiet", "--log-level", "off"]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    while not os.path.exists(record) and process.poll() is None:
        time.sleep(0.001)
    made_at = time.time()
    time.sleep(after_s)
    killed_at = time.time()
    process.send_signal(signal.SIGKILL)
    code = process.wait()
    result = {"world": world, "kind": kind, "after_s": after_s, "problems": [], "events": 0, "loss_s": None}
    if code != -signal.SIGKILL:
        result["problems"].append(f"ended by itself with {code}")
        return result
    status = os.stat(record)
    # The clock of files ticks every few milliseconds, so that a write may seem earlier, never later.
    result["loss_s"] = killed_at - status.st_mtime
    if status.st_size > 0:
        try:
            count, first, last, rest = read_events(record)
            result.update(events=count, rest=rest)
            if kind != "full speed" and count > 0:
                shown_s = (last - first) / 1e6 / float(SPEEDS[kind])
                result["paced_s"] = killed_at - made_at - shown_s
            if (by_lcm := count_by_lcm(library, record)) != count:
                result["problems"].append(f"liblcm reads {by_lcm} events of {count}")
        except ValueError as error:
            result["problems"].append(str(error))
        info = subprocess.run([shoal, "log", "info", record], capture_output=True, text=True)
        words = info.stdout + info.stderr
        if not re.search(rf"\b{result['events']}\b", words.replace(",", "")) or "skipped" in words:
            result["problems"].append(f"shoal log info ({info.returncode}): {words.strip()[-300:]}")
    losses = [value for value in (result["loss_s"], result.get("paced_s")) if value is not None]
    if max(losses) > LIMIT_S:
        result["problems"].append(f"lost {max(losses):.3f} s")
    if not (keep and result["problems"]):
        os.remove(record)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shoal", default="build/release/bin/shoal", help="the program (default %(default)s)")
    parser.add_argument("--kills", type=int, default=1000, help="how many runs (default 1000)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time (default 2)")
    parser.add_argument("--seed", type=int, default=1, help="of moments and worlds (default 1)")
    parser.add_argument("--keep", help="a folder in which bad records are kept")
    given = parser.parse_args()
    library = lcm_library()
    with tempfile.TemporaryDirectory(prefix="shoal-kill-") as scratch:
        folder = given.keep or scratch
        os.makedirs(folder, exist_ok=True)
        with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
            results = list(pool.map(lambda number: kill_one(os.path.abspath(given.shoal), library, folder, number,
                                                            given.seed, given.keep), range(given.kills)))
    print("| speed | kills | empty records | events | cut off | longest loss: since the last write | of paced time | bad |")
    print("|---|---|---|---|---|---|---|---|")
    for kind in SPEEDS:
        those = [result for result in results if result["kind"] == kind]
        made = [result for result in those if result["loss_s"] is not None]
        longest = max((result["loss_s"] for result in made), default=0)
        paced = max((result["paced_s"] for result in made if "paced_s" in result), default=None)
        print(f"| {kind} | {len(those)} | {sum(1 for result in made if not result['events'])} | {sum(result['events'] for result in made)} | "
              f"{sum(1 for result in made if result.get('rest'))} | {longest:.3f} s | "
              f"{'' if paced is None else f'{paced:.3f} s'} | {sum(1 for result in those if result['problems'])} |")
    bad = [result for result in results if result["problems"]]
    for result in bad[:20]:
        print(f"{result['world']} at {result['kind']}, killed after {result['after_s']:.3f} s: "
              f"{'; '.join(result['problems'])}", file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
