"""The systemd units: what the processes tell their manager, and what a real manager of a user makes of that.

The manager runs in namespaces of its own, as a user without rights, with a cgroup tree of its own; that takes root, and a
systemd. Takes the forest, models and scene that end_to_end_test.py has made.
"""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time

from folders import read_arguments
from studies.stream import URL, enter_private_network

UNITS = pathlib.Path(__file__).resolve().parents[2] / "tools" / "stream" / "systemd"
USER = 12345
INSIDE = "HOUGHSTREAM_UNITS_INSIDE"
MANAGER = "/lib/systemd/systemd"
SKIPPED = 77


def check_notices(tools, made, folder):
    """READY=1 once it may be sent frames, then a sign of life each second, STOPPING=1 when it is asked to end."""
    place = folder / "notice"
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(place))
        manager.settimeout(60)
        process = subprocess.Popen([tools / "hs-detect", "--forest", made / "small.forest"],
                                   env={**os.environ, "NOTIFY_SOCKET": str(place), "WATCHDOG_USEC": "10000000"})
        try:
            assert manager.recv(100) == b"READY=1"
            signs = []
            for _ in range(3):
                assert manager.recv(100) == b"WATCHDOG=1"
                signs.append(time.monotonic())
            assert signs[-1] - signs[0] < 10.0, f"{signs}: the units allow ten seconds"
            process.send_signal(signal.SIGINT)
            words = manager.recv(100)
            while words == b"WATCHDOG=1":
                words = manager.recv(100)
            assert words == b"STOPPING=1", words
            assert process.wait(10) == 0
        finally:
            process.kill()
            process.wait()


class Manager:
    """A user's systemd, as this program's child."""

    def __init__(self, folder):
        self.home = folder / "home"
        run = pathlib.Path(f"/run/user/{USER}")
        self.environment = {**os.environ, "HOME": str(self.home), "XDG_RUNTIME_DIR": str(run)}
        subprocess.run("mount --make-rprivate / && umount -R /sys/fs/cgroup && mount -t cgroup2 none /sys/fs/cgroup"
                       " && mount -t tmpfs tmpfs /run && mkdir /run/systemd /run/systemd/system /run/user", shell=True, check=True)  # fmt: skip
        run.mkdir(mode=0o700)
        self.group = pathlib.Path("/sys/fs/cgroup/houghstream_units")
        self.group.mkdir(exist_ok=True)
        (self.group / "cgroup.procs").write_text("0")
        for path in (run, self.home, *self.home.rglob("*"), self.group, *self.group.iterdir()):
            os.chown(path, USER, USER)
        self.process = subprocess.Popen(self.as_user(MANAGER, "--user"), env=self.environment)

    @staticmethod
    def as_user(*words):
        return ["setpriv", "--reuid", str(USER), "--regid", str(USER), "--clear-groups", *words]

    def tell(self, *words):
        result = subprocess.run(self.as_user("systemctl", "--user", *words), env=self.environment, capture_output=True,
                                text=True, timeout=150, check=False)  # fmt: skip
        return result.stdout.strip() or result.stderr.strip()

    def show(self, unit, key):
        return self.tell("show", "--value", "-p", key, f"houghstream-{unit}")

    def end(self):
        """Leaves no group behind."""
        self.process.terminate()
        self.process.wait(30)
        (self.group.parent / "cgroup.procs").write_text("0")
        for folder in sorted((self.group, *filter(pathlib.Path.is_dir, self.group.rglob("*"))), reverse=True):
            folder.rmdir()

    def rights_of(self, unit, seconds):
        """Returns what the kernel says of the unit's process: of the next one where that ends meanwhile."""
        end = time.monotonic() + seconds
        while True:
            try:
                return pathlib.Path(f"/proc/{self.show(unit, 'MainPID')}/status").read_text()
            except (FileNotFoundError, ProcessLookupError):
                assert time.monotonic() < end, self.tell("status", "--no-pager", f"houghstream-{unit}")
                time.sleep(0.05)

    def wait_for_another(self, unit, pid, seconds):
        """Returns how long it takes until another process than this one has started."""
        start = time.monotonic()
        while self.show(unit, "MainPID") in ("0", str(pid)) or self.show(unit, "ActiveState") != "active":
            assert time.monotonic() - start < seconds, self.tell("status", "--no-pager", f"houghstream-{unit}")
            time.sleep(0.05)
        return time.monotonic() - start


def check_units(tools, made, folder):
    """They start, are held within bounds, come back when killed, and when they say nothing more."""
    configuration = folder / "home" / ".config"
    (configuration / "systemd" / "user").mkdir(parents=True)
    for unit in (*UNITS.glob("*.service"), *UNITS.glob("*.target")):
        shutil.copy(unit, configuration / "systemd" / "user")
    (configuration / "houghstream.env").write_text(
        f"HOUGHSTREAM_BIN={tools}\nHOUGHSTREAM_SOURCE=bop:{made / 'scene'}\nHOUGHSTREAM_FOREST={made / 'small.forest'}\n"
        f"HOUGHSTREAM_MODELS={made / 'views' / 'models'}\nLCM_DEFAULT_URL={URL}\n")  # fmt: skip
    manager = Manager(folder)
    end = time.monotonic() + 30
    while manager.tell("is-system-running") not in ("running", "degraded"):
        assert manager.process.poll() is None and time.monotonic() < end, f"systemd: {manager.process.poll()}"
        time.sleep(0.1)
    names = ("capture", "detect", "pose")
    manager.tell("start", *(f"houghstream-{name}" for name in names))
    for name in names:
        manager.wait_for_another(name, 0, 30)  # capture ends with its scene while pose gets ready, and begins anew
        rights = manager.rights_of(name, 30)
        assert "NoNewPrivs:\t1" in rights and "Seccomp:\t2" in rights, rights
    killed = int(manager.show("pose", "MainPID"))
    assert killed > 1
    os.kill(killed, signal.SIGKILL)
    print(f"killed, back after {manager.wait_for_another('pose', killed, 60):.2f} s")
    hung = int(manager.show("detect", "MainPID"))
    assert hung > 1
    os.kill(hung, signal.SIGSTOP)
    took = manager.wait_for_another("detect", hung, 90)
    print(f"stopped, back after {took:.2f} s")
    assert took > 5.0, "only silence tells that it hangs"
    manager.tell("stop", *(f"houghstream-{name}" for name in names))
    assert manager.show("pose", "ActiveState") == "inactive"
    manager.end()


def main():
    arguments = read_arguments(__doc__, made="what end_to_end_test.py has made")
    if os.environ.get(INSIDE):
        return check_units(arguments.tools, arguments.made, arguments.out)
    enter_private_network()
    check_notices(arguments.tools, arguments.made, arguments.out)
    readable = subprocess.run([*Manager.as_user("test", "-r"), arguments.made / "small.forest"], capture_output=True, check=False)
    if os.geteuid() != 0 or not os.path.exists(MANAGER) or readable.returncode != 0:
        print("skipped: a manager of one's own takes root, systemd, and data that another user may read")
        return SKIPPED
    inside = ["unshare", "-m", "-p", "-f", "--mount-proc", "--kill-child", sys.executable, *sys.orig_argv[1:]]
    return subprocess.run(inside, env={**os.environ, INSIDE: "1"}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
