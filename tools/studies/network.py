"""Several hosts on one machine: network namespaces, each with a cable to a switch. Needs a private network
(studies.stream.enter_private_network), or a network namespace of one's own."""

import os
import subprocess
import time

URL = "udpm://239.255.76.67:7667?ttl=1"  # one hop: to the hosts at the same switch
MULTICAST = "224.0.0.0/4"


def ip(*words, host=()):
    subprocess.run([*host, "ip", *map(str, words)], check=True)


class Network:
    """This host and others at one switch. Use with `with`; processes that still run there are the caller's."""

    def __init__(self, *names):
        self.names, self.holders = names, {}

    def __enter__(self):
        ip("link", "set", "lo", "up")
        ip("link", "add", "switch", "type", "bridge", "mcast_snooping", 0)
        self._plug_in("switch", 1, ())
        try:
            for name in self.names:
                self._add(name)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for holder in self.holders.values():
            holder.kill()
            holder.wait()
        ip("link", "del", "switch")
        ip("route", "replace", MULTICAST, "dev", "lo")  # as in a private network

    def enter(self, name):
        """Words that start a command on that host; the command takes the place of these words."""
        return ("nsenter", "-t", str(self.holders[name].pid), "-n")

    def cut(self, name):
        """Pulls the host's cable."""
        ip("link", "set", f"port_{name}", "down")

    def join(self, name):
        ip("link", "set", f"port_{name}", "up")

    def take_out(self, name):
        """Takes the host's network device away, as with a WLAN stick."""
        ip("link", "del", f"port_{name}")

    def put_in(self, name):
        """Gives the host a network device, on which it is reached under its old address."""
        ip("link", "add", f"port_{name}", "type", "veth", "peer", "name", f"cable_{name}")
        ip("link", "set", f"cable_{name}", "netns", self.holders[name].pid)
        ip("link", "set", f"port_{name}", "master", "switch", "up")
        self._plug_in(f"cable_{name}", 2 + self.names.index(name), self.enter(name))

    def _add(self, name):
        """A network namespace lives for as long as a process holds it open."""
        self.holders[name] = subprocess.Popen(["unshare", "-n", "sleep", "infinity"])
        own = os.readlink("/proc/self/ns/net")
        while os.readlink(f"/proc/{self.holders[name].pid}/ns/net") == own:
            time.sleep(0.01)
        ip("link", "set", "lo", "up", host=self.enter(name))
        self.put_in(name)

    @staticmethod
    def _plug_in(device, number, host):
        ip("address", "add", f"10.77.0.{number}/24", "dev", device, host=host)
        ip("link", "set", device, "up", host=host)
        ip("route", "replace", MULTICAST, "dev", device, host=host)
