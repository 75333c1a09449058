# SPDX-License-Identifier: BSD-3-Clause
"""tools/build_progress does what its text says, on a build tree."""
import heapq
import importlib.machinery
import importlib.util
import io
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
TOOL = os.path.join(ROOT, "tools", "build_progress")


def load_tool():
    sys.dont_write_bytecode = True  # the tool has no .py: its bytecode would lie in tools/
    loader = importlib.machinery.SourceFileLoader("build_progress", TOOL)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("build_progress", loader))
    loader.exec_module(module)
    return module


tool = load_tool()

# One edge waits for a file that never comes, so that an interrupt meets a build that is under way.
NINJA = """rule step
  command = touch $out
  description = Building CXX object $out
rule broken
  command = echo x.cpp:1:1: error: oops && exit 3
  description = Building CXX object $out
rule endless
  command = echo $$$$ >started.new && mv started.new started && exec tail -f /dev/null
%s
build bad: broken
build forever: endless
build all: phony %s
default all
"""


class BuildProgress(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        outputs = [f"o{i}" for i in range(20)]
        with open(os.path.join(self.folder, "build.ninja"), "w", encoding="utf-8") as file:
            file.write(NINJA % ("\n".join(f"build {name}: step" for name in outputs), " ".join(outputs)))

    def command(self, *targets):
        return [sys.executable, TOOL, self.folder, *targets]

    def test_a_log_has_a_line_for_each_tenth(self):
        done = subprocess.run(self.command(), capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual([line[:7] for line in done.stdout.splitlines()], [f"[{i:2}/20]" for i in range(2, 21, 2)])

    def test_errors_are_printed_whole_and_the_exit_code_is_that_of_the_build(self):
        done = subprocess.run(self.command("bad"), capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("x.cpp:1:1: error: oops", done.stdout)

    def test_a_signal_ends_the_build_and_its_steps(self):
        # As a terminal does, to all programs, and as kill does, to one.
        for send, number, code in ((os.killpg, signal.SIGINT, 130), (os.kill, signal.SIGINT, 130),
                                   (os.kill, signal.SIGTERM, 143), (os.kill, signal.SIGHUP, 129)):
            build = subprocess.Popen(self.command("forever"), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                     text=True, start_new_session=True)
            started = os.path.join(self.folder, "started")
            while not os.path.exists(started) and build.poll() is None:
                os.sched_yield()
            send(build.pid, number)
            output, _ = build.communicate(timeout=60)
            self.assertEqual((build.returncode, output),
                             (code, "tools/build: build stopped; run the same command again to continue\n"))
            with open(started, encoding="utf-8") as file:
                self.assertFalse(os.path.exists(f"/proc/{file.read().strip()}"))
            os.remove(started)

    def test_a_folder_that_is_not_configured_is_named(self):
        os.remove(os.path.join(self.folder, "build.ninja"))
        done = subprocess.run(self.command(), capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr),
                         (1, f"tools/build: {self.folder} is not configured: call tools/build\n"))

    def test_a_title_says_what_is_built_and_how_long_it_takes(self):
        done = subprocess.run([sys.executable, TOOL, "--title", "film", self.folder], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^building film, \d+ s\n")
        again = subprocess.run([sys.executable, TOOL, "--title", "film", self.folder], capture_output=True, text=True)
        self.assertEqual((again.returncode, again.stdout), (0, ""))  # there is nothing to build

    def test_an_estimate_without_a_build(self):
        def estimated(*targets):
            done = subprocess.run([sys.executable, TOOL, "--estimate", self.folder, *targets], capture_output=True,
                                  text=True, env={**os.environ, "CMAKE_BUILD_PARALLEL_LEVEL": "1"})
            return done.returncode, done.stdout or done.stderr
        # 20 outputs without an ending count as links.
        code, text = estimated()
        self.assertEqual(code, 0)
        self.assertAlmostEqual(float(text), 20 * tool.Costs().of("Linking CXX executable o1"), delta=1)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "o1")))
        with open(os.path.join(self.folder, ".build_speed"), "w", encoding="utf-8") as file:
            file.write("0.1")  # the last build ran at a tenth of the speed of the table
        self.assertAlmostEqual(float(estimated()[1]), 10 * float(text), delta=5.5)
        self.assertEqual(estimated("nothing"), (1, "tools/build: ninja: error: unknown target 'nothing'\n"))


class StepTimes(unittest.TestCase):
    def test_the_log_has_the_durations_of_this_build(self):
        with tempfile.TemporaryDirectory() as folder:
            def write(mode, *lines):
                with open(os.path.join(folder, ".ninja_log"), mode, encoding="utf-8") as log:
                    log.write("".join(f"{line}\n" for line in lines))
            times = tool.StepTimes(folder)
            self.assertIsNone(times.duration_of("a.o"))
            write("w", "# ninja log v5", "0\t900\t1\ta.o\tabc")
            self.assertIsNone(times.duration_of("a.o"))  # of an earlier build
            write("a", "100\t2600\t1\tb.o\tabc", "100\t400\t1\ta.o\tabc")
            self.assertEqual(times.duration_of("b.o"), 2.5)
            self.assertEqual(times.duration_of("a.o"), 0.3)
            write("w", "# ninja log v5")  # as ninja does when the log has become long
            self.assertEqual(times.duration_of("b.o"), 2.5)
            write("a", "0\t1000\t1\tb.o\tabc")
            self.assertEqual(times.duration_of("b.o"), 1.0)


class Table(unittest.TestCase):
    def test_costs_are_cpu_seconds_of_the_last_build_of_each_output(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "tools"))
            build_time = shutil.copy(os.path.join(ROOT, "tools", "build_time"), os.path.join(folder, "tools"))
            table = os.path.join(folder, "tools", "build_costs.txt")
            for path, text in ((table, "# Old.\n7.0 kept.o\n8.0 removed.o\n9.0 first.o\n"),
                               (os.path.join(folder, "build.ninja"), "rule r\n  command = false\n" + "".join(
                                   f"build {name}.o: r\n" for name in ("first", "second", "third", "kept", "short"))),
                               # The second build starts again at 0; there two steps share the cores for a second.
                               (os.path.join(folder, ".ninja_log"), "# ninja log v5\n0\t2000\t1\tfirst.o\ta\n"
                                f"0\t2000\t1\t{folder}/first.o\ta\n2000\t2010\t1\tshort.o\ta\n"
                                "0\t1000\t1\tsecond.o\ta\n0\t3000\t1\tthird.o\ta\n")):
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
            subprocess.run([sys.executable, build_time, "--costs", "--tree", folder], check=True)
            share = min(1, os.cpu_count() / 2)
            with open(table, encoding="utf-8") as file:
                self.assertEqual([line for line in file.read().splitlines() if not line.startswith("#")],
                                 ["2.0 first.o", "7.0 kept.o", f"{share:.1f} second.o", f"{2 + share:.1f} third.o"])
            self.assertEqual(tool.Costs(table).of("Building CXX object first.o"), 2.0)


class Estimate(unittest.TestCase):
    """Simulated builds on two cores, of which ninja runs three steps at once.  The costs are distributed as those of a
    first build were: a median of 3 s, and a tenth above 10 s."""
    PLACES = 3
    SPEED = 2 / 3

    def setUp(self):
        costs = random.Random(3)
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as table:
            for number in range(240):
                name = f"Unity/unity_{number}_cxx.cxx.o" if number % 2 else f"source_{number}.cpp.o"
                table.write(f"{costs.lognormvariate(1.1, 0.9):.1f} room/CMakeFiles/room.dir/{name}\n")
            table.flush()
            self.costs = tool.Costs(table.name)
        self.steps = [f"Building CXX object {output}" for output in self.costs.costs]
        random.Random(1).shuffle(self.steps)
        self.assertGreater(len(self.steps), 100)

    def timeline(self, pace=lambda now: 1.0, is_cached=lambda number: False, noise=0.2):
        """Returns (end, duration, step) of each step.  A step takes its cost over the speed, with a random factor, and
        times the pace of the moment."""
        errors, places, ends = random.Random(2), [0.0] * self.PLACES, []
        for number, step in enumerate(self.steps):
            start = heapq.heappop(places)
            work, end = self.costs.of(step) / self.SPEED * errors.lognormvariate(0, noise), start
            if is_cached(number):
                end += 0.1
            else:
                while work > 0:
                    part = min(work, 0.1)
                    work -= part
                    end += part * pace(end)
            heapq.heappush(places, end)
            ends.append((end, end - start, step))
        return sorted(ends)

    def misses(self, timeline, first=0.1, last=1.0, speed=SPEED):
        """Returns (time, shown, true) where the time left is wrong by more than 30 % and 5 % of the build."""
        estimate, all_s, wrong = tool.Estimate(self.costs, self.steps, self.PLACES, speed), timeline[-1][0], []
        for number, (now, duration, step) in enumerate(timeline):
            estimate.finished(step, duration, now)
            shown, true = estimate.left_s(now, len(timeline) - number - 1), all_s - now
            if first <= now / all_s <= last and abs(shown - true) > max(0.3 * true, 0.05 * all_s):
                wrong.append((round(now), round(shown), round(true)))
        return wrong

    def test_the_first_estimate_is_that_of_the_table(self):
        all_s = self.timeline(noise=0)[-1][0]
        estimate = tool.Estimate(self.costs, self.steps, self.PLACES, self.SPEED)
        self.assertAlmostEqual(estimate.left_s(0), all_s, delta=0.02 * all_s)

    def test_a_constant_rate(self):
        self.assertEqual(self.misses(self.timeline(), first=0), [])
        # Of another machine than that of the table, or of the last build.
        for factor in (0.25, 4):
            self.assertEqual(self.misses(self.timeline(), speed=factor * self.SPEED), [])

    def test_a_machine_that_becomes_twice_as_slow(self):
        undisturbed_s = self.timeline()[-1][0]
        for part in (0.05, 0.3, 0.6):
            timeline = self.timeline(pace=lambda now, at=part * undisturbed_s: 2.0 if now > at else 1.0)
            changed = part * undisturbed_s / timeline[-1][0]
            # No estimate can know before; afterwards a tenth of the work is enough.
            self.assertEqual(self.misses(timeline, first=changed + 0.1), [])

    def test_a_machine_that_is_busy_every_other_minute(self):
        self.assertEqual(self.misses(self.timeline(pace=lambda now: 1.0 + int(now // 60) % 2)), [])

    def test_half_of_the_steps_in_the_compiler_cache(self):
        self.assertEqual(self.misses(self.timeline(is_cached=lambda number: number % 2)), [])
        # When the cache has the first half only, its speed is soon no longer expected of the rest.
        half = len(self.steps) / 2
        self.assertEqual(self.misses(self.timeline(is_cached=lambda number: number < half), first=0.35), [])

    def test_steps_that_are_not_in_the_table_count_as_the_median_of_their_kind(self):
        unity = sorted(cost for output, cost in self.costs.costs.items() if "/unity_" in output)
        middle = self.costs.of("Building CXX object new/CMakeFiles/new.dir/Unity/unity_0_cxx.cxx.o")
        self.assertTrue(unity[len(unity) // 2 - 1] <= middle <= unity[len(unity) // 2])
        self.assertLess(self.costs.of("Generating x"), 0.1)

    def test_steps_that_ninja_leaves_out_or_adds_count(self):
        estimate = tool.Estimate(self.costs, self.steps, self.PLACES, self.SPEED)
        all_s, count = estimate.left_s(0), len(self.steps)
        self.assertAlmostEqual(estimate.left_s(0, count // 2), all_s / 2, delta=0.1 * all_s)
        self.assertGreater(estimate.left_s(0, count + 50), all_s + 10)
        self.assertEqual(estimate.left_s(0, 0), 0)

    def test_running_cmake_again_is_no_progress(self):
        out = io.StringIO()
        progress = tool.Progress(tool.Estimate(self.costs, self.steps, self.PLACES, self.SPEED), out, False, 0.0)
        progress.step(0, 2, "Re-checking globbed directories...", None, 1.0)
        progress.step(1, 2, "Re-running CMake...", None, 9.0)
        self.assertEqual(out.getvalue(), "")
        progress.step(20, 200, self.steps[0], None, 10.0)
        self.assertRegex(out.getvalue(), r"^\[ 20/200\] \d+ min.* left\n$")

    def test_times_are_round(self):
        self.assertEqual([tool.time_text(seconds) for seconds in (5, 89, 91, 119, 200, 594, 596, 3000)],
                         ["5 s", "89 s", "1 min 30 s", "2 min 0 s", "3 min 20 s", "9 min 50 s", "10 min", "50 min"])


if __name__ == "__main__":
    unittest.main()
