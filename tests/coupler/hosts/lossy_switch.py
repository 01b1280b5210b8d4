"""A switch that delays and loses frames: ``lossy_switch.py DELAY LOSS PORT NAMESPACE ...``.

Each port is a TAP device, moved into the namespace of a host as its ``eth0``.
"""

import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import sys
import time

TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 0x2, 0x1000
LONGEST = 65536  # bytes of a frame


def open_port(name, namespace):
    """Make a device, and give it to a host."""
    port = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(port, TUNSETIFF, struct.pack("16sH", name.encode(), IFF_TAP | IFF_NO_PI))
    command = ["ip", "link", "set", name, "netns", namespace, "name", "eth0"]
    subprocess.run(command, check=True)
    return port


def forward(ports, delay, loss):
    """Forward every frame to all other ports, late, or not at all."""
    queue, number, generator = [], 0, random.Random(1)
    while True:
        timeout = max(0.0, queue[0][0] - time.monotonic()) if queue else None
        for port in select.select(ports, [], [], timeout)[0]:
            frame = os.read(port, LONGEST)
            if generator.random() >= loss:
                number += 1
                heapq.heappush(queue, (time.monotonic() + delay, number, port, frame))
        while queue and queue[0][0] <= time.monotonic():
            _, _, origin, frame = heapq.heappop(queue)
            for port in ports:
                if port != origin:
                    try:
                        os.write(port, frame)
                    except OSError:  # its link is down, or its queue is full
                        continue


if __name__ == "__main__":
    seconds, share, *places = sys.argv[1:]
    opened_ports = [open_port(*place) for place in zip(places[::2], places[1::2], strict=True)]
    print("ready", flush=True)
    forward(opened_ports, float(seconds), float(share))
