"""tools/demo --teach: a virtual camera is moved around an object that nobody has seen, while the stream runs; it is taught, found
and posed in the same stream. Times are those of the messages' arrival at the logger."""

import shutil
import subprocess
import time

from houghstream import known_objects_t, status_t, teaching_t
from houghstream.event_log import read_log
from studies.command import call, die, step
from studies.demo.pose_scatter import pose_figures
from studies.records import about, read_json, threads, write_json
from studies.report.page import embedded, render, show
from studies.stream import Processes, virtual_camera_of
from studies.time_left import SECONDS_APART, TimeLeft, last_words
from studies.unit_runner import Store, Units, make

OBJECT, NAME = "coffee_mug", "mug"
WORLD = 4  # of the rooms that are for development
TAKE_HZ, TAKE_FRAMES = 15, 240  # one turn about the object
LONGEST_S = 40  # of the take
AFTERWARDS_S = 20  # for which the stream goes on when the object is known
TEACHING_TIMEOUT_S = 600
TAKES_S = 25  # the take is rendered; this and STEPS_S on a machine with two slow cores
STEPS_S = {"begin": 12, "take": 20, "fusing": 60, "training": 150, "practise": 200, "afterwards": AFTERWARDS_S, "report": 8}
AROUND_US = 2_000_000  # the change of the store: so long before and after
POOR = 3  # exit status of hs-teach


def units():
    found = Units()
    found.add("takes", "", "hs-render", "takes", "--development", "--world", WORLD, "--objects", OBJECT, "--take", 1,
              "--frames", TAKE_FRAMES, "--fps", TAKE_HZ, "--out", "{out}", expected_s=TAKES_S)  # fmt: skip
    return found


def start_stream(running, programs, out, store, scene):
    """Starts all that a stream has, with the camera last. Nothing is known in it: there is no store yet."""
    running.start("detect", programs / "hs-detect", "--objects", store, "--threads", threads())
    running.start("pose", programs / "hs-pose", "--objects", store, "--threads", 1)
    running.start("view", programs / "hs-view", "--objects", store, "--rate", 4, "--pictures", out / "pictures", "--replace")
    running.start("logger", "lcm-logger", "-f", "-c", "HOUGHSTREAM_.*", out / "results.lcmlog")
    for name in ("detect", "pose", "view"):
        running.by_name[name].wait_until_ready()
    script, shutter = out / "camera_script", out / "shutter.txt"
    script.write_text(f"scene {scene}\nrate_hz {TAKE_HZ}\nshutter_file {shutter}\n")
    camera = {"LD_LIBRARY_PATH": virtual_camera_of(programs), "HOUGHSTREAM_VIRTUAL_CAMERA": str(script)}
    running.start("capture", programs / "hs-capture", "--source", "openni2", "--mode", f"640x480@{TAKE_HZ}", **camera)


def await_frames(capture, shutter, seconds=120):
    """The camera reads all its images before it takes the first."""
    end = time.monotonic() + seconds
    while not shutter.exists():
        if not capture.runs() or time.monotonic() > end:
            capture.fail("sends no frames")
        time.sleep(0.1)


def phase_of(words):
    """Which of STEPS_S hs-teach show is in, by all that it has said so far."""
    said = [line for line in words.splitlines() if line.startswith("hs-teach: ")]
    for phase, begins, holds in (("practise", "hs-teach: training: ", " is known"), ("training", "hs-teach: training: ", ""),
                                 ("fusing", "hs-teach: fusing: ", "")):  # fmt: skip
        if any(line.startswith(begins) and holds in line for line in said):
            return phase
    return "take"


def await_teaching(teach, time_left):
    """Returns the exit status of hs-teach show; until then says every ten seconds how far it is and how long the demo still
    takes."""
    end, told = time.monotonic() + TEACHING_TIMEOUT_S, time.monotonic()
    while True:
        phase = phase_of(teach.log.read_text(errors="replace"))
        if phase != time_left.running:
            time_left.begin(phase)
        try:
            return teach.process.wait(1.0)
        except subprocess.TimeoutExpired:
            if time.monotonic() > end:
                teach.fail(f"did not end within {TEACHING_TIMEOUT_S} s")
        if time.monotonic() - told >= SECONDS_APART:
            told = time.monotonic()
            print(f"    {last_words(teach.log) or 'hs-teach begins'}; all: {time_left.words()}", flush=True)


def stream(programs, out, scene, time_left):
    """The stream from its start to AFTERWARDS_S after the object is known, all that was said in OUT/results.lcmlog."""
    store = out / "store"
    with Processes(out / "log") as running:
        start_stream(running, programs, out, store, scene)
        await_frames(running.by_name["capture"], out / "shutter.txt")
        time_left.begin("take")
        step(f"the object is shown: {TAKE_HZ} frames a second, while hs-detect and hs-pose work on them; {time_left.words()}")
        teach = running.start("teach", programs / "hs-teach", "show", "--from-stream", "--name", NAME, "--out", store,
                              "--seconds", LONGEST_S, "--keep", out / "shown")  # fmt: skip
        status = await_teaching(teach, time_left)
        if status == POOR:
            die(f"hs-teach calls what it saw poor: {teach.log.read_text().strip().splitlines()[-1]}")
        if status != 0:
            teach.fail(f"ended with status {status}")
        time_left.begin("afterwards")
        step(f"taught; the stream goes on; {time_left.words()}")
        time.sleep(AFTERWARDS_S)
        for name in ("detect", "pose", "capture"):
            if not running.by_name[name].runs():
                running.by_name[name].fail("ended before it was asked to")
        running.stop("capture", "pose", "detect", "logger")
        running.stop("view", seconds=60)


def first(items, condition):
    return next((item for item in items if condition(item)), None)


class Story:
    """The events of the log, in order of arrival."""

    def __init__(self, log):
        self.teaching, self.statuses = [], []
        self.known_us, self.practised_us = None, None  # since when hs-detect knows it, and has its last forest of it
        for arrival, channel, data in read_log(log):
            if channel == "HOUGHSTREAM_TEACHING":
                self.teaching.append((arrival, teaching_t.decode(data)))
            elif channel == "HOUGHSTREAM_STATUS":
                self.statuses.append((arrival, status_t.decode(data)))
            elif channel == "HOUGHSTREAM_KNOWN_OBJECTS":
                known = known_objects_t.decode(data)
                if known.process == "hs-detect" and NAME in known.object_names:
                    self.known_us = self.known_us or known.since_utime
                    self.practised_us = known.since_utime

    def begin(self, state):
        """When a state of teaching_t began: (arrival, what was said)."""
        found = first(self.teaching, lambda said: said[1].state == state)
        if found is None:
            name = next(name for name, value in vars(teaching_t).items() if name.isupper() and value == state)
            die(f"no word of {name} on the bus, expected that of an object that is taught")
        return found

    def last(self, state):
        return first(reversed(self.teaching), lambda said: said[1].state == state)

    def of_process(self, process):
        return [(arrival, status) for arrival, status in self.statuses if status.process == process]


def stream_figures(story):
    """Returns what hs-detect lost and passed over, in all and around the moment when it took over the store."""
    statuses = story.of_process("hs-detect")
    last = statuses[-1][1]
    before = [status for arrival, status in statuses if arrival < story.known_us - AROUND_US] or [statuses[0][1]]
    after = first(statuses, lambda said: said[0] > story.known_us + AROUND_US) or statuses[-1]
    return {
        "frames": last.frames_received, "lost": last.frames_lost, "skipped": last.frames_skipped,
        "lost_at_change": after[1].frames_lost - before[-1].frames_lost,
        "skipped_at_change": after[1].frames_skipped - before[-1].frames_skipped,
    }  # fmt: skip


def found_in(frames):
    """(utime, detection) of the object, in the frames where it is."""
    return [(frame["utime"], found) for frame in frames for found in frame["detections"] if found["class_name"] == NAME]


def posed_in(found):
    """Returns those with a valid pose; a detection that hs-pose passed over has none at all."""
    return [(utime, detection) for utime, detection in found if detection["pose"] and detection["pose"]["status"] == "valid"]


def shares(frames, found, posed, since_us):
    """Returns in how many of the frames from then on it was found and posed."""
    later = {frame["utime"] for frame in frames if frame["utime"] > since_us}

    def share(those):
        return round(len(later & {utime for utime, _ in those}) / max(len(later), 1), 3)

    return {"frames": len(later), "found": share(found), "posed": share(posed)}


def summarise(out, scene, story):
    frames = read_json(out / "results.json")["frames"]
    found = found_in(frames)
    posed = posed_in(found)
    if story.known_us is None or not found or not posed:
        die(f"{NAME}: taught, but {len(found)} times found and {len(posed)} times posed in the stream, expected more")
    take, fusing, training, done = (
        story.begin(state)[0] for state in ((teaching_t.TRACKING, teaching_t.FUSING, teaching_t.TRAINING, teaching_t.DONE))
    )
    seconds = {"take": fusing - take, "fusing": training - fusing, "training": done - training,
               "found": found[0][0] - fusing, "posed": posed[0][0] - fusing}  # fmt: skip
    return (
        {
            "seconds": {name: round(1e-6 * us, 1) for name, us in seconds.items()},
            "shown": read_json(out / "shown" / "report.json"),
            "stream": stream_figures(story),
            "since_known": shares(frames, found, posed, story.known_us),
            "since_practised": shares(frames, found, posed, story.practised_us),
            "pose_scatter": pose_figures(posed, scene, out / "shutter.txt"),
        },
        found,
        posed,
    )


def drawn(out):
    """hs-view's images by the frame's utime, in order."""
    return dict(sorted((int(file.stem), file) for file in (out / "pictures").glob("*.jpg")))


def steps(out, story, found, posed):
    """(what, image) of each step; hs-view drew a few of the frames."""
    images = drawn(out)
    found = [one for one in found if one[0] in images] or found
    posed = [one for one in posed if one[0] in images] or posed
    take, fused = story.begin(teaching_t.TRACKING)[1], story.begin(teaching_t.FUSING)[1]
    half = take.utime + (fused.utime - take.utime) // 2
    training = (story.begin(teaching_t.TRAINING)[0] + story.last(teaching_t.TRAINING)[0]) // 2
    surest = max(posed, key=lambda one: one[1]["pose"]["quality"])
    views = [
        ("Nobody has seen the object: nothing is found", min(images)),
        ("Shown: what stands nearest to the middle is meant", take.utime + 500_000),
        ("Followed while the camera moves around it; the sphere fills", half),
        ("Seen from all sides that can be seen: the take ends", fused.utime - 300_000),
        ("The stream goes on while its model is taught", training),
        ("Found", found[0][0]),
        ("Found and posed, with the outline of the model that was made of it", surest[0]),
    ]
    told = [(words, embedded(images[min(images, key=lambda drawn_us: abs(drawn_us - utime))], "jpeg"))
            for words, utime in views]  # fmt: skip
    told.insert(4, ("What was kept of the take, and the model", embedded(out / "shown" / "contact_sheet.jpg", "jpeg")))
    return told


def share_words(shares):
    return f"{shares['found']:.2f}, {shares['posed']:.2f} of {shares['frames']}"


def rows(summary):
    seconds, flow, scatter_of = summary["seconds"], summary["stream"], summary["pose_scatter"]
    shown = summary["shown"]
    return [
        ("the take, s", seconds["take"]),
        ("model made, s", seconds["fusing"]),
        ("taught, s", seconds["training"]),
        ("from the take's end until it is found, s", seconds["found"]),
        ("from the take's end until it is posed, s", seconds["posed"]),
        ("verdict on the model", shown["verdict"]),
        ("seen from, share of the directions", show(shown["seen_share"], "{:.2f}")),
        ("drift over the closed turn", f"{show(shown['drift_mm'], '{:.1f}')} mm, {show(shown['drift_deg'], '{:.1f}')} degrees"),
        ("frames in the stream", flow["frames"]),
        ("lost, passed over", f"{flow['lost']}, {flow['skipped']}"),
        ("of these within 2 s of the store's change", f"{flow['lost_at_change']}, {flow['skipped_at_change']}"),
        ("found in, posed in, share of the frames since it is known", share_words(summary["since_known"])),
        ("the same since it is practised thoroughly", share_words(summary["since_practised"])),
        ("poses against the truth, scatter: median, 95 %",
         f"{scatter_of['mm_50']} mm, {scatter_of['mm_95']} mm; {scatter_of['deg_50']}, {scatter_of['deg_95']} degrees"),
    ]  # fmt: skip


def run(options, programs):
    out = options.out
    store = Store(out, programs, units().all(), files="data")
    make(store, options.fresh, after_s=sum(STEPS_S.values()))
    takes = store.path("takes")
    scene = takes / "test" / f"{read_json(takes / 'takes.json')[0]['scene']:06d}"
    stream_folder = out / "stream"
    shutil.rmtree(stream_folder, ignore_errors=True)
    time_left = TimeLeft(STEPS_S)
    time_left.begin("begin")
    step(f"a stream in which nothing is known; {time_left.words()}")
    stream(programs, stream_folder, scene, time_left)
    time_left.begin("report")
    step(f"report; {time_left.words()}")
    call(programs / "hs-log", "export", "json", stream_folder / "results.lcmlog", stream_folder / "results.json",
         into=out / "logs" / "export.txt")  # fmt: skip
    story = Story(stream_folder / "results.lcmlog")
    summary, found, posed = summarise(stream_folder, scene, story)
    summary = {**summary, **about(options.command), "network": options.network}
    write_json(out / "summary.json", summary)
    page = render("demo/teach_page.html", summary=summary, rows=rows(summary),
                  steps=steps(stream_folder, story, found, posed))  # fmt: skip
    (out / "report.html").write_text(page)
    print("\n" + "\n".join(f"{what:<48}{value}" for what, value in rows(summary)))
    print(f"\n{out}/report.html, {out}/summary.json")
