# SPDX-License-Identifier: BSD-3-Clause
"""The connection of a program to its vehicle."""
from __future__ import annotations

import atexit
import builtins
import sys
import threading
import weakref
from typing import Callable, Iterator, NamedTuple

from . import _shoal, checks, messages, yaml_text

_open: weakref.WeakSet[Client] = weakref.WeakSet()


class DeviceChannels(NamedTuple):
    """Channels of a device of a vehicle; '' for none.

    type: type of the device, such as 'planar_lidar'
    reports: channel of its reports
    report_type: their type, such as 'shoal.imu_t'
    rate_hz: reports per simulated second; 0: every step
    commands: channel of commands to it
    command_types: types that it takes, separated by commas
    """
    type: str
    reports: str
    report_type: str
    rate_hz: float
    commands: str
    command_types: str


class Client:
    """Connection of an autonomy program to a run, over LCM, for one thread.

        client = shoal.Client('pilot')
        client.subscribe('auv1.dvl', on_dvl)
        client.join(0.1)
        for utime in client.ticks():
            client.publish('auv1.autopilot.cmd', command)

    Handlers are called during next_tick(), wait_until() and ticks() only.  What a handler raises comes out of the
    waiting call.  A payload that is not valid is counted and reported on standard error, once for each channel.
    A context manager closes the client.  When an exception ends it, the thread of the client or the program, before the
    end of the run, the simulator warns with the name, the simulated time and the exception.  Without a context manager,
    a client whose exception is kept, as futures and tasks do, does not leave: the run waits until its time-out.
    """

    def __init__(self, name: str, lcm_url: str = '') -> None:
        """Opens the bus.

        name: under which the simulator waits for the program
        lcm_url: '' for LCM_DEFAULT_URL or LCM's default

        Raises Error when LCM cannot be used with this URL.
        """
        self._name = checks.text('Client', 'name', name)
        self._client: _shoal.Client | None = _shoal.Client(self._name, checks.text('Client', 'lcm_url', lcm_url))
        self._thread = threading.get_ident()
        _note_exceptions_of_threads()
        _open.add(self)

    @property
    def _own(self):
        if self._client is None:
            raise _shoal.Error('the client is closed')
        return self._client

    def subscribe(self, channel: str, handler: Callable[[messages.Message], object],
                  type: builtins.type[messages.Message] | str | None = None) -> None:
        """Calls handler(message) for each message of a channel.

        channel: a regular expression of channels, which are not checked: on a network others may publish on any
        type: class or name of the type that is accepted; None: the one that each message names
        """
        checks.text('Client.subscribe', 'channel', channel)
        checks.function('Client.subscribe', 'handler', handler)
        if isinstance(type, builtins.type) and issubclass(type, messages.Message):
            type = type._type
        if type is not None:
            checks.text('Client.subscribe', 'type', type)
        self._own.subscribe(channel, handler, type)

    def publish(self, channel: str, message: messages.Message | bytes) -> None:
        """Publishes a message; in lockstep it takes effect in the step after the tick."""
        self._own.publish(checks.text('Client.publish', 'channel', channel), messages.payload_of(message))

    def join(self, period_s: float, on_timeout: str = '', timeout_s: float = 0.0, wait_s: float = 30.0) -> None:
        """Joins the lockstep: the world waits for this program every `period_s` of simulated time.

        on_timeout: what the world does when the program does not answer in `timeout_s` of wall time: wait, pause,
            continue, end; '' and 0: as the world file says
        wait_s: how long to wait for a simulator

        Raises Error when the simulator refuses, or none answers.
        """
        self._own.join(checks.number('Client.join', 'period_s', period_s, 0, above=True),
                       checks.text('Client.join', 'on_timeout', on_timeout),
                       checks.number('Client.join', 'timeout_s', timeout_s, 0, 1e6),
                       checks.number('Client.join', 'wait_s', wait_s, 0))

    def spawn(self, text: str | dict, wait_s: float = 30.0) -> dict[str, DeviceChannels]:
        """Spawns a vehicle in a world in lockstep, and returns the channels of its devices by name.

        text: an entry of `vehicles:` as YAML or a dict, with the whole vehicle as `model` or a `file`; with
            `with_client: true` the vehicle is removed with this client
        wait_s: how long to wait for the reply, as the world may wait for another client

        The world waits: the vehicle is there when the present tick is answered, or the next one between ticks.
        Requests of clients in one step are carried out in the order of their names, so that the run is repeatable.

        Raises Error with the reason when the simulator refuses, the run ends or no reply comes.
        """
        if isinstance(text, dict):
            text = yaml_text.yaml_of('Client.spawn', text)
        channels = self._own.spawn(checks.text('Client.spawn', 'text', text),
                                   checks.number('Client.spawn', 'wait_s', wait_s, 0))
        return {device: DeviceChannels(*each) for device, each in channels.items()}

    def leave(self, wait_s: float = 30.0) -> None:
        """Answers the present tick and leaves the lockstep at the next one, so that the run is repeatable.

        wait_s: how long to wait for that tick; afterwards the client leaves without it, as close() does

        Vehicles of spawn() with `with_client: true` are removed.
        """
        self._own.leave(checks.number('Client.leave', 'wait_s', wait_s, 0))

    def follow(self, period_s: float) -> None:
        """Follows a run without lockstep: next_tick() returns when sim.clock passes a multiple of `period_s`."""
        self._own.follow(checks.number('Client.follow', 'period_s', period_s, 0, above=True))

    def next_tick(self) -> int | None:
        """Answers the last tick, waits for the next one and returns its simulated time in microseconds.

        Returns None when the run is over; see `end`.
        """
        return self._own.next_tick()

    def wait_until(self, utime: int) -> int | None:
        """Handles ticks up to the first one at or after a time in microseconds; returns as next_tick() does."""
        return self._own.wait_until(checks.integer('Client.wait_until', 'utime', utime))

    def ticks(self) -> Iterator[int]:
        """Yields the simulated time of each tick, in microseconds, until the run is over."""
        next_tick = self._own.next_tick
        while (utime := next_tick()) is not None:
            yield utime

    def on_rewind(self, handler: Callable[[int], object]) -> None:
        """Calls handler(utime) when the world was rewound to a time; without a handler the run is then over."""
        checks.function('Client.on_rewind', 'handler', handler)
        self._own.on_rewind(handler)

    def stop(self) -> None:
        """Makes next_tick() return None, for good; any thread may call it."""
        self._own.stop()

    def close(self) -> None:
        """Leaves the lockstep and the bus.  The client cannot be used afterwards."""
        _open.discard(self)
        self._client = None

    def set_silence_limit(self, seconds: float) -> None:
        """Sets after how much wall time without any message the run counts as over; 0: never.  600 s at first."""
        self._own.set_silence_limit(checks.number('Client.set_silence_limit', 'seconds', seconds, 0))

    def set_wait_warning(self, seconds: float) -> None:
        """Sets after how much wall time of waiting a line on standard error says so; 0: never.  3 s at first."""
        self._own.set_wait_warning(checks.number('Client.set_wait_warning', 'seconds', seconds, 0))

    @property
    def end(self) -> str:
        """Why the run is over: last_tick, stopped, silence, rewound, dropped, left; '' while it continues."""
        return self._own.end

    @property
    def reason(self) -> str:
        """Reason that the simulator gave when it dropped this program."""
        return self._own.reason

    @property
    def branch(self) -> int:
        """Number of rewinds before the present tick."""
        return self._own.branch

    @property
    def counts(self) -> dict[str, int]:
        """Numbers of messages: received, bad, published, requested, repeated."""
        return self._own.counts

    def __enter__(self) -> Client:
        return self

    def __exit__(self, _kind, error, _traceback) -> None:
        if error is not None:
            self._note(error)
        self.close()

    def _note(self, error):
        """Sets the exception for which it leaves a run that has not ended; sys.exit() is none."""
        if self._client is None or isinstance(error, GeneratorExit):
            return
        if isinstance(error, SystemExit) and not error.code:
            return
        text = str(error)
        self._client.set_reason_to_leave(type(error).__name__ + (f': {text}' if text else ''))


@atexit.register
def _note_exception_of_program():
    """Gives the clients that are still open the exception that ends the program, if one does."""
    error = getattr(sys, 'last_value', None)
    for client in list(_open) if error is not None else []:
        client._note(error)


def _note_exceptions_of_threads():
    """Makes each exception that ends a thread known to the clients that were made in it."""
    before = threading.excepthook
    if getattr(before, 'notes_clients', False):
        return

    def hook(args):
        for client in list(_open):
            if args.thread is not None and client._thread == args.thread.ident and args.exc_value is not None:
                client._note(args.exc_value)
        before(args)

    setattr(hook, 'notes_clients', True)
    threading.excepthook = hook


def unanswered(text: str) -> str:
    """Returns a hint for the error of a run that names a client of this process which does not answer."""
    for client in list(_open):
        if f"'{client._name}'" in text:
            return (f"; '{client._name}' is a client of this process that is still open: when its program ended by an "
                    "exception, a future or task has it, and 'with shoal.Client(...)' would have left the run")
    return ''
