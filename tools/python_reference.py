# SPDX-License-Identifier: BSD-3-Clause
"""Makes docs/reference/python.md of the docstrings of the Python package.

    PYTHONPATH=build/release/lib/python /usr/bin/python3 tools/python_reference.py [--check]

--check only reports whether the page is up to date.
"""
import inspect
import os
import re
import sys
import textwrap

import shoal
from shoal import messages, plots, results, vector

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'docs', 'reference', 'python.md')
HEAD = """# Python package

Made by `tools/python_reference.py` from the docstrings of the package `shoal`; `help(shoal)` shows the same.
[Lesson 8](../start/8_python.md) is the way in.

Distances are in meters, angles in radians, times in seconds, unless a name says otherwise; `utime` is in microseconds.
World axes are east, north, up; vehicle axes are forward, left, up.

Everything that Shoal refuses raises `shoal.Error` (a `RuntimeError` and a `ValueError`), with the text that the program
prints; a wrong type of an argument raises `TypeError`. A world, a client and a set of worlds may be used by one thread
at a time; others get a `shoal.Error`, and so does a forked process, which has to make its own. Ctrl-C ends a long step,
a run and the waiting of a client.

## Names of channels

| who | a name that is close to one of the world | any other unknown name |
|---|---|---|
| `World.last`, `World.subscribe` | error that names it | one warning: it may be for messages of the program |
| `World.publish` | error that names it | one warning, unless the program has subscribed to it |
| actions and observations of `shoal.vector` | error that names it | error: only the world can send or receive here |
| `read` | warning at the end of the record that names it | warning at the end of the record |
| `table` | error that names it | error |
| `Client` | none | none: on a network other programs may use it |

The names of a world are the channels of its devices, of its events and metrics, and those on which the program has
published.

## Programs for the classes of lcm-gen

The package has the name of the one that `lcm-gen` makes of the `.lcm` files, and its classes: `shoal.imu_t` with
`encode()`, `decode()` and `get_hash()`. Programs for those classes run with it, and need no `lcm` module when they use
`Client`. Arrays of numbers are NumPy arrays instead of lists and tuples: `append()` has to become an assignment of a
list, and an array of `byte` is an array instead of `bytes`; `bytes(message.data)` is right for both. Members that are
the length of an array need not be set.
"""


def heading(name, value, level):
    """Returns the heading of a function with its parameters, or of a property."""
    if isinstance(value, property):
        kind = inspect.signature(value.fget).return_annotation
        return f'{"#" * level} `{name}`: {escaped(kind)}'
    signature = inspect.signature(value)
    parameters = [each for each in signature.parameters.values() if each.name not in ('self', 'cls')]
    signature = signature.replace(parameters=parameters)
    text = re.sub(r"<class '(\w+)'>", r'\1', str(signature))
    return f'{"#" * level} `{name}' + re.sub(r"(: |-> )'([^']*)'", r'\1\2', text) + '`'


def escaped(kind):
    return f'`{kind}`' if isinstance(kind, str) else f'`{getattr(kind, "__name__", kind)}`'


def body(text, indented=True):
    """Returns a docstring as Markdown: parameters become a list, and indented blocks are code."""
    first, _, rest = (text or '').partition('\n')
    lines, made = [first.strip(), *(textwrap.dedent(rest) if indented else rest).strip('\n').splitlines()], []
    if len(lines) > 1 and rest.startswith('\n'):
        lines.insert(1, '')
    for index, line in enumerate(lines):
        if line.startswith('    ') and (made and made[-1].startswith('* ')):
            made[-1] += ' ' + line.strip()
        elif line.startswith('    '):
            made.append(line)
        elif is_parameter(line, lines[index - 1] if index else ''):
            made.append('* ' + line)
        elif made and made[-1].startswith('* ') and line:
            made += ['', line]
        else:
            made.append(line)
    return '\n'.join(made).replace('<', '\\<')


def is_parameter(line, before):
    name, mark, _ = line.partition(': ')
    return bool(mark) and all(part.strip('*').isidentifier() for part in name.split(', ')) and (
        not before or is_parameter(before, '') or before.startswith('    '))


def members_of(owner):
    """Yields name and object of the public members of a class, in the order of the source."""
    for name, value in vars(owner).items():
        if isinstance(value, (classmethod, staticmethod)):
            value = value.__func__
        if not name.startswith('_') and (inspect.isfunction(value) or isinstance(value, property)):
            yield name, value


def class_text(name, owner):
    """Returns the section of a class."""
    parts = [f'## {name}', body(owner.__doc__)]
    init = vars(owner).get('__init__')
    if init is not None and init.__doc__:
        parts += [heading(name, init, 3).replace(' -> None', ''), body(init.__doc__)]
    for member, value in members_of(owner):
        parts += [heading(member, value, 3), body((value.fget if isinstance(value, property) else value).__doc__)]
    return parts


def page():
    """Returns the whole page."""
    parts = [HEAD.strip()]
    for name in ('World', 'Subscription', 'Client', 'DeviceChannels', 'run', 'Run', 'study', 'Study', 'read', 'table',
                 'Record', 'Event', 'RecordWriter', 'set_log_level'):
        value = getattr(shoal, name)
        if inspect.isclass(value):
            parts += class_text(name, value)
        else:
            parts += [heading(name, value, 2), body(value.__doc__)]
    for module in (messages, results, plots, vector):
        short = module.__name__.partition('.')[2]
        parts += [f'## shoal.{short}', body(module.__doc__, indented=False)]
        for name, value in vars(module).items():
            if name.startswith('_') or getattr(value, '__module__', None) != module.__name__:
                continue
            if inspect.isclass(value):
                own = class_text(name, value)
                parts += ['##' + own[0][1:], *('#' + each if each.startswith('### ') else each for each in own[1:])]
            elif inspect.isfunction(value):
                parts += [heading(name, value, 3), body(value.__doc__)]
    return '\n\n'.join(part for part in parts if part) + '\n'


if __name__ == '__main__':
    text = page()
    if '--check' in sys.argv:
        with open(PAGE, encoding='utf-8') as file:
            if file.read() != text:
                sys.exit('docs/reference/python.md is not up to date: run tools/python_reference.py')
    else:
        with open(PAGE, 'w', encoding='utf-8') as file:
            file.write(text)
