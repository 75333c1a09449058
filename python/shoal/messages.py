# SPDX-License-Identifier: BSD-3-Clause
"""Message classes of all types of Shoal: `shoal.messages.imu_t`, and so on.

A class is made when it is first used.  Its objects have the members of the type as attributes; `help(imu_t)` lists them
with units.  Arrays of numbers are NumPy arrays in the byte order of the machine; those of bytes, such as the pixels of
an image, are read-only views of the received payload.  Members that are the length of an array need not be set.

The classes have encode() and decode() as those that lcm-gen makes of the .lcm files, which have lists, tuples and bytes
instead of arrays.
"""
from __future__ import annotations

from typing import IO as _IO, Any as _Any

import numpy as _np

from . import _shoal
from .checks import shown as _shown

_NUMBERS = {'boolean': '?', 'byte': 'u1', 'int8_t': 'i1', 'int16_t': 'i2', 'int32_t': 'i4', 'int64_t': 'i8',
            'float': 'f4', 'double': 'f8'}
_ZERO = {'boolean': False, 'float': 0.0, 'double': 0.0, 'string': ''}


class Message:
    """Base class of all message classes."""

    __slots__ = ()
    _type = ''      # full name, such as shoal.imu_t
    _members = ()   # tuples of name, type, dimensions, comment, whether it is the length of an array

    def __init__(self, **values: _Any) -> None:
        """Sets members by name; the others become zero, empty or false.  Raises TypeError for an unknown name."""
        for name, type_name, dimensions, _, _ in self._members:
            if name in values:
                setattr(self, name, values.pop(name))
            else:
                setattr(self, name, _zero(type_name, dimensions))
        if values:
            raise TypeError(f'{type(self).__name__} has no member {", ".join(sorted(values))!r}')

    def encode(self) -> bytes:
        """Returns the payload as bytes.  Raises shoal.Error for values that the type cannot hold."""
        return _shoal.encode(self._type, self)

    @classmethod
    def decode(cls, payload: bytes | _IO[bytes]) -> Message:
        """Returns the message of a payload, bytes or a file that has it.  Raises shoal.Error when it is not valid."""
        return _shoal.decode(cls._type, _bytes_of(payload.read() if hasattr(payload, 'read') else payload))

    @classmethod
    def get_hash(cls) -> int:
        """Returns the fingerprint of the type, with which its payloads begin."""
        return _shoal.message_type(cls._type)[3]

    @classmethod
    def _get_packed_fingerprint(cls):
        return cls.get_hash().to_bytes(8, 'big')

    def __eq__(self, other):
        if type(other) is not type(self):
            return NotImplemented
        return all(_equal(getattr(self, name), getattr(other, name)) for name, *_ in self._members)

    __hash__ = None

    def __repr__(self):
        values = ', '.join(f'{name}={getattr(self, name)!r}' for name, *_ in self._members if hasattr(self, name))
        return f'{type(self).__name__}({values})'

    def __reduce__(self):
        return _restore, (self._type, self.encode())


def decode(payload: bytes) -> Message:
    """Returns the message of a payload, of the type that its first eight bytes name.  Raises shoal.Error."""
    return _shoal.decode_any(_bytes_of(payload))


def payload_of(message: Message | bytes) -> bytes:
    """Returns the payload of a message: of an object with encode(), also one of lcm-gen's, or bytes as they are."""
    if isinstance(message, (bytes, bytearray, memoryview)):
        return bytes(message)
    if isinstance(message, str) or not callable(getattr(message, 'encode', None)):
        raise TypeError(f'a message is an object with encode(), or bytes, got {_shown(message)}')
    return message.encode()


def types() -> list[str]:
    """Returns the names of all types, such as `imu_t`."""
    return sorted(name.rpartition('.')[2] for name in _shoal.message_types())


def _bytes_of(payload):
    if isinstance(payload, bytes):
        return payload
    if isinstance(payload, (bytearray, memoryview, _np.ndarray)):
        return bytes(payload)
    raise TypeError(f'a payload is bytes, got {_shown(payload)}')


def _restore(name, payload):
    return _shoal.decode(name, payload)


def _equal(one, other):
    if isinstance(one, _np.ndarray) or isinstance(other, _np.ndarray):
        return _np.array_equal(one, other, equal_nan=_np.asarray(one).dtype.kind == 'f')
    return one == other or (one != one and other != other)


def _zero(type_name, dimensions):
    """Returns what a member is when it is not set."""
    if not dimensions:
        if type_name in _NUMBERS or type_name == 'string':
            return _ZERO.get(type_name, 0)
        return _make(type_name)()
    shape = [0 if isinstance(size, str) else size for size in dimensions]
    if type_name in _NUMBERS:
        return _np.zeros(shape, _NUMBERS[type_name])

    def rows(sizes):
        if not sizes:
            return _zero(type_name, [])
        return [rows(sizes[1:]) for _ in range(sizes[0])]
    return rows(shape)


_classes = {}


def _make(name):
    """Returns the class of a type, which is made once."""
    full, comment, members, _ = _shoal.message_type(name)
    if full in _classes:
        return _classes[full]
    lines = [comment or f'Message of the type {full}.', '']
    for member, type_name, dimensions, text, _ in members:
        size = ''.join(f'[{each}]' for each in dimensions)
        lines.append(f'{member}: {type_name}{size}' + (f'  {text}' if text else ''))
    made = type(full.rpartition('.')[2], (Message,),
                {'__slots__': tuple(member[0] for member in members), '__doc__': '\n'.join(lines),
                 '__module__': __name__, '_type': full, '_members': tuple(members)})
    _classes[full] = made
    return made


_shoal.set_class_maker(_make)


def __getattr__(name):
    if not name.startswith('_'):
        try:
            return _make(name)
        except _shoal.Error:
            pass
    raise AttributeError(f"module 'shoal.messages' has no attribute {name!r}; types() lists all message types")


def __dir__():
    return ['Message', 'decode', 'payload_of', 'types', *types()]
