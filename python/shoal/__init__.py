# SPDX-License-Identifier: BSD-3-Clause
"""Shoal, a simulator of many vehicles, for Python.

World      a world in this process: step it, read its sensors, save and restore it
Client     the connection of a program to a vehicle of a run, over LCM
run        runs a world to its end, as `shoal run` does
read       the messages of a record; write_record writes one
messages   a class for each type of message
results    tracks and errors of a results folder; plots draws them
vector     many worlds at once, with the interfaces of Gymnasium and PettingZoo
Error      what all of these raise for input that they refuse

Distances are in metres, angles in radians, times in seconds, unless a name says otherwise (`utime` is in microseconds).
World axes are east, north, up; vehicle axes are forward, left, up.
"""
import os as _os
import sys as _sys

# Plugins of worlds use symbols of the module, as they use those of the program.
_flags = _sys.getdlopenflags()
_sys.setdlopenflags(_flags | _os.RTLD_GLOBAL)
try:
    from . import _shoal
finally:
    _sys.setdlopenflags(_flags)

from . import messages, plots, results, vector
from ._shoal import Error
from .client import Client
from .record import RecordWriter, read
from .run import Run, run
from .world import World

__all__ = ['Client', 'Error', 'RecordWriter', 'Run', 'World', 'messages', 'plots', 'read', 'results', 'run', 'vector']
__version__ = _shoal.short_version()
