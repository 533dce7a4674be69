"""A headless Chromium that is told what to do through its DevTools pipe; nothing but Chromium is needed."""

import base64
import ctypes
import fcntl
import json
import os
import pathlib
import select
import shutil
import signal
import subprocess
import tempfile
import time


PR_SET_CHILD_SUBREAPER = 36  # prctl(2)


def adopt_orphans():
    """What Chromium's processes leave behind becomes ours: there may be nobody else who waits for it, as in a container."""
    ctypes.CDLL(None, use_errno=True).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def children_of_chromium():
    """Our children by that name, dead ones too."""
    for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            pid, _, rest = status.read_text().partition(" (")
        except OSError:  # it has ended meanwhile
            continue
        name, _, fields = rest.rpartition(") ")
        if name.startswith("chrom") and int(fields.split()[1]) == os.getpid():
            yield int(pid)


def find_chromium():
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Browser:
    """Use with `with`. What its pages ask for from the network is in `requests`, what their scripts complain of in `errors`."""

    def __init__(self, program, width=1280, height=900):
        adopt_orphans()
        self.folder = tempfile.TemporaryDirectory(prefix="page_test_")
        command = [program, "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
                   "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--no-first-run",
                   "--disable-background-networking", "--disable-component-update", "--disable-extensions", "--disable-quic",
                   "--disable-sync", "--disable-breakpad",
                   f"--user-data-dir={self.folder.name}", f"--window-size={width},{height}", "--remote-debugging-pipe",
                   "about:blank"]  # fmt: skip
        # The pipe's ends are file descriptors 3 and 4 there, by Chromium's own rule.
        self.answers, write_end = os.pipe()
        read_end, self.orders = os.pipe()
        theirs = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (read_end, write_end)]

        def place_pipe():
            os.dup2(theirs[0], 3)
            os.dup2(theirs[1], 4)

        with open(os.path.join(self.folder.name, "words.txt"), "w", encoding="utf-8") as words:
            self.process = subprocess.Popen(command, stdout=words, stderr=words, preexec_fn=place_pipe, pass_fds=(3, 4),
                                            start_new_session=True)  # fmt: skip
        for end in (read_end, write_end, *theirs):
            os.close(end)
        self.number, self.waiting = 0, b""
        self.requests, self.errors = [], []
        self.session = None

    def __enter__(self):
        targets = self.ask("Target.getTargets")["targetInfos"]
        page = next(target["targetId"] for target in targets if target["type"] == "page")
        self.session = self.ask("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Network"):
            self.ask(f"{domain}.enable")
        return self

    def __exit__(self, *_):
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.end_helpers()
        os.close(self.orders)
        os.close(self.answers)
        self.folder.cleanup()

    def end_helpers(self):
        """Waits for the processes that Chromium has started; they end when it does. Leaves none."""
        end = time.monotonic() + 10
        while helpers := list(children_of_chromium()):
            for pid in helpers:
                if time.monotonic() > end:
                    os.kill(pid, signal.SIGKILL)
                os.waitpid(pid, os.WNOHANG)
            time.sleep(0.02)

    def ask(self, method, **parameters):
        """The answer to a method of the DevTools protocol."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.orders, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive(60)
            if answer.get("id") == self.number:
                assert "error" not in answer, (method, answer["error"])
                return answer["result"]

    def receive(self, seconds):
        """The next message; what happened in the page is noted."""
        while b"\0" not in self.waiting:
            ready, _, _ = select.select([self.answers], [], [], seconds)
            assert ready, f"Chromium has said nothing for {seconds} s"
            part = os.read(self.answers, 1 << 20)
            assert part, "Chromium has ended"
            self.waiting += part
        line, _, self.waiting = self.waiting.partition(b"\0")
        message = json.loads(line)
        happened = message.get("params", {})
        if message.get("method") == "Network.requestWillBeSent":
            self.requests.append(happened["request"]["url"])
        if message.get("method") == "Runtime.exceptionThrown":
            self.errors.append(happened["exceptionDetails"])
        return message

    def open(self, url):
        self.ask("Page.navigate", url=url)

    def value(self, expression):
        """Returns the value of a JavaScript expression in the page."""
        result = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in result, (expression, result["exceptionDetails"])
        return result["result"].get("value")

    def wait_for(self, expression, seconds=120):
        """Until the expression is true; returns its value."""
        end, said = time.monotonic() + seconds, ""
        while time.monotonic() < end:
            try:
                worth = self.value(expression)
            except AssertionError as problem:  # the page is not there yet
                worth, said = None, problem
            if worth:
                return worth
            time.sleep(0.1)
        raise AssertionError(f"not true after {seconds} s: {expression}; {said}")

    def resize(self, width, height, phone):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, mobile=phone,
                 deviceScaleFactor=2 if phone else 1)  # fmt: skip

    def photograph(self, file, whole=False):
        """The page as PNG: what is in sight, or all of it."""
        image = self.ask("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(file, "wb") as png:
            png.write(base64.b64decode(image["data"]))
