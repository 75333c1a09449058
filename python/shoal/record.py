# SPDX-License-Identifier: BSD-3-Clause
"""Records of runs: LCM event logs, and MCAP files for writing."""
import os
from typing import NamedTuple

from . import _shoal, messages


class Event(NamedTuple):
    """An event of a record."""

    channel: str
    utime: int        # microseconds: epoch of the world + simulated time
    payload: bytes

    @property
    def message(self):
        """The message of the payload.  Raises Error when its type is unknown or it is not valid."""
        return messages.decode(self.payload)


def read(path, *channels):
    """Yields the events of an LCM event log, in its order; only those of `channels`, if any are given.

    Bytes that are not events are skipped, as in a log whose writer was killed.
    """
    log = _shoal.LogReader(os.fspath(path))
    for channel in channels:
        if not isinstance(channel, str):
            raise TypeError(f'a channel must be a str, got {channel!r}')
    while True:
        try:
            event = log.next(list(channels))
        except StopIteration:
            return
        yield Event(*event)


class RecordWriter:
    """Writer of a record; a name that ends with .mcap makes an MCAP file.  A context manager closes it."""

    def __init__(self, path, overwrite=False):
        self._own = _shoal.RecordWriter(os.fspath(path), overwrite)

    def write(self, channel, utime, message):
        """Writes a message with a time stamp in microseconds."""
        self._own.write(channel, utime, message.encode() if isinstance(message, messages.Message) else bytes(message))

    def close(self):
        """Completes the file.  Raises Error when it cannot be written."""
        self._own.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
