#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs worlds for many simulated hours, twice each: memory and descriptors must stay flat, and hashes must be equal.

Memory (resident set) and open descriptors of the simulator and of each program of the world are sampled from /proc
while they run.  A run passes when, after the first sixth of it, a straight line through the memory of each process
grows by less than --limit-mb over the rest (upper end of the 95 % interval), and the number of descriptors stays what
it is.  The two runs of a world must end with the same run hash and state hash.

examples:
  tests/campaigns/soak.py --shoal build/release/bin/shoal                      24 hours of each default world
  tests/campaigns/soak.py --hours 1 --world coop_land --out /tmp/soak          another world, for an hour
  tests/campaigns/soak.py --hours 24 --jobs 2                                  two runs at a time
  tests/campaigns/soak.py -- --set 'metrics=[]' --set 'pass=[]'                without scores, which keep every estimate

The exit code is 1 when something grew or differs, 2 when a run did not come to its end.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import os
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

from own_ports import own_url  # noqa: E402

WORLDS = ["coop_underwater", "dynamic_warehouse"]
SETTLING = 1 / 6  # share of a run in which buffers, caches and rings may still fill


def descendants(root):
    """The process and all that it started: {pid: name}."""
    parents, names = {}, {}
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        try:
            with open(f"/proc/{entry}/stat") as file:
                text = file.read()
        except OSError:
            continue
        name = text[text.index("(") + 1:text.rindex(")")]
        parents[int(entry)] = int(text[text.rindex(")") + 1:].split()[1])
        names[int(entry)] = name
    found, grew = {root}, True
    while grew:
        more = {pid for pid, parent in parents.items() if parent in found and pid not in found}
        found |= more
        grew = bool(more)
    return {pid: names[pid] for pid in found if pid in names}


def sample(pid):
    """Resident kB and open descriptors; None when the process is gone."""
    try:
        with open(f"/proc/{pid}/status") as file:
            resident = [line for line in file if line.startswith("VmRSS:")]
        descriptors = len(os.listdir(f"/proc/{pid}/fd"))
    except OSError:
        return None
    return (int(resident[0].split()[1]), descriptors) if resident else None


def run(shoal, world, hours, folder, interval_s, alone, extra):
    """One run; gives the samples by process, and the summary."""
    results = os.path.join(folder, "results")
    os.makedirs(folder, exist_ok=True)
    url = own_url()
    command = [shoal, "run", world, "--duration", str(hours * 3600), "--speed", "max", "--no-keys", "--quiet",
               "--no-serial-ports", "--no-plots", "--results", results, *extra]
    command += ["--bus", "none"] if alone else ["--launch", "--lcm-url", url]
    samples = {}
    started = time.monotonic()
    with open(os.path.join(folder, "output.txt"), "w") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output, stdin=subprocess.DEVNULL)
        while process.poll() is None:
            for pid, name in descendants(process.pid).items():
                values = sample(pid)
                if values:
                    samples.setdefault((pid, name), []).append((time.monotonic() - started, *values))
            try:
                process.wait(interval_s)
            except subprocess.TimeoutExpired:
                pass
    wall_s = time.monotonic() - started
    try:
        with open(os.path.join(results, "summary.json")) as file:
            summary = json.load(file)
    except OSError:
        summary = {"ended": "no summary.json", "sim_time_s": 0}
    with open(os.path.join(folder, "samples.csv"), "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["process", "pid", "wall_s", "hours", "resident_kB", "descriptors"])
        for (pid, name), values in samples.items():
            for at, resident, descriptors in values:
                # The speed hardly changes within a run: a share of the wall time is that share of the simulated time.
                rows.writerow([name, pid, f"{at:.1f}", f"{at / wall_s * summary['sim_time_s'] / 3600:.3f}", resident,
                               descriptors])
    return samples, summary, wall_s


def slope(points):
    """Of a straight line through (x, y), by least squares, with the half width of its 95 % interval."""
    n = len(points)
    mean_x, mean_y = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    xx = sum((x - mean_x) ** 2 for x, _ in points)
    if n < 3 or xx == 0:
        return math.nan, math.nan
    value = sum((x - mean_x) * (y - mean_y) for x, y in points) / xx
    rest = sum((y - mean_y - value * (x - mean_x)) ** 2 for x, y in points)
    return value, 1.96 * math.sqrt(rest / (n - 2) / xx)


def judge(samples, hours, wall_s, limit_mb):
    """A row of figures for each process that lived to the end."""
    rows = []
    for (_, name), values in samples.items():
        late = [(at / wall_s * hours, resident / 1024, descriptors) for at, resident, descriptors in values
                if at >= SETTLING * wall_s]
        if len(late) < 10 or values[-1][0] < 0.9 * wall_s:
            continue
        per_hour, half = slope([(hour, resident) for hour, resident, _ in late])
        span_h = hours * (1 - SETTLING)
        descriptors = [number for _, _, number in late]
        rows.append({"process": name, "first_mb": late[0][1], "last_mb": late[-1][1],
                     "max_mb": max(resident for _, resident, _ in late), "per_hour_kb": per_hour * 1024,
                     "half_kb": half * 1024, "descriptors": (min(descriptors), max(descriptors)),
                     "flat": (per_hour + half) * span_h < limit_mb and min(descriptors) == max(descriptors),
                     "samples": len(late)})
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shoal", default="build/release/bin/shoal", help="the program (default %(default)s)")
    parser.add_argument("--hours", type=float, default=24, help="simulated hours of each run (default 24)")
    parser.add_argument("--world", action="append", help=f"repeatable (default {', '.join(WORLDS)})")
    parser.add_argument("--out", default="build/soak", help="folder for results and samples (default %(default)s)")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time (default 1)")
    parser.add_argument("--alone", action="store_true", help="without a bus and the programs of the world: faster")
    parser.add_argument("--interval-s", type=float, default=2, help="wall time between two samples (default 2)")
    parser.add_argument("--limit-mb", type=float, default=1, help="that memory may grow by after it settled (default 1)")
    parser.add_argument("extra", nargs="*", help="further options of shoal run, after --")
    given = parser.parse_args()
    worlds = given.world or WORLDS
    shoal = os.path.abspath(given.shoal)

    def one(job):
        world, number = job
        name = os.path.splitext(os.path.basename(world))[0]
        return run(shoal, world, given.hours, os.path.join(given.out, f"{name}_{number}"), given.interval_s,
                   given.alone, given.extra)

    jobs = [(world, number) for world in worlds for number in (1, 2)]
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        outcomes = dict(zip(jobs, pool.map(one, jobs)))

    code = 0
    print("| world, run | process | MB after 1/6 | MB at the end | growth, kB/h | descriptors | flat |")
    print("|---|---|---|---|---|---|---|")
    for (world, number), (samples, summary, wall_s) in outcomes.items():
        for row in judge(samples, summary["sim_time_s"] / 3600, wall_s, given.limit_mb):
            low, high = row["descriptors"]
            print(f"| {world} {number} | {row['process']} | {row['first_mb']:.1f} | {row['last_mb']:.1f} | "
                  f"{row['per_hour_kb']:.1f} ± {row['half_kb']:.1f} | {low if low == high else f'{low} to {high}'} | "
                  f"{'yes' if row['flat'] else 'NO'} |")
            code = max(code, 0 if row["flat"] else 1)
    print("\n| world | simulated | wall time | run hash | state hash | ended | equal |")
    print("|---|---|---|---|---|---|---|")
    for world in worlds:
        pair = [outcomes[(world, number)] for number in (1, 2)]
        hashes = [(summary.get("run_hash"), summary.get("state_hash")) for _, summary, _ in pair]
        whole = all(summary["sim_time_s"] >= given.hours * 3600 - 1 for _, summary, _ in pair)
        equal = hashes[0] == hashes[1] and hashes[0][0] is not None
        for (_, summary, wall_s), (run_hash, state_hash) in zip(pair, hashes):
            print(f"| {world} | {summary['sim_time_s'] / 3600:.1f} h | {wall_s:.0f} s | {run_hash} | {state_hash} | "
                  f"{summary['ended']} | {'yes' if equal else 'NO'} |")
        code = max(code, 2 if not whole else 0 if equal else 1)
    return code


if __name__ == "__main__":
    sys.exit(main())
