# SPDX-License-Identifier: BSD-3-Clause
"""Ports for tests and measurements that run at the same time.  tests/own_ports.hpp does the same, with the same locks.

    python3 own_ports.py [SLOT]

prints the LCM URL of ports that no other test has until standard input ends, for programs in other languages.
"""
import ctypes
import errno
import os
import signal
import socket
import sys

# The ports start here, end below 32768, where the kernel takes ports of its own, and belong together by eight.
FIRST_PORT, PORTS_OF_A_SLOT, SLOTS = 10000, 8, 2500
_LOCKS = []


def is_free(port):
    """Whether no socket has the port, such as one of a program that a test left behind."""
    for kind in socket.SOCK_DGRAM, socket.SOCK_STREAM:
        with socket.socket(socket.AF_INET, kind) as probe:
            try:
                probe.bind(('', port))
            except OSError:
                return False
    return True


def take_slot(slot):
    """Takes the eight ports of a slot until this process ends, and returns the first; None when another process has
    them, of any user.  The lock is a name in the kernel: like the ports it is one for all in a network namespace, and
    it is gone with its process."""
    lock = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        lock.bind(f'\0shoal-test-ports-{slot}')
    except OSError as error:
        lock.close()
        if error.errno != errno.EADDRINUSE:
            raise
        return None
    first = FIRST_PORT + PORTS_OF_A_SLOT * slot
    if all(is_free(first + i) for i in range(PORTS_OF_A_SLOT)):
        _LOCKS.append(lock)
        return first
    lock.close()
    return None


def own_ports(slot=None):
    """The first of eight ports that no other test has until this process ends, from the given slot on."""
    slot = os.getpid() if slot is None else slot
    for i in range(SLOTS):
        first = take_slot((slot + i) % SLOTS)
        if first:
            return first
    raise RuntimeError('other processes have all ports for tests')


def url_of(port):
    """The LCM URL of a port, for this machine only."""
    return f'udpm://239.255.76.67:{port}?ttl=0'


def own_url(slot=None):
    """The LCM URL of a port that no other test has until this process ends."""
    return url_of(own_ports(slot))


def end_with_parent():
    """For `preexec_fn`: a program that a test starts does not outlive it, also when the test is killed."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


if __name__ == '__main__':
    print(own_url(*map(int, sys.argv[1:])), flush=True)
    sys.stdin.read()
