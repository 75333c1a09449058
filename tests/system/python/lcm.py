# SPDX-License-Identifier: BSD-3-Clause
"""As much of LCM's Python package as the examples use, for machines that have none: UDP multicast, short messages.

The datagram is magic, number and channel, then the payload; longer messages come in parts, which are left out here.
"""
import os
import re
import select
import socket
import struct

MAGIC = 0x4C433032


class LCM:
    def __init__(self, url=None):
        url = url or os.environ["LCM_DEFAULT_URL"]
        group, port = re.match(r"udpm://([\d.]+):(\d+)", url).groups()
        self.address = (group, int(port))
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.socket.bind(self.address)
        membership = struct.pack("4sL", socket.inet_aton(group), socket.INADDR_ANY)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        self.handlers = []
        self.number = 0

    def subscribe(self, pattern, handler):
        self.handlers.append((re.compile(pattern), handler))

    def publish(self, channel, data):
        self.socket.sendto(struct.pack(">II", MAGIC, self.number) + channel.encode() + b"\0" + data, self.address)
        self.number += 1

    def handle_timeout(self, timeout_ms):
        """Handles one message; 0 when none that somebody wants came in time."""
        while select.select([self.socket], [], [], timeout_ms / 1000)[0]:
            datagram = self.socket.recv(65536)
            if len(datagram) < 8 or struct.unpack(">I", datagram[:4])[0] != MAGIC:
                continue
            channel, data = datagram[8:].split(b"\0", 1)
            wanted = [handler for pattern, handler in self.handlers if pattern.fullmatch(channel.decode())]
            for handler in wanted:
                handler(channel.decode(), data)
            if wanted:
                return 1
        return 0
