# SPDX-License-Identifier: BSD-3-Clause
"""tools/release refuses a tag that does not fit, and publishes files with their checksums; jobs only run scripts."""
import glob
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GH = """#!/bin/sh
for word in "$@"; do echo "$word"; done >"$GH_CALL"
cat >>"$GH_CALL"
"""
CHANGELOG = "# Changes\n\n## 1.2.3, 2030-04-05\n\n- New.\n\n## 1.2.2, 2029-01-01\n\n- Old.\n"


class Release(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, scratch)
        self.root, self.call = os.path.join(scratch, "checkout"), os.path.join(scratch, "call")
        self.write("CMakeLists.txt", "project(shoal VERSION 1.2.3 LANGUAGES CXX)\n")
        self.write("CITATION.cff", "version: 1.2.3\n")
        self.write("CHANGELOG.md", CHANGELOG)
        self.write(".gitignore", "build\n")
        self.write("../bin/gh", GH)
        os.chmod(os.path.join(scratch, "bin/gh"), 0o755)
        os.mkdir(os.path.join(self.root, "tools"))
        shutil.copy(os.path.join(ROOT, "tools/release"), os.path.join(self.root, "tools"))
        self.environment = dict(os.environ, PATH=os.path.join(scratch, "bin") + os.pathsep + os.environ["PATH"],
                                GH_CALL=self.call)
        subprocess.run(["git", "init", "-q", self.root], check=True)
        self.commit()

    def write(self, name, text):
        path = os.path.join(self.root, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def commit(self):
        git = ["git", "-C", self.root, "-c", "user.name=Me", "-c", "user.email=me@example.org"]
        subprocess.run([*git, "add", "--all"], check=True)
        subprocess.run([*git, "commit", "-qm", "All"], check=True)

    def release(self, *words, code=0):
        """Returns what it prints."""
        done = subprocess.run([os.path.join(self.root, "tools/release"), *words], env=self.environment, text=True,
                              capture_output=True, timeout=60)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_the_tag_of_the_version_is_accepted(self):
        self.assertEqual(self.release("check", "v1.2.3"), "")

    def test_another_tag_is_refused(self):
        self.assertEqual(self.release("check", "v1.3.0", code=1), "tools/release: the tag v1.3.0 does not fit the "
                         "version of CMakeLists.txt: it must be v1.2.3\n")

    def test_changes_that_are_not_released_are_refused(self):
        self.write("CHANGELOG.md", CHANGELOG.replace("## 1.2.3", "## Unreleased\n\n- Newer.\n\n## 1.2.3"))
        self.commit()
        self.assertEqual(self.release("check", "v1.2.3", code=1), "tools/release: CHANGELOG.md begins with "
                         "'## Unreleased': it must be '## 1.2.3, YEAR-MONTH-DAY'\n")

    def test_the_citation_must_have_the_version(self):
        self.write("CITATION.cff", "version: 1.2.30\n")
        self.commit()
        self.assertIn("the version in CITATION.cff is not 1.2.3", self.release("check", "v1.2.3", code=1))

    def test_changes_that_are_not_committed_are_refused(self):
        self.write("new.txt", "")
        self.assertIn("not committed", self.release("check", "v1.2.3", code=1))

    def test_files_are_published_with_checksums_and_the_section_of_the_changelog(self):
        self.write("build/attached/shoal.whl", "wheel")
        self.write("build/attached/SHA256SUMS", "of one job")
        self.release("publish", "v1.2.3", "build/attached")
        with open(os.path.join(self.root, "build/attached/SHA256SUMS"), encoding="utf-8") as file:
            self.assertEqual(file.read(), hashlib.sha256(b"wheel").hexdigest() + "  shoal.whl\n")
        with open(self.call, encoding="utf-8") as file:
            self.assertEqual(file.read().split("\n"),
                             ["release", "create", "v1.2.3", "--verify-tag", "--title", "Shoal 1.2.3", "--notes-file",
                              "-", "build/attached/SHA256SUMS", "build/attached/shoal.whl", "", "- New.", "", ""])

    def test_nothing_is_published_for_a_wrong_tag(self):
        self.write("build/attached/shoal.whl", "wheel")
        self.release("publish", "v1", "build/attached", code=1)
        self.assertFalse(os.path.exists(self.call))

    def test_wrong_words_print_the_usage(self):
        self.assertIn("tools/release publish TAG FOLDER", self.release("publish", "v1.2.3", code=2))


class Workflows(unittest.TestCase):
    # What a container needs before it can check out.
    BEFORE_CHECKOUT = "apt-get -qq update && apt-get -qq install -y git"

    def test_each_command_of_a_job_is_a_script_of_the_checkout(self):
        commands = []
        for path in glob.glob(os.path.join(ROOT, ".github/workflows/*.yml")):
            with open(path, encoding="utf-8") as file:
                jobs = yaml.safe_load(file)["jobs"]
            commands += [step["run"] for job in jobs.values() for step in job["steps"] if "run" in step]
        scripts = [command for command in commands if command != self.BEFORE_CHECKOUT]
        self.assertGreater(len(scripts), 0)
        for command in scripts:
            self.assertRegex(command, r"\A(tools|\.ci)/\w+[^\n;&|]*\Z")
            self.assertTrue(os.access(os.path.join(ROOT, re.split(r"\s", command)[0]), os.X_OK), command)


if __name__ == "__main__":
    unittest.main()
