"""A bus with ttl=0 is this machine's own: what another host sends to its port does not reach a process, by plain UDP or to
the group. With ttl=1 it does. Two hosts are network namespaces at a switch. Uses what end_to_end_test.py has made.
"""

import re
import subprocess
import sys
import time

from folders import read_arguments
from studies.network import Network
from studies.stream import Process
from two_hosts_test import enter_own_namespace

MESSAGES = 10
GROUP = "239.255.76.67"
SENDER = """
import socket, struct, sys, time
to = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
to.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 3)
for number in range({messages}):
    to.sendto(struct.pack(">II", 0x4C433032, number) + b"OPENNI_FRAME\\0no frame", (sys.argv[1], 7667))
    time.sleep(0.02)
"""


def send(address, host=()):
    """Rubbish on the frames' channel, as LCM's small messages are on the wire."""
    subprocess.run([*host, sys.executable, "-c", SENDER.format(messages=MESSAGES), address], check=True)


def heard(tools, made, folder, ttl, deliver):
    """Returns how many of the messages that deliver() sends a detector has received."""
    folder.mkdir()
    process = Process(folder, tools / "hs-detect", "--forest", made / "small.forest", "-l", f"udpm://{GROUP}:7667?ttl={ttl}")
    try:
        process.wait_until_ready()
        deliver()
        time.sleep(0.5)
        process.stop()
    finally:
        process.kill()
    log = "\n".join(path.read_text() for path in folder.iterdir() if path.is_file())
    return int(re.search(r"ends: (\d+) received", log).group(1))


def check_no_route(tools):
    """Without a multicast route a program says so, and what mends it, in one line without LCM's fifteen, and waits;
    a stop signal ends that."""
    said = subprocess.run(["unshare", "-rn", "timeout", "-s", "INT", "2", str(tools / "hs-observe"), "-l", f"udpm://{GROUP}:7667?ttl=0"],
                          capture_output=True, text=True, check=False, timeout=60)  # fmt: skip
    assert said.returncode == 124, said
    waits, *last = said.stderr.splitlines()
    assert f"no multicast route to {GROUP}" in waits and "sudo ip route add 224.0.0.0/4 dev lo" in waits, said
    assert len(last) == 1 and last[0].endswith(": stopped before the bus could be reached"), said


def main():
    enter_own_namespace()
    arguments = read_arguments(__doc__, made="what end_to_end_test.py has made")
    tools, made, folder = arguments.tools, arguments.made, arguments.out
    check_no_route(tools)
    with Network("b") as network:
        ways = {"from this host, to the group": lambda: send(GROUP),
                "from another host, by plain UDP": lambda: send("10.77.0.1", network.enter("b")),
                "from another host, to the group": lambda: send(GROUP, network.enter("b"))}  # fmt: skip
        for ttl in (0, 1):
            for number, (way, deliver) in enumerate(ways.items()):
                count = heard(tools, made, folder / f"{ttl}_{number}", ttl, deliver)
                print(f"ttl={ttl}, {way}: {count} of {MESSAGES}")
                assert count == (MESSAGES if ttl == 1 or "this host" in way else 0), (ttl, way, count)


if __name__ == "__main__":
    sys.exit(main())
