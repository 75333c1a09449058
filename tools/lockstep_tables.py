#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/guides/lockstep.md: a mission with external clients, run again and again.

usage: lockstep_tables.py hashes [--speeds 1,10,max] [--threads 1,2,8]
       lockstep_tables.py killed [--policies wait,pause,continue,end] [--client rover2]
       both: [--bin build/release/bin] [--world worlds/coop_land.yaml] [--duration 20]

hashes  The run hash at each speed, with each number of threads, with the clients as they are and with some client
        stopped for up to 20 ms, all the time.  Exit code 1 when two hashes differ.
killed  Half way the client is killed (SIGKILL) or stalled (SIGSTOP), under each `lockstep.on_timeout`.  Where the world
        then stands, it is helped after a second: by SIGCONT, or by a request.
"""
import argparse
import contextlib
import itertools
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests"))

from own_ports import end_with_parent, own_url  # noqa: E402

URL = own_url()


class Run:
    """A run of a world with the programs that it names.  Its output is in `shown`."""

    def __init__(self, options, *more):
        self.shoal, self.results, self.shown = os.path.join(options.bin, "shoal"), tempfile.TemporaryDirectory(), []
        self.process = subprocess.Popen(
            [self.shoal, "run", options.world, "--launch", "--quiet", "--no-keys", "--no-plots", "--lcm-url", URL,
             "--duration", str(options.duration), "--set", "pass=[]", "--results", self.results.name, *more],
            stderr=subprocess.PIPE, text=True, preexec_fn=end_with_parent)
        self.reader = threading.Thread(target=lambda: self.shown.extend(self.process.stderr))
        self.reader.start()

    def clients(self):
        """Returns process ids and command lines, by the parent of each process: /proc/PID/task/PID/children is exact
        only for a process that stands still."""
        for pid in filter(str.isdecimal, os.listdir("/proc")):
            with contextlib.suppress(OSError):
                if parent_of(open(f"/proc/{pid}/stat", encoding="utf-8", errors="replace").read()) == self.process.pid:
                    yield int(pid), open(f"/proc/{pid}/cmdline", encoding="utf-8").read()

    def request(self, *arguments):
        """What the run answers, however busy the machine is; nothing after its end."""
        control = subprocess.Popen([self.shoal, "control", "--lcm-url", URL, "--timeout", "1000", *arguments],
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.await_that(lambda: control.poll() is not None)
        control.kill()
        return control.communicate()[0]

    def await_that(self, condition):
        while self.process.poll() is None and not condition():
            time.sleep(0.02)

    def finish(self):
        code = self.process.wait()
        self.reader.join()
        with open(os.path.join(self.results.name, "summary.json"), encoding="utf-8") as file:
            return code, json.load(file)


def parent_of(stat):
    """Of the process with this /proc/PID/stat: the second word behind its name."""
    return int(stat[stat.rindex(")") + 1:].split()[1])


def stop_at_random(run, chance):
    while run.process.poll() is None:
        clients = list(run.clients())
        if clients:
            pid, _ = chance.choice(clients)
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGSTOP)
                time.sleep(chance.uniform(0, 0.02))
                os.kill(pid, signal.SIGCONT)


def hashes(options):
    print("| speed | threads | clients | wall s | run hash |\n|---|---|---|---|---|")
    found = set()
    for speed, threads, slowed in itertools.product(options.speeds, options.threads, (False, True)):
        run = Run(options, "--speed", speed, "--threads", threads)
        if slowed:
            stop_at_random(run, random.Random(f"{speed} {threads}"))
        code, summary = run.finish()
        found.add((code, summary["run_hash"]))
        print(f"| {speed} | {threads} | {'stopped at random' if slowed else 'as they are'} | {summary['wall_s']:.1f} "
              f"| {summary['run_hash'] if code == 0 else f'exit code {code}'} |", flush=True)
    return len(found) - 1 and 1


def killed(options):
    print("| on_timeout | client | the run says | then | simulated s | exit code | run hash |\n" + "|---" * 7 + "|")
    for policy, how in itertools.product(options.policies, (signal.SIGKILL, signal.SIGSTOP)):
        run = Run(options, "--paused", "--set", f"lockstep.on_timeout={policy}", "--set", "lockstep.timeout_s=1")
        run.await_that(lambda: run.request("until", "--value", str(options.duration / 2)))
        run.await_that(lambda: "paused" in run.request("where"))
        pid = next((pid for pid, line in run.clients() if f"--name={options.client}" in line.split("\0")), None)
        if pid is None:
            run.process.kill()
            sys.exit(f"lockstep_tables: the world starts no program with --name={options.client}")
        os.kill(pid, how)
        run.request("resume")
        run.await_that(lambda: any(line.strip().endswith(("the world waits", "the world pauses")) for line in run.shown))
        then = ""
        if run.process.poll() is None:
            time.sleep(1)
            if how == signal.SIGSTOP:
                then = "SIGCONT"
                os.kill(pid, signal.SIGCONT)
            else:
                then = "resume" if policy == "pause" else f"leave --client {options.client}"
                run.request(*then.split())
        code, summary = run.finish()
        shown = "<br>".join(line.split("lockstep: ")[1].strip() for line in run.shown if "lockstep: " in line)
        print(f"| {policy} | {'killed' if how == signal.SIGKILL else 'stalled'} | {shown} | {then} "
              f"| {summary['sim_time_s']:g} | {code} | {summary['run_hash']} |", flush=True)
    return 0


parser = argparse.ArgumentParser(usage=__doc__)
parser.add_argument("table", choices=["hashes", "killed"])
for name, default in (("--speeds", "1,10,max"), ("--threads", "1,2,8"), ("--policies", "wait,pause,continue,end")):
    parser.add_argument(name, default=default, type=lambda text: text.split(","))
for name, default in (("--bin", "build/release/bin"), ("--world", "worlds/coop_land.yaml"), ("--client", "rover2")):
    parser.add_argument(name, default=default)
parser.add_argument("--duration", default=20, type=float)
chosen = parser.parse_args()
sys.exit(hashes(chosen) if chosen.table == "hashes" else killed(chosen))
