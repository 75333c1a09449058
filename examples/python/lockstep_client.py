# SPDX-License-Identifier: BSD-3-Clause
"""A client in lockstep with the simulator, over a network that may lose messages, in Python:
docs/develop/lockstep_protocol.md.

    PYTHONPATH=build/release/python:examples/python python3 examples/python/lockstep_client.py rover1

drives rover1 of worlds/minimal.yaml towards the wall, and stops before it.
"""
import binascii
import hashlib
import hmac
import itertools
import os
import random
import struct
import sys
import time

import shoal

try:
    import lcm
except ImportError:  # Debian 12 has no package for it
    import small_lcm as lcm

SILENCE_S = 600
NOTICE_S = 3


class Signer:
    """Signs requests that control a run, with the key in SHOAL_RUN_KEY: docs/guides/access_control.md."""

    def __init__(self, name):
        self.key, self.name = bytes.fromhex(os.environ.get("SHOAL_RUN_KEY", "")), name
        self.session = random.SystemRandom().randrange(1 << 63)
        self.counter = itertools.count(time.time_ns() // 1000)

    def __call__(self, channel, data):
        """Returns the payload to publish instead of `data`."""
        if not self.key:
            return data
        signed = shoal.sim_signed_t()
        signed.session, signed.sender, signed.counter = self.session, self.name, next(self.counter)
        signed.size, signed.content, signed.mac = len(data), data, bytes(32)
        before = signed.encode()[:-32]
        return before + hmac.new(self.key, channel.encode() + b"\0" + before, hashlib.sha256).digest()


class LockstepClient:
    """Subscribe, then run(): it joins, and calls decide(utime) at each tick, when all messages were handled."""

    def __init__(self, name, period_s, terms=""):
        """`terms`: further options of the join request, such as `, on_timeout: pause, timeout_s: 2`."""
        self.lc, self.sign = lcm.LCM(), Signer(name)
        self.name, self.period_s, self.terms = name, period_s, terms
        self.session = random.SystemRandom().randrange(1, 1 << 53)
        self.id = self.session & 0x7fffffff
        self.receives, self.handlers = [], []
        self.held = []  # [channel, CRC, payload] received, and not yet listed by a tick
        self.tick = None  # waits for messages
        self.sequence = self.branch = 0  # of the last tick that was handled
        self.published = []
        self.ack = shoal.sim_ack_t()  # before the first tick it only reports that the client is alive
        self.ack.client, self.ack.session, self.ack.listed = name, self.session, True
        self.joined = self.over = False
        self.decide = lambda utime: None
        self.protocol = {"sim.control.reply": self.on_reply, "sim.tick": self.on_tick,
                         "sim.resend": self.on_resend, "sim.resent": self.on_resent}
        for channel, handler in self.protocol.items():
            self.lc.subscribe(channel.replace(".", "\\."), self.only_valid(handler))

    @staticmethod
    def only_valid(handler):
        """Handles a message.  Any program may publish anything: messages of another type are ignored."""
        def handle(channel, data):
            try:
                if shoal.sim_signed_t._get_packed_fingerprint() != data[:8]:  # from another client
                    handler(channel, data)
            except (ValueError, struct.error, IndexError) as error:
                print(f"{channel}: {error!r} (ignored)", file=sys.stderr)
        return handle

    def subscribe(self, channel, message, handler):
        if channel not in self.receives:
            self.receives.append(channel)
            self.handlers.append([])
            number = len(self.receives) - 1
            self.lc.subscribe(channel.replace(".", "\\."),
                              lambda _, data: self.held.append([number, binascii.crc32(data), data]))
        self.handlers[self.receives.index(channel)].append(lambda data: handler(message.decode(data)))

    def publish(self, channel, message):
        """Publishes a message; to be called from a handler or from decide()."""
        data = message.encode()
        self.published.append((channel, binascii.crc32(data), data))
        self.lc.publish(channel, data)

    def send(self, channel, message):
        self.lc.publish(channel, self.sign(channel, message.encode()))

    def run(self):
        notice = time.monotonic() + NOTICE_S
        while not self.joined:  # the simulator may start later than the client
            if notice and time.monotonic() > notice:
                print(f"'{self.name}' waits for a simulator to answer its join on 'sim.control.reply', at "
                      f"{os.environ.get('LCM_DEFAULT_URL', 'the default LCM URL')}", file=sys.stderr)
                notice = None
            request = shoal.sim_control_request_t()
            request.id, request.client, request.command = self.id, self.name, "join"
            request.value = self.period_s
            request.text = f"{{session: {self.session}, receives: {self.receives}{self.terms}}}"
            self.send("sim.control", request)
            again = time.monotonic() + 0.2
            while not self.joined and time.monotonic() < again:
                self.lc.handle_timeout(max(1, round(1000 * (again - time.monotonic()))))
        self.held.clear()  # addressed to a client before it joined the lockstep
        received, pause_s = time.monotonic(), 0.001
        while not self.over:
            if self.lc.handle_timeout(1000 * pause_s if self.tick else 1000):
                received = time.monotonic()
            elif time.monotonic() - received > SILENCE_S:
                raise SystemExit("the simulator fell silent")
            elif self.tick:
                self.send_request()
                pause_s = min(max(0.02, 2 * pause_s), 0.25)
            if self.tick and self.has_all():
                self.handle()
                pause_s = 0.001

    def on_reply(self, channel, data):
        reply = shoal.sim_control_reply_t.decode(data)
        # A reply to an unreadable request has no session; other clients of the same name have another one.
        ours = reply.session == self.session or (reply.session == 0 and not self.joined)
        if reply.client == self.name and reply.id == self.id and ours:
            if not reply.ok:  # rejected, or later: the world continued without this client
                raise SystemExit(reply.text)
            self.joined = True

    def on_tick(self, channel, data):
        tick = shoal.sim_tick_t.decode(data)
        own = [due for due in tick.client if due.name == self.name and due.session == self.session]
        if not own:
            return  # also a last one: the end of another run
        if own[0].sequence == self.sequence:
            self.send("sim.ack", self.ack)  # the answer was lost, or the simulator checks whether the client is alive
        elif own[0].sequence > (self.due.sequence if self.tick else self.sequence):  # replaces an older one
            if tick.branch != self.branch and self.sequence > 0:
                raise SystemExit("the world went back in time")
            if any(not 0 <= channel < len(self.receives) for channel in own[0].channel):
                return  # not a requested message
            self.tick, self.due, self.branch = tick, own[0], tick.branch
            self.messages = [None] * own[0].count

    def has_all(self):
        for place, (channel, crc) in enumerate(zip(self.due.channel, self.due.crc)):
            if self.messages[place] is None:
                found = next((each for each in self.held if each[:2] == [channel, crc]), None)
                if found:
                    self.messages[place] = found[2]
                    self.held.remove(found)
        return None not in self.messages

    def send_request(self):
        question = shoal.sim_resend_t()
        question.client, question.session, question.sequence = self.name, self.session, self.due.sequence
        question.of_client, question.first = False, self.messages.index(None)
        self.send("sim.resend", question)

    def on_resent(self, channel, data):
        bundle = shoal.sim_resent_t.decode(data)
        if (self.tick and not bundle.of_client and bundle.session == self.session
                and bundle.sequence == self.due.sequence):
            for place, message in enumerate(bundle.message, bundle.first):
                if 0 <= place < len(self.messages) and binascii.crc32(message.data) == self.due.crc[place]:
                    self.messages[place] = bytes(message.data)

    def handle(self):
        tick, messages, channels = self.tick, self.messages, self.due.channel
        self.tick, self.sequence, self.published = None, self.due.sequence, []
        for channel, data in zip(channels, messages):
            for handler in self.handlers[channel]:
                handler(data)
        # A message that no tick lists was duplicated, or is from a sender that the simulator does not receive.
        del self.held[:-1000]
        self.over = bool(tick.last)
        if not self.over:
            self.decide(tick.utime)
        self.ack = shoal.sim_ack_t()
        self.ack.utime, self.ack.step, self.ack.client = tick.utime, tick.step, self.name
        self.ack.session, self.ack.sequence, self.ack.listed = self.session, self.sequence, True
        self.ack.count = len(self.published)
        self.ack.channel = [channel for channel, _, _ in self.published]
        self.ack.crc = [crc for _, crc, _ in self.published]
        self.send("sim.ack", self.ack)

    def on_resend(self, channel, data):
        question = shoal.sim_resend_t.decode(data)
        if not question.of_client or question.session != self.session or question.sequence != self.sequence:
            return
        for place in range(max(0, question.first), len(self.published)):
            bundle, message = shoal.sim_resent_t(), shoal.sim_payload_t()
            bundle.client, bundle.session, bundle.sequence = self.name, self.session, self.sequence
            bundle.of_client, bundle.first, bundle.count = True, place, 1
            message.channel, _, message.data = self.published[place]
            message.size = len(message.data)
            bundle.message = [message]
            self.send("sim.resent", bundle)


class Pilot:
    """Drives towards what is ahead, and stops one meter before it."""

    def __init__(self, vehicle):
        self.vehicle, self.ahead_m = vehicle, 0.0
        self.client = LockstepClient("pilot", 0.1)
        self.client.subscribe(vehicle + ".lidar", shoal.planar_lidar_t, self.on_lidar)
        self.client.decide = self.decide

    def on_lidar(self, scan):
        self.ahead_m = scan.ranges[scan.nranges // 2]

    def decide(self, utime):
        command = shoal.twist_command_t()
        command.utime = utime
        command.forward_mps = 0.5 if self.ahead_m > 1.0 else 0.0
        self.client.publish(self.vehicle + ".drive.cmd", command)


if __name__ == "__main__":
    pilot = Pilot(sys.argv[1] if len(sys.argv) > 1 else "rover1")
    pilot.client.run()
    print(f"the run is over, {pilot.ahead_m:.2f} m before the wall")
