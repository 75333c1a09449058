# SPDX-License-Identifier: BSD-3-Clause
"""Shoal, a simulator of many vehicles, for Python.

World      a world in this process: step it, read its sensors, save and restore it
Client     the connection of a program to a vehicle of a run, over LCM
run        runs a world to its end, as `shoal run` does; study runs a study
read       the messages of a record, table those of a channel as columns; RecordWriter writes a record
messages   a class for each type of message; shoal.imu_t is the same as shoal.messages.imu_t
results    tracks and errors of a results folder; plots draws them
vector     many worlds at once, with the interfaces of Gymnasium and PettingZoo
Error      what all of these raise for input that they refuse

Distances are in meters, angles in radians, times in seconds, unless a name says otherwise (`utime` is in microseconds).
World axes are east, north, up; vehicle axes are forward, left, up.
"""
import os as _os
import sys as _sys

try:
    import numpy as _numpy
except ImportError as _error:
    raise ImportError('shoal needs NumPy: install the Debian package python3-numpy (for /usr/bin/python3; this is '
                      f'{_sys.executable}: {_error})') from None

# Plugins of worlds use symbols of the module, as they use those of the program.
_flags = _sys.getdlopenflags()
_sys.setdlopenflags(_flags | _os.RTLD_GLOBAL)
try:
    from . import _shoal
finally:
    _sys.setdlopenflags(_flags)

from . import messages, plots, results, vector
from ._shoal import Error
from .client import Client, DeviceChannels
from .record import Event, Record, RecordWriter, read, table
from .run import Run, Study, run, study
from .world import Subscription, World, set_log_level

__all__ = ['Client', 'DeviceChannels', 'Error', 'Event', 'Record', 'RecordWriter', 'Run', 'Study', 'Subscription',
           'World', 'messages', 'plots', 'read', 'results', 'run', 'set_log_level', 'study', 'table', 'vector']
__version__: str = _shoal.short_version()


def __getattr__(name):
    """Finds the classes of messages here too, where the package that lcm-gen makes has them."""
    if name.endswith('_t'):
        return getattr(messages, name)
    raise AttributeError(f"module 'shoal' has no attribute {name!r}")
