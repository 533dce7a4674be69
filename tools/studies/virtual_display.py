"""A display without a screen (Xvfb) that can be clicked on and photographed: its pixels lie in a file; and how lcm-spy's
viewers are opened on it. Used by the tests too."""

import os
import pathlib
import struct
import subprocess
import time
import zlib

AWAY = 3000  # where windows are put that are done with


class VirtualDisplay:
    """Use with `with`: sets DISPLAY while it lasts."""

    def __init__(self, folder, width=1400, height=800):
        self.folder = pathlib.Path(folder)
        self.size = (width, height)

    def __enter__(self):
        read_end, write_end = os.pipe()
        width, height = self.size
        command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", f"{width}x{height}x24", "-noreset", "-nolisten",
                   "tcp", "-fbdir", str(self.folder)]
        self.server = subprocess.Popen(command, pass_fds=[write_end], stderr=subprocess.DEVNULL)
        os.close(write_end)
        with os.fdopen(read_end) as answer:
            number = answer.readline().strip()
        assert number, "Xvfb did not start"
        os.environ["DISPLAY"] = f":{number}"
        return self

    def __exit__(self, *_):
        del os.environ["DISPLAY"]
        self.server.terminate()
        self.server.wait()

    def do(self, *words):
        """xdotool with these words; returns what it prints."""
        result = subprocess.run(["xdotool", *map(str, words)], capture_output=True, text=True, check=False, timeout=20)
        assert result.returncode == 0, (words, result.stderr)
        return result.stdout

    def window(self, name, seconds=120):
        """The newest visible window whose title holds `name`, waited for."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", name], capture_output=True,
                                   text=True, check=False).stdout.split()
            if found:
                return found[-1]
            time.sleep(0.1)
        raise AssertionError(f"no window {name} after {seconds} s")

    def geometry(self, window):
        """left, top, width, height of a window on the screen."""
        lines = self.do("getwindowgeometry", "--shell", window).split()
        values = dict(line.split("=") for line in lines)
        return tuple(int(values[key]) for key in ("X", "Y", "WIDTH", "HEIGHT"))

    def photograph(self, window=None):
        """The screen, or the part of it where a window is."""
        left, top, width, height = self.geometry(window) if window else (0, 0, *self.size)
        return ScreenImage.of_screen(self.folder / "Xvfb_screen0").cut(left, top, width, height)


class ScreenImage:
    """Pixels as rows of (red, green, blue) bytes."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows

    @staticmethod
    def of_screen(file):
        """Reads an X window dump of 32 bits a pixel: 25 numbers, a name, a colour table, then the rows."""
        data = file.read_bytes()
        header = struct.unpack(">25I", data[:100])
        header_size, width, height, bits, stride, colours = (header[i] for i in (0, 4, 5, 11, 12, 19))
        assert bits == 32, f"{file}: {bits} bits a pixel, expected 32"
        start = header_size + 12 * colours
        rows = []
        for y in range(height):
            row = data[start + y * stride : start + y * stride + 4 * width]
            rgb = bytearray(3 * width)
            rgb[0::3], rgb[1::3], rgb[2::3] = row[2::4], row[1::4], row[0::4]  # blue, green, red, unused
            rows.append(bytes(rgb))
        return ScreenImage(width, height, rows)

    def cut(self, left, top, width, height):
        left, top = max(left, 0), max(top, 0)
        rows = [row[3 * left : 3 * (left + width)] for row in self.rows[top : top + height]]
        return ScreenImage(len(rows[0]) // 3, len(rows), rows)

    def count(self, colour, tolerance=24):
        """Pixels that differ from a colour by at most `tolerance` in each of red, green and blue."""
        return sum(
            abs(row[x] - colour[0]) <= tolerance and abs(row[x + 1] - colour[1]) <= tolerance
            and abs(row[x + 2] - colour[2]) <= tolerance
            for row in self.rows for x in range(0, 3 * self.width, 3))

    def colours(self):
        """Returns how many different colours there are: few in an empty window, thousands in a photograph."""
        return len({row[x : x + 3] for row in self.rows for x in range(0, 3 * self.width, 3)})

    def save(self, file):
        raw = b"".join(b"\0" + row for row in self.rows)
        with open(file, "wb") as png:
            png.write(b"\x89PNG\r\n\x1a\n")
            size = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
            for kind, body in ((b"IHDR", size), (b"IDAT", zlib.compress(raw)), (b"IEND", b"")):
                png.write(struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)))


def row_of_table(row):
    """The middle of a row of spy's table, from 1, in pixels."""
    return 16 * row + 12


def open_viewer(display, spy, channel):
    """Double-clicks through the rows of spy's table until the window of a channel opens."""
    for row in range(1, 12):
        display.do("mousemove", 100, row_of_table(row), "click", "--repeat", 2, "--delay", 80, 1)
        try:
            title, window = channel_window(display)
        except AssertionError:
            continue  # a row without a channel
        if title == channel:
            return window
        display.do("windowmove", window, AWAY, AWAY)
    raise AssertionError(f"{channel} is not in spy's table: {spy.log.read_text()}")


def channel_window(display, seconds=4):
    """Title and id of a window that is named after a channel and in sight."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "^[A-Z]+_[A-Z_]+$"],
                               capture_output=True, text=True, check=False).stdout.split()
        for window in found:
            if display.geometry(window)[0] < AWAY:
                return display.do("getwindowname", window).strip(), window
        time.sleep(0.1)
    raise AssertionError("no window of a channel")
