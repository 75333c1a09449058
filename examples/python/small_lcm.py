# SPDX-License-Identifier: BSD-3-Clause
"""As much of LCM's Python package as the examples use, for machines that have none: UDP multicast.

A short message is one datagram: magic, number and channel, then the payload.  A long one comes in parts: magic, number,
size of the payload, place of the part in it, number of the part, how many there are, in the first part the channel, and
the part.  Long messages are received, not sent.
"""
import os
import re
import select
import socket
import struct

SHORT, PART = 0x4C433032, 0x4C433033
LONGEST = 65499  # channel and payload of a short message
DEFAULT_URL = "udpm://239.255.76.67:7667"


class LCM:
    def __init__(self, url=None):
        url = url or os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL
        group, port, options = re.match(r"udpm://([\d.]+):(\d+)(.*)", url).groups()
        ttl = re.search(r"[?&]ttl=(\d+)", options)
        self.address = (group, int(port))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, int(ttl[1]) if ttl else 0)
        self.socket.bind(self.address)
        membership = struct.pack("4sL", socket.inet_aton(group), socket.INADDR_ANY)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        self.handlers = []
        self.number = 0
        self.parts = {}  # by sender: number of its newest long message, and its parts

    def subscribe(self, pattern, handler):
        self.handlers.append((re.compile(pattern), handler))

    def publish(self, channel, data):
        if len(channel) + len(data) > LONGEST:
            raise ValueError(f"{channel}: a message of {len(data)} bytes; small_lcm sends up to {LONGEST}")
        self.socket.sendto(struct.pack(">II", SHORT, self.number) + channel.encode() + b"\0" + data, self.address)
        self.number += 1

    def handle_timeout(self, timeout_ms):
        """Handles one message; 0 when no subscribed message arrived in time."""
        while select.select([self.socket], [], [], timeout_ms / 1000)[0]:
            channel, data = self.message_of(*self.socket.recvfrom(65536))
            desired = [handler for pattern, handler in self.handlers if channel and pattern.fullmatch(channel)]
            for handler in desired:
                handler(channel, data)
            if desired:
                return 1
        return 0

    def handle(self):
        while not self.handle_timeout(1000):
            pass

    def message_of(self, datagram, sender):
        """Returns (channel, payload) of the message that the datagram completes, or (None, None)."""
        magic = struct.unpack(">I", datagram[:4])[0] if len(datagram) >= 8 else None
        if magic == SHORT:
            channel, _, data = datagram[8:].partition(b"\0")
            return channel.decode(errors="replace"), data
        if magic == PART and len(datagram) >= 20:
            return self.whole(datagram, sender)
        return None, None

    def whole(self, datagram, sender):
        number, _, _, part, count = struct.unpack(">IIIHH", datagram[4:20])
        if self.parts.get(sender, (None,))[0] != number:
            self.parts[sender] = (number, {})  # only the newest message of each sender is kept
        parts = self.parts[sender][1]
        parts[part] = datagram[20:]
        if len(parts) < count:
            return None, None
        del self.parts[sender]
        channel, _, data = b"".join(parts[place] for place in sorted(parts)).partition(b"\0")
        return channel.decode(errors="replace"), data
