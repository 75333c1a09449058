# SPDX-License-Identifier: BSD-3-Clause
"""Runs the steps of a page: writes its files, runs its commands in two terminals, compares what they print."""
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

from checkout_copy import own_bus
from page_steps import Change, Commands, File, PageError, missing_lines, steps_of

READY_S = 200


class Terminal:
    """A shell whose folder and exported variables last from one block of commands to the next."""

    def __init__(self, folder, environment, limit_s=250):
        self.folder, self.environment, self.limit_s = folder, environment, limit_s
        state = tempfile.NamedTemporaryFile(prefix="terminal-", delete=False, mode="w")
        state.write(f"cd {shlex.quote(folder)}\n")
        state.close()
        self.state = state.name

    def close(self):
        os.remove(self.state)

    def path(self, name):
        """Of a file in the folder where the shell is."""
        with open(self.state, encoding="utf-8") as file:
            folder = shlex.split(file.read().splitlines()[-1])[1]
        return os.path.join(folder, name)

    def start(self, script, **options):
        return subprocess.Popen(["bash", "-c", f". {self.state}\n{script}"], env=self.environment, text=True,
                                stdin=subprocess.DEVNULL, start_new_session=True, **options)

    def run(self, commands):
        """(exit code, what they print on either output)."""
        keep = f"trap '{{ export -p; printf \"cd %q\\n\" \"$PWD\"; }} > {self.state}.new; mv {self.state}.new {self.state}' EXIT"
        shell = self.start("\n".join([keep, "set -e", *commands]), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            printed, _ = shell.communicate(timeout=self.limit_s)
        except subprocess.TimeoutExpired:
            kill(shell)
            printed = f"{shell.communicate()[0]}\nnot done after {self.limit_s} s"
        return shell.returncode, printed


def installed_terminal(home, folder):
    """A shell in a new folder of `home`, with the shoal that is installed in home/shoal."""
    work = os.path.join(home, folder)
    os.mkdir(work)
    # Debian's interpreter, which has NumPy, comes before others.
    path = os.pathsep.join([home + "/shoal/bin", "/usr/bin", os.environ["PATH"]])
    return Terminal(work, dict(own_bus(), HOME=home, PATH=path))


def kill(shell):
    """With all that it has started."""
    os.killpg(shell.pid, signal.SIGKILL)


class PageRun:
    def __init__(self, terminal, adapted=lambda command: command):
        """`adapted`: what is run in place of a command of the page."""
        self.terminal, self.adapted = terminal, adapted
        self.failures, self.beside = [], None

    def run(self, text, name="page"):
        """Returns what went wrong, as texts; the first failure ends the page."""
        begin, count = time.monotonic(), 0
        try:
            steps = steps_of(text)
            for step, following in zip(steps, [*steps[1:], None]):
                self.take(step, second_terminal_follows(following))
                count += len(step.commands) if isinstance(step, Commands) else 0
        except PageError as error:
            self.failures.append(f"{name}: {error}")
        finally:
            if self.beside:
                kill(self.beside[1])
                self.beside[1].wait()
                self.beside[2].close()
        print(f"{name}: {count} commands in {time.monotonic() - begin:.1f} s", flush=True)
        return self.failures

    def take(self, step, goes_on):
        if isinstance(step, File):
            path = self.terminal.path(step.name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write(step.text)
        elif isinstance(step, Change):
            self.change(step)
        elif goes_on:
            self.start_beside(step)
        else:
            self.run_commands(step, step.commands)
            if step.second_terminal:
                self.end_beside(step)

    def change(self, step):
        path = self.terminal.path(step.name)
        with open(path, encoding="utf-8") as file:
            text = step.applied(file.read())
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def run_commands(self, step, commands):
        for number, command in enumerate(commands, 1):
            begin = time.monotonic()
            command = self.adapted(command)
            exit_code, printed = self.terminal.run([command])
            if os.environ.get("PAGE_TEST_TIMES"):
                print(f"{time.monotonic() - begin:6.1f} s  {exit_code}  {command}", file=sys.stderr)
            self.printed = printed if number == 1 else self.printed + printed
            expected = step.exit_code if number == len(step.commands) else 0
            if exit_code != expected and not self.accepts(command, exit_code):
                raise PageError(f"line {step.line}: `{command}` ends with exit code {exit_code}:\n{printed}")
        if commands:
            self.compare(step, step.printed, self.printed)

    def accepts(self, command, exit_code):
        """Whether that exit code is all right after all."""
        return False

    def compare(self, step, expected, printed):
        missing = missing_lines(expected, printed)
        if missing:
            raise PageError(f"line {step.line}: not printed: {missing[0]}\nbut:\n{printed}")

    def start_beside(self, step):
        if len(step.commands) != 1:
            raise PageError(f"line {step.line}: before a second terminal stands one command, not {len(step.commands)}")
        output = tempfile.TemporaryFile("w+")
        shell = self.terminal.start("exec " + self.adapted(step.commands[-1]), stdout=output, stderr=output)
        self.beside = (step, shell, output)
        if not re.search(r"\bshoal run\b", step.commands[-1]):
            return  # a program waits for its run, whichever is there first
        until = time.monotonic() + READY_S
        while self.terminal.run(["shoal control where --timeout 1"])[0] != 0:
            if shell.poll() is not None or time.monotonic() > until:
                raise PageError(f"line {step.line}: `{step.commands[-1]}` does not answer:\n{text_of(output)}")

    def end_beside(self, second):
        (step, shell, output), self.beside = self.beside, None
        try:
            exit_code = shell.wait(self.terminal.limit_s)
        except subprocess.TimeoutExpired:
            kill(shell)
            exit_code = f"{shell.wait()}: it did not end"
        if exit_code != step.exit_code:
            raise PageError(f"line {step.line}: `{step.commands[-1]}` ends with exit code {exit_code}:\n{text_of(output)}")
        self.compare(step, step.printed + second.printed_beside, text_of(output))
        output.close()


def second_terminal_follows(step):
    return isinstance(step, Commands) and step.second_terminal


def text_of(file):
    file.seek(0)
    return file.read()
