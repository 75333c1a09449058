# SPDX-License-Identifier: BSD-3-Clause
"""Writes the type stubs of the parts of the package that exist only when it runs: the classes of messages.

    PYTHONPATH=build/release/lib/python /usr/bin/python3 -P python/make_stubs.py build/release/lib/python/shoal
"""
import os
import sys

from shoal import messages

NUMBERS = {'boolean': 'np.bool_', 'byte': 'np.uint8', 'int8_t': 'np.int8', 'int16_t': 'np.int16', 'int32_t': 'np.int32',
           'int64_t': 'np.int64', 'float': 'np.float32', 'double': 'np.float64'}
SCALARS = {'boolean': 'bool', 'float': 'float', 'double': 'float', 'string': 'str'}
HEAD = '''# SPDX-License-Identifier: BSD-3-Clause
# Made by python/make_stubs.py.
from typing import Any

import numpy as np
import numpy.typing as npt

_NUMBERS: dict[str, str]

class Message:
    """Base class of all message classes."""
    _type: str
    _members: tuple[tuple[str, str, list[int | str], str, bool], ...]
    def __init__(self, **values: Any) -> None: ...
    def encode(self) -> bytes: ...
    @classmethod
    def decode(cls, payload: Any) -> Message: ...
    @classmethod
    def get_hash(cls) -> int: ...

def decode(payload: bytes) -> Message: ...
def payload_of(message: Message | bytes) -> bytes: ...
def types() -> list[str]: ...
'''
PACKAGE = '''# SPDX-License-Identifier: BSD-3-Clause
# Made by python/make_stubs.py.
from . import messages as messages, plots as plots, results as results, vector as vector
from ._shoal import Error as Error
from .client import Client as Client, DeviceChannels as DeviceChannels
from .messages import (
{messages}
)
from .record import Event as Event, Record as Record, RecordWriter as RecordWriter, read as read, table as table
from .run import Run as Run, Study as Study, run as run, study as study
from .world import Subscription as Subscription, World as World, set_log_level as set_log_level

__version__: str
'''


def types_of(type_name, dimensions):
    """Returns the type of a member when it is read, and when it is set."""
    if dimensions and type_name in NUMBERS:
        return f'npt.NDArray[{NUMBERS[type_name]}]', 'npt.ArrayLike'
    scalar = SCALARS.get(type_name) or ('int' if type_name in NUMBERS else type_name.rpartition('.')[2])
    for _ in dimensions:
        scalar = f'list[{scalar}]'
    return scalar, scalar


def class_of(name):
    """Returns the text of the stub of a class."""
    made = getattr(messages, name)
    lines, arguments = [f'class {name}(Message):', f'    """{made.__doc__.splitlines()[0]}"""'], []
    for member, type_name, dimensions, text, _ in made._members:
        read, written = types_of(type_name, dimensions)
        lines.append(f'    {member}: {read}' + (f'  # {text}' if text else ''))
        arguments.append(f'{member}: {written} = ...')
    star = ['*'] if arguments else []
    lines += [f'    def __init__({", ".join(["self", *star, *arguments])}) -> None: ...', '    @classmethod',
              f'    def decode(cls, payload: Any) -> {name}: ...']
    return '\n'.join(lines) + '\n'


def main(folder):
    names = messages.types()
    with open(os.path.join(folder, 'messages.pyi'), 'w', encoding='utf-8') as file:
        file.write('\n'.join([HEAD, *map(class_of, names)]))
    with open(os.path.join(folder, '__init__.pyi'), 'w', encoding='utf-8') as file:
        file.write(PACKAGE.format(messages='\n'.join(f'    {name} as {name},' for name in names)))


if __name__ == '__main__':
    main(sys.argv[1])
