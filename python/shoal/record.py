# SPDX-License-Identifier: BSD-3-Clause
"""Records of runs: LCM event logs and MCAP files."""
from __future__ import annotations

import os
from typing import TYPE_CHECKING, Iterator, NamedTuple

import numpy as np

from . import _shoal, checks, messages
from .results import _table

if TYPE_CHECKING:
    from .results import Table


class Event(NamedTuple):
    """An event of a record.

    channel: its name
    utime: time stamp in microseconds: epoch of the world + simulated time
    payload: the encoded message
    """

    channel: str
    utime: int
    payload: bytes

    @property
    def message(self) -> messages.Message:
        """The message of the payload.  Raises Error when its type is unknown or it is not valid."""
        return messages.decode(self.payload)


class Record:
    """A record of a run as an iterator of its events: an LCM event log, or an MCAP file of Shoal by its name (.mcap).

    Bytes that are not events are skipped, as in a log whose writer was killed; `problems` has what was skipped.  Of an
    MCAP file the messages of Shoal are read, not those that repeat them in types of ROS 2.
    """

    def __init__(self, path: str | os.PathLike, *channels: str) -> None:
        """Opens the record at a path.

        channels: only their events are read; none: all.  At the end of the record a warning names those without any.

        Raises Error when the file cannot be read, or is not a record.
        """
        self._channels = [checks.text('read', 'a channel', channel) for channel in channels]
        self._path = checks.path('read', 'path', path)
        self._own = _shoal.RecordReader(self._path)
        self._warns = True

    def __iter__(self) -> Iterator[Event]:
        return self

    def __next__(self) -> Event:
        event = self._own.next(self._channels)
        if event is None:
            if self._warns:
                self._warns = False
                for text in self._missing():
                    _shoal.warn(text)
            raise StopIteration
        return Event(*event)

    def _missing(self):
        path = os.fsdecode(self._path)
        return [f'{path}: {text}' for text in self._own.missing(self._channels)]

    @property
    def problems(self) -> list[str]:
        """What was wrong with the file, as far as it was read."""
        return self._own.problems


def read(path: str | os.PathLike, *channels: str) -> Record:
    """Returns the events of the record at a path, in its order; only those of `channels`, if any are given."""
    return Record(path, *channels)


def table(path: str | os.PathLike, channel: str) -> Table:
    """Returns the messages of a channel of the record at a path: a DataFrame, or without pandas a dict of arrays.

    Its columns are `time_utime` (time stamp of the record in microseconds) and the members of the type; an array of
    fixed length has a column for each element, such as linear_acceleration_mps2_0, and one of variable length a column
    of arrays.
    Raises Error for a record without such messages, or with several types.
    """
    record = Record(path, channel)
    record._warns = False
    events = [(event.utime, event.message) for event in record]
    if not events:
        raise _shoal.Error(record._missing()[0])
    first = type(events[0][1])
    if any(type(message) is not first for _, message in events):
        raise _shoal.Error(f"{os.fspath(path)}: the messages on '{channel}' have several types")
    columns = {'time_utime': np.array([utime for utime, _ in events])}
    for name, type_name, dimensions, _, _ in first._members:
        values = [getattr(message, name) for _, message in events]
        if type_name in messages._NUMBERS and all(isinstance(size, int) for size in dimensions):
            rows = np.array(values).reshape(len(values), -1)
            for index in range(rows.shape[1]):
                columns[f'{name}_{index}' if dimensions else name] = rows[:, index]
        else:
            columns[name] = np.empty(len(values), object)
            columns[name][:] = values
    return _table(columns)


class RecordWriter:
    """Writer of a record; a name that ends with .mcap makes an MCAP file.  A context manager closes it."""

    def __init__(self, path: str | os.PathLike, overwrite: bool = False) -> None:
        """Creates the file of this path.

        Raises Error when it exists, unless `overwrite`, and when it cannot be created.
        """
        self._own = _shoal.RecordWriter(checks.path('RecordWriter', 'path', path), bool(overwrite))

    def write(self, channel: str, utime: int, message: messages.Message | bytes) -> None:
        """Writes a message.

        channel: 1 to 63 characters
        utime: time stamp in microseconds
        """
        self._own.write(checks.text('RecordWriter.write', 'channel', channel),
                        checks.integer('RecordWriter.write', 'utime', utime), messages.payload_of(message))

    def close(self) -> None:
        """Completes the file.  Raises Error when it cannot be written."""
        self._own.close()

    def __enter__(self) -> RecordWriter:
        return self

    def __exit__(self, *_) -> None:
        self.close()
