#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What garbage on its bus costs a run: pairs of runs beside the same flooder, on the run's port and on another one.

    unshare -rn sh -c 'ip link set lo up; ip route add 224.0.0.0/4 dev lo; tests/bench/flood.py build/release/bin'

Prints, for each kind of garbage, the median of the ratios of wall time (and of CPU time, with all programs of the run)
with an interval that holds the median with 95 %, whether the run hash is the same, and what the flooder sent.  Everything ends by itself.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

from own_ports import own_ports, url_of  # noqa: E402


def run(arguments, port, flood_port, kind, rate):
    """Wall seconds, CPU seconds and hash of one run beside a flooder; flood_port None: without one."""
    flooder = None
    if flood_port is not None:
        flooder = subprocess.Popen([arguments.flooder or f"{arguments.bin}/flood", str(flood_port), kind, str(rate),
                                    str(arguments.limit), arguments.channel], stdout=subprocess.DEVNULL)
        time.sleep(0.2)
    with tempfile.TemporaryDirectory() as folder:
        try:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run([f"{arguments.bin}/shoal", "run", arguments.world, "--launch", "--results", folder,
                            "--duration", str(arguments.duration), "--log-level", "off",
                            "--lcm-url", url_of(port)],
                           timeout=arguments.limit, stdout=subprocess.DEVNULL, check=False)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        finally:
            if flooder is not None:
                flooder.terminate()
                flooder.wait()
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return summary["wall_s"], cpu, summary["run_hash"]


def median_interval(values):
    """The median, and order statistics around it that hold it with 95 % (sign test)."""
    values = sorted(values)
    n = len(values)
    skip = max(0, int((n - 1.96 * n ** 0.5) / 2))
    return statistics.median(values), values[skip], values[n - 1 - skip]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="folder of shoal and flood")
    parser.add_argument("--flooder", help="another flood")
    parser.add_argument("--world", default="worlds/coop_land.yaml")
    parser.add_argument("--duration", type=float, default=100, help="simulated seconds of a run")
    parser.add_argument("--rate", type=int, default=20000, help="messages per second")
    parser.add_argument("--kinds", default="unwanted,malformed,fragments,noise")
    parser.add_argument("--channel", default="sim.control", help="for malformed and fragments")
    parser.add_argument("--pairs", type=int, default=9)
    parser.add_argument("--limit", type=float, default=120, help="seconds after which a run is given up")
    arguments = parser.parse_args()
    port = own_ports()
    for kind in arguments.kinds.split(","):
        walls, cpus, hashes, seconds = [], [], set(), []
        for pair in range(arguments.pairs):
            result = {}
            for own in ((True, False) if pair % 2 else (False, True)):
                result[own] = run(arguments, port, port if own else port + 1, kind, arguments.rate)
                hashes.add(result[own][2])
            walls.append(result[True][0] / result[False][0])
            cpus.append(result[True][1] / result[False][1])
            seconds.append(result[False][0])
        wall, cpu = median_interval(walls), median_interval(cpus)
        print(f"{kind} at {arguments.rate}/s, {arguments.pairs} pairs of {statistics.median(seconds):.2f} s: "
              f"wall {wall[0]:.3f} ({wall[1]:.3f} to {wall[2]:.3f}), CPU {cpu[0]:.3f} ({cpu[1]:.3f} to {cpu[2]:.3f}), "
              f"{'one hash' if len(hashes) == 1 else f'{len(hashes)} hashes'}", flush=True)


if __name__ == "__main__":
    main()
