# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a page in Markdown: the files that a reader writes and the commands to run, in order.

What a fenced block is follows from its language and from the paragraph before it:

    sh        commands, one per line.  With `exit code N` in the paragraph the last one ends with N instead of 0.  With
              "second terminal" in it they run while the last command of the block before continues; that one has to end by
              itself soon after them.
    text      lines that the commands before it print, on either output; `...` stands for any text.  With "first
              terminal" in the paragraph they are printed by the command that continues beside the second terminal.
    diff      a change to the file whose name in backticks comes last in the paragraph, else to the one that was changed
              before: lines without `+` are there exactly once, one after the other, and become the lines without `-`.
    any other a file, when the paragraph ends with its name in backticks and a colon; the block is all of it.
"""
import dataclasses
import re


@dataclasses.dataclass
class File:
    line: int
    name: str
    text: str


@dataclasses.dataclass
class Change:
    line: int
    name: str
    before: str
    after: str

    def applied(self, text):
        places = [found.start() for found in re.finditer("^" + re.escape(self.before), text, re.M)]
        if len(places) != 1:
            raise PageError(f"line {self.line}: the lines to change are {len(places)} times in {self.name}")
        return text[:places[0]] + self.after + text[places[0] + len(self.before):]


@dataclasses.dataclass
class Commands:
    line: int
    commands: list
    exit_code: int = 0
    second_terminal: bool = False
    printed: list = dataclasses.field(default_factory=list)  # lines, `...` is any text
    printed_beside: list = dataclasses.field(default_factory=list)  # by the command of the first terminal


class PageError(Exception):
    pass


def steps_of(text):
    """File, Change and Commands of a page, in order."""
    steps, paragraph = [], ""
    for line, before, language, block in blocks_of(text):
        paragraph = last_paragraph(before)
        add_step(steps, line, paragraph, language, block)
    return steps


def blocks_of(text):
    """(line of the fence, text since the block before, language, content) of each fenced block."""
    end = 0
    for found in re.finditer(r"^```(\S*)[^\n]*\n(.*?)^```$", text, re.S | re.M):
        line = text.count("\n", 0, found.start()) + 1
        yield line, text[end:found.start()], found[1], found[2]
        end = found.end()


def last_paragraph(text):
    return " ".join(text.strip().rsplit("\n\n", 1)[-1].split())


def add_step(steps, line, paragraph, language, block):
    if language == "sh":
        code = re.search(r"exit code (\d+)", paragraph)
        steps.append(Commands(line, commands_of(block), int(code[1]) if code else 0, "second terminal" in paragraph))
    elif language == "text":
        commands = [step for step in steps if isinstance(step, Commands)]
        if not commands:
            raise PageError(f"line {line}: output before any command")
        lines = [row for row in block.splitlines() if row.strip()]
        (commands[-1].printed_beside if "first terminal" in paragraph else commands[-1].printed).extend(lines)
    elif language == "diff":
        names = [step.name for step in steps if isinstance(step, Change)][-1:]
        names += re.findall(r"`([\w./-]+\.\w+)`", paragraph)
        if not names:
            raise PageError(f"line {line}: which file is to be changed?")
        rows = block.splitlines()
        steps.append(Change(line, names[-1], without("+", rows), without("-", rows)))
    else:
        name = re.search(r"`([\w./-]+)`:$", paragraph)
        if not name:
            raise PageError(f"line {line}: the paragraph before a file ends with its name in backticks and a colon")
        steps.append(File(line, name[1], block))


def without(sign, rows):
    return "".join(row[1:] + "\n" for row in rows if not row.startswith(sign))


def commands_of(block):
    """The commands of a block of `sh`; a backslash joins lines."""
    joined = re.sub(r"\\\n\s*", "", block)
    return [row for row in joined.splitlines() if row.strip() and not row.lstrip().startswith("#")]


def commands_outside_blocks(text, programs):
    """Code in sentences that is a whole command, of a program's name and two words at least, and in no block."""
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.S | re.M)
    codes = [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", prose)]
    run = [command for _, _, language, block in blocks_of(text) if language == "sh" for command in commands_of(block)]
    return [code for code in codes if code.startswith(programs) and len(code.split()) > 2
            and not any(command.startswith(code) for command in run)]


def missing_lines(expected, printed):
    """Lines of `expected` that are not among the printed ones; `...` is any text, spaces count as one."""
    rows = [" ".join(row.split()) for row in re.split(r"[\r\n]+", re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "", printed))]
    return [line for line in expected
            if not any(re.fullmatch(pattern_of(line), row) for row in rows)]


def pattern_of(line):
    parts = " ".join(line.split()).split("...")
    return ".*".join(re.escape(part) for part in parts)
