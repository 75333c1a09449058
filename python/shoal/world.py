# SPDX-License-Identifier: BSD-3-Clause
"""A world in this process."""
from __future__ import annotations

import os
from typing import Any, Iterator, Sequence

import numpy as np

from . import _shoal, checks, messages
from .yaml_text import yaml_of


#: The most threads that a world or a set of worlds may use.
MAX_THREADS = 256


class Subscription:
    """Unread messages of one channel; World.subscribe makes it.  To iterate over it is to take them."""

    def __init__(self, own) -> None:
        self._own = own

    @property
    def channel(self) -> str:
        """Name of the channel."""
        return self._own.channel

    @property
    def dropped(self) -> int:
        """Number of messages that were lost because the queue was full."""
        return self._own.dropped

    def take(self) -> list[messages.Message | bytes]:
        """Removes and returns the unread messages, oldest first; of an unknown type their payloads."""
        return self._own.take()

    def __iter__(self) -> Iterator[messages.Message | bytes]:
        return iter(self.take())


class World:
    """A world that this program steps; it has no network.

    Its hashes are those of `shoal run --bus none` with the same file, seed and inputs.  A world may be used by one
    thread at a time; several worlds may be stepped in several threads, because steps release the GIL (contacts of meshes
    are found by one thread at a time).
    """

    def __init__(self, world: str | os.PathLike | dict, *, seed: int | None = None, set: dict | None = None) -> None:
        """Loads a world.

        world: path of a world file, name of one in the working directory or of a shipped one, or a dict with its keys;
            files that the dict names are relative to the working directory
        seed: instead of that of the file
        set: dict of dotted paths and values, as with --set, such as {'physics.step_s': 0.005}

        Raises Error with all errors found, one line each.
        """
        if isinstance(world, _shoal.World):
            self._own = world
            return
        file, text, sets = _source('World', world, set)
        if seed is not None:
            seed = checks.integer('World', 'seed', seed, 0)
        self._own = _shoal.World(file, text=text, seed=seed, sets=sets)

    # --- About the world

    @property
    def name(self) -> str:
        """Name of the world."""
        return self._own.name

    @property
    def description(self) -> str:
        """Description of the world."""
        return self._own.description

    @property
    def seed(self) -> int:
        """Seed of all random numbers."""
        return self._own.seed

    @property
    def step_s(self) -> float:
        """Length of a step in s."""
        return self._own.step_s

    @property
    def duration_s(self) -> float:
        """Length of a run in s, as the file says; 0: unlimited."""
        return self._own.duration_s

    @property
    def step_number(self) -> int:
        """Number of steps since the start."""
        return self._own.step_number

    @property
    def time_s(self) -> float:
        """Simulated time in s."""
        return self._own.time_s

    @property
    def utime(self) -> int:
        """Time stamp of messages in microseconds: epoch of the world + simulated time."""
        return self._own.utime

    @property
    def ended(self) -> str | None:
        """Why an event of the world ended the run; None while it may continue."""
        return self._own.ended

    @property
    def vehicles(self) -> list[str]:
        """Names of the vehicles."""
        return self._own.vehicles()

    @property
    def objects(self) -> list[str]:
        """Names of the objects."""
        return self._own.objects()

    def devices(self, vehicle: str) -> list[str]:
        """Returns the names of the devices of a vehicle, such as `auv1/imu`."""
        return self._own.devices(checks.text('World.devices', 'vehicle', vehicle))

    def channels(self) -> dict[str, str]:
        """Returns the channels on which something was published, and the types of their messages; '': unknown."""
        return self._own.channels()

    # --- Time

    def step(self, count: int = 1) -> int:
        """Takes steps; returns their number, which is less than `count` when an event of the world ends the run."""
        if type(count) is not int or not 0 <= count < 2**63:
            count = checks.integer('World.step', 'count', count, 0)
        return self._own.step(count)

    def run_until(self, time_s: float) -> float:
        """Takes steps up to the first one that ends at this time or later; returns the time in s."""
        return self._own.run_until(checks.number('World.run_until', 'time_s', time_s, 0))

    # --- Truth

    def state(self, vehicle: str) -> np.void:
        """Returns the true motion of a vehicle: one element of states()."""
        return self._own.states([checks.text('World.state', 'vehicle', vehicle)])[0]

    def states(self, vehicles: str | Sequence[str] | None = None) -> np.ndarray:
        """Returns the true motions as a structured array, shape (n,), in the order of the names.

        vehicles: names, or one name; None: all

        Fields:

        position_m: (3,), origin of the vehicle in world axes
        orientation: (4,), quaternion w, x, y, z from vehicle to world axes, w >= 0
        velocity_mps: (3,), of that origin, in world axes
        rates_radps: (3,), angular velocity in vehicle axes
        """
        return self._own.states(None if vehicles is None else checks.names('World.states', 'vehicles', vehicles))

    def joints(self, vehicle: str) -> dict[str, float]:
        """Returns a dict of the joints of a vehicle and their positions: rad, or m for a slider."""
        return self._own.joints(checks.text('World.joints', 'vehicle', vehicle))

    # --- Messages

    def last(self, channel: str) -> messages.Message | bytes | None:
        """Returns the last message on a channel, of an unknown type its payload; None before the first.

        Raises Error for a channel that is not in the world and whose name is close to another; any other unknown name,
        which may be one for messages of this program, gets one warning.
        """
        return self._own.last(checks.text('World.last', 'channel', channel))

    def subscribe(self, channel: str, capacity: int = 1000) -> Subscription:
        """Returns a Subscription of a channel; when more messages than `capacity` wait in it, the oldest are lost.

        Raises Error as last() does.
        """
        return Subscription(self._own.subscribe(checks.text('World.subscribe', 'channel', channel),
                                                checks.integer('World.subscribe', 'capacity', capacity, 1)))

    def publish(self, channel: str, message: messages.Message | bytes) -> None:
        """Publishes a message on a channel; devices get it in the next step.

        Raises Error when it is not valid, when the device of the channel takes other types or no NaN, and as last()
        when there is no reader of the channel: no device, metric or event of the world, and no subscription.
        """
        self._own.publish(checks.text('World.publish', 'channel', channel), messages.payload_of(message))

    # --- Changes

    def do(self, action: dict | Sequence[dict]) -> None:
        """Executes an action, or a list of actions, as `do:` of an event has them: {'gravity_mps2': 1.62}."""
        self._own.act(yaml_of('World.do', action))

    def fault(self, device: str, kind: str, **values: Any) -> None:
        """Gives a device such as `auv1/imu` a fault; `kind` and `values` as in the action `fault`."""
        self.do({'fault': {'device': device, 'kind': kind, **values}})

    def clear_fault(self, device: str) -> None:
        """Ends the faults of a device."""
        self.do({'clear_fault': {'device': device}})

    def spawn(self, **entry: Any) -> list[str]:
        """Adds the vehicles of an entry of `vehicles:`; returns their names.

        spawn(name='r9', file='rover.yaml', position_m=[2, 0, 0])
        """
        return self._own.spawn(yaml_of('World.spawn', entry))

    def remove(self, name: str) -> None:
        """Removes a vehicle or an object."""
        self._own.remove(checks.text('World.remove', 'name', name))

    # --- State

    def snapshot(self) -> bytes:
        """Returns the whole state as bytes."""
        return self._own.snapshot()

    def restore(self, snapshot: bytes) -> None:
        """Goes back (or on) to a snapshot of a world of the same file, seed and settings.

        The run then continues bit by bit as from the snapshot.  Unread messages of subscriptions are dropped.
        """
        if not isinstance(snapshot, bytes):
            raise TypeError(f'World.restore: snapshot must be bytes, got {checks.shown(snapshot)}')
        self._own.restore(snapshot)

    def branch(self) -> World:
        """Returns another world in the same state; both then continue independently."""
        return World(self._own.branch())

    def state_hash(self) -> int:
        """Returns the hash of the whole state, as `shoal run` prints it."""
        return self._own.state_hash()

    def run_hash(self) -> int:
        """Returns the hash of the whole run up to now, as `shoal run` prints it."""
        return self._own.run_hash()

    def use_threads(self, threads: int) -> None:
        """Sets the number of threads for sensors that cast rays, up to 256; 1 at first, 0: one for each processor."""
        self._own.use_threads(checks.integer('World.use_threads', 'threads', threads, 0, MAX_THREADS))

    def __repr__(self) -> str:
        return f'<shoal.World {self.name} at {self.time_s:g} s, {len(self.vehicles)} vehicles>'

    def _repr_html_(self) -> str:
        from .html import world_table
        return world_table(self)


def set_log_level(level: str) -> None:
    """Sets which messages of worlds and runs appear on standard error: debug, info, warn (at first), error or off.

    Raises Error for another level.
    """
    _shoal.set_log_level(checks.text('set_log_level', 'level', level))


def _source(who, world, set):
    """Returns file, text or None, and settings of a world for the module."""
    if not isinstance(world, (dict, str, os.PathLike)):
        raise TypeError(f'{who}: world must be a path or a dict, got {checks.shown(world)}')
    if not isinstance(set, (dict, type(None))):
        raise TypeError(f'{who}: set must be a dict, got {checks.shown(set)}')
    sets = [f"{checks.text(who, 'a path of set', path)}={yaml_of(who, value)}" for path, value in (set or {}).items()]
    if isinstance(world, dict):
        return 'world', yaml_of(who, world), sets
    return _shoal.world_file(checks.path(who, 'world', world)), None, sets
