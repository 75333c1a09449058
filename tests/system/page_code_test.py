# SPDX-License-Identifier: BSD-3-Clause
"""The C++ and the commands in the pages of docs/: the C++ compiles, and the commands of shoal have the options they name.

    python3 page_code_test.py SOURCE BUILD COMPILER [-IFOLDER ...]

What README.md and docs/start tell to run is run by other tests.  A page that shows a part of a file, not all of it,
stands in PARTS with what is around that part.
"""
import concurrent.futures
import glob
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

from page_steps import blocks_of, commands_of, last_paragraph

SOURCE, BUILD, COMPILER, *INCLUDES = sys.argv[1:]
PAGES = sorted(glob.glob(os.path.join(SOURCE, "docs", "**", "*.md"), recursive=True))

# First line of the block: what comes before and after it.
PARTS = {
    "void DriveController::receive(sim::Time, std::span<const std::byte> payload) {": ("""
#include "devices/drive/differential_drive.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/device/device_registry.hpp"
namespace devices {
using Drive = DifferentialDrive;
class DriveController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.twist_command_t";
  explicit DriveController(Drive& drive) : drive_(drive) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;
  Drive& drive_;
};
""", "}"),
    "const sim::Presets& ground_probe_presets();  // ground_probe_presets.yaml": ("""
#include <string>
#include "sim/config/presets.hpp"
struct GroundProbe {
  struct Params {
    std::string preset = "none";
    void read(sim::ParamReader& in);
  };
};
""", ""),
    "struct State { Filter filter; Plan plan; };  // all that decisions depend on": ("""
#include <map>
#include "shoal/client.hpp"
struct Filter {};
struct Plan {};
template <class State>
void decide(State&, std::int64_t) {}
void fly(shoal::Client& client) {
""", "}"),
    'shoal::Client client("pilot");': ("""
#include "shoal/client.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/twist_command_t.hpp"
void fly(void (*on_scan)(const shoal::planar_lidar_t&)) {
""", "}"),
}


def page_blocks(page):
    with open(page, encoding="utf-8") as file:
        yield from blocks_of(file.read())


def name_of(page):
    return os.path.relpath(page, SOURCE)


class PageCode(unittest.TestCase):
    def write(self, folder, name, text):
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def test_cpp_compiles(self):
        """All files of a page together: one includes the other."""
        sources = []  # (place, folder, path)
        with tempfile.TemporaryDirectory() as scratch:
            for page in PAGES:
                folder = os.path.join(scratch, os.path.basename(page))
                for line, before, language, block in page_blocks(page):
                    name = re.search(r"`([\w./-]+\.(?:cpp|hpp))`[^`]*:$", last_paragraph(before))
                    if language != "cpp":
                        continue
                    around = PARTS.get(block.partition("\n")[0], ("", ""))
                    text = around[0] + f'#line {line + 1} "{name_of(page)}"\n' + block + around[1] + "\n"
                    path = self.write(folder, name[1] if name else f"line_{line}.cpp", text)
                    sources.append((f"{name_of(page)}:{line}", folder, path))
            self.assertGreater(len(sources), 8)

            def errors_of(source):
                place, folder, path = source
                done = subprocess.run([COMPILER, "-std=c++20", "-fsyntax-only", "-x", "c++", f"-I{folder}", *INCLUDES,
                                       f"-I{SOURCE}/bridges/client", path],
                                      capture_output=True, text=True)
                return f"{place}\n{done.stderr}" if done.returncode != 0 else ""

            with concurrent.futures.ThreadPoolExecutor(2) as pool:
                errors = [text for text in pool.map(errors_of, sources) if text]
        self.assertEqual(errors, [], "\n".join(errors))

    def test_commands_of_shoal_have_their_options(self):
        helps = {}
        faults, count = [], 0
        for page in PAGES:
            with open(page, encoding="utf-8") as file:
                made = set(re.findall(r"`shoal-(\w+)`:$", file.read(), re.M))  # commands that the page itself makes
            for line, _, language, block in page_blocks(page):
                if language not in ("sh", ""):
                    continue
                for command in commands_of(block):
                    for words in calls_of_shoal(command):
                        if words[0] in made:
                            continue
                        count += 1
                        faults += [f"{name_of(page)}:{line}: {command.strip()}: {fault}" for fault in self.faults_of(words, helps)]
        self.assertGreater(count, 100)
        self.assertEqual(faults, [], "\n".join(faults))

    def faults_of(self, words, helps):
        """`words`: command, subcommands, options and files."""
        path = []
        for word in words:
            if not re.fullmatch(r"[a-z][a-z0-9-]*", word) or not self.help_of(path + [word], helps):
                break
            path.append(word)
        if not path:
            return [] if words[0].startswith("-") else [f"no command '{words[0]}'"]
        text = "".join(self.help_of(path[:n], helps) for n in range(len(path) + 1))
        options = {word.partition("=")[0] for word in words if re.match(r"--?[A-Za-z]", word)}
        return [f"no option '{option}'" for option in sorted(options)
                if not re.search(r"(?<![\w-])" + re.escape(option) + r"(?![\w-])", text)]

    def help_of(self, path, helps):
        """Empty for what is not a command."""
        key = tuple(path)
        if key not in helps:
            done = subprocess.run([os.path.join(BUILD, "bin", "shoal"), *path, "--help"], capture_output=True, text=True)
            known = done.returncode == 0 and (not path or f"shoal {' '.join(path)}" in done.stdout.partition("\n\n")[0] + done.stdout)
            helps[key] = done.stdout if known else ""
        return helps[key]


def calls_of_shoal(command):
    """Words after `shoal` of each call in a line; none where the shell would put in what this cannot know."""
    command = re.sub(r"\s#.*$", "", command)
    for part in re.split(r"&&|\|\||[;|&]|\$\(", command):
        try:
            words = shlex.split(part.strip().rstrip(")"))
        except ValueError:
            continue
        while words and re.fullmatch(r"\w+=\S*|for|do|then|time|exec|nice|\$", words[0]):
            words = words[1:]
        if len(words) > 1 and os.path.basename(words[0]) == "shoal":
            yield words[1:]


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
