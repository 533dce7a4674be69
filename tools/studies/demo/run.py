"""The steps of tools/demo: data, log, stream, evaluation, report; of a rendered scene, of recorded ones, or live. --teach is
in teach.py."""

import shutil
import threading
import time

from houghstream.event_log import read_log
from studies.command import RECORDED_CAMERA, call, die, recorded_views, step
from studies.demo import live, report, teach
from studies.records import threads, write_json
from studies.stream import Stream, virtual_camera_of
from studies.time_left import TimeLeft
from studies.unit_runner import Store, Units, make

RATE, SINGLE_IMAGES_RATE = 30, 2  # Hz; single images are sent slowly enough that each is looked at
LOOKS = 5  # of the detector, a second, where hs-pose follows
USUAL_FRAMES = 300
# Seconds on a machine with two slow cores, of so many frames; STREAM_S beside what the frames take by their rate.
TRAINING_S, BACKGROUND_S, FOREST_S, SCENE_S, LOG_S = 44, 30, 70, 31, 8
STREAM_S, EVALUATION_S, REPORT_S = 8, 10, 2
AWAY_S = 3.0  # for which --unplug takes the camera away


def rendered_units(options):
    """Rendered views and rooms, the forest that is trained on them, and the test scene."""
    units = Units()
    units.add("training", "", "hs-render", "training", "--out", "{out}", expected_s=TRAINING_S)
    units.add("background", "", "hs-render", "background", "--count", 215, "--out", "{out}", expected_s=BACKGROUND_S)
    units.add("forest", "", "hs-train", "--threads", threads(), "--out", "{out}", "--views", "bop:{training}",
              "--background", "bop:{background}", expected_s=FOREST_S)  # fmt: skip
    units.add("scene", "", "hs-render", "scene", options.scene, "--frames", options.frames, "--out", "{out}",
              expected_s=SCENE_S * options.frames / USUAL_FRAMES)  # fmt: skip
    return units


def recorded_units(options):
    units = Units()
    units.add("scenes", "", "hs-import", "boxes", f"{options.real}/scenes", "{out}")
    units.add("clutter", "", "hs-log", "export", "bop", f"uw:{options.real}/clutter,{RECORDED_CAMERA}", "{out}")
    units.add("forest", "", "hs-train", "--threads", threads(), "--out", "{out}", *recorded_views(options.real),
              "--background", f"images:{options.real}/background")  # fmt: skip
    return units


def add_log(units, name, scene, rate):
    units.add(name, "", "hs-capture", "--source", f"bop:{{{scene}}}", "--rate", rate, "--log", "{out}", expected_s=LOG_S)


def steps_of(options):
    """What follows when the data are there: {step: expected seconds}."""
    names = ("stream", "clutter_stream") if options.real else ("stream",)
    rate, frames = (SINGLE_IMAGES_RATE, USUAL_FRAMES) if options.real else (RATE, options.frames)
    steps = {}
    for name in names:
        steps[name] = frames / rate + STREAM_S
        steps[f"{name} evaluation"] = 2 * EVALUATION_S * frames / USUAL_FRAMES
    return {**steps, "report": REPORT_S}


class Demo:
    def __init__(self, options, programs, units):
        self.options, self.programs, self.out = options, programs, options.out
        self.rate = SINGLE_IMAGES_RATE if options.real else RATE
        self.store = Store(options.out, programs, units.all(), files="data")
        steps = steps_of(options)
        make(self.store, options.fresh, after_s=sum(steps.values()))
        self.time_left = TimeLeft(steps)

    def stream(self, name, frames, models, follow=False):
        """hs-detect sends even its weakest detections here, as candidates: precision and recall are drawn over all scores.
        hs-pose looks at none but those that it would be sent."""
        looks, following = (("--looks-per-second", LOOKS), ("--follow",)) if follow else ((), ())
        return Stream(self.programs, self.store.path("forest"), models, frames, self.out / name,
                      detect=("--candidates", 0.01, *looks), pose=("--threads", 1, "--min-score", 0.2, *following),
                      show=True, track=follow)  # fmt: skip

    def step(self, name, words):
        """A line of progress with the time that the demo still takes."""
        self.time_left.begin(name)
        step(f"{words}; {self.time_left.words()}")

    def replay(self, name, log, scene, models=None):
        """The log through the stream, and what came out beside the truth of the scene. Returns how many frames were sent."""
        file = self.store.path(log)
        sent = sum(event.channel == "OPENNI_FRAME" for event in read_log(file))
        how = f"follows objects, {LOOKS} looks of the detector a second" if self.options.follow else "detects in each frame"
        self.step(name, f"{name}: {sent} frames through the stream, which {how}")
        self.stream(name, sent, models, self.options.follow).play("lcm-logplayer", file)
        self.step(f"{name} evaluation", f"{name}: evaluation")
        self.evaluate(name, "evaluation", scene, models)
        self.evaluate(name, "evaluation_processed", scene, models, "--processed-only")
        return sent

    def evaluate(self, name, what, scene, models, *options):
        out = self.out / name
        with_models = ("--models", models) if models else ()
        call(self.programs / "hs-evaluate", "--scene", self.store.path(scene), "--log", out / "results.lcmlog",
             "--rate", self.rate, "--forest", self.store.path("forest"), "--latency", out / "frame_times.csv",
             "--threads", threads(), *with_models, *options, "--out", out / what, into=out / f"{what}.txt")  # fmt: skip


def run_replay(options, programs):
    if options.real:
        units = recorded_units(options)
        add_log(units, "stream.lcmlog", "scenes", SINGLE_IMAGES_RATE)
        add_log(units, "clutter_stream.lcmlog", "clutter", SINGLE_IMAGES_RATE)
        demo = Demo(options, programs, units)
        sent = demo.replay("stream", "stream.lcmlog", "scenes")
        demo.replay("clutter_stream", "clutter_stream.lcmlog", "clutter")
    else:
        units = rendered_units(options)
        add_log(units, "stream.lcmlog", "scene", RATE)
        demo = Demo(options, programs, units)
        sent = demo.replay("stream", "stream.lcmlog", "scene", demo.store.path("training") / "models")
    demo.step("report", "report")
    report.write(options, demo.store, sent)


class Hand(threading.Thread):
    """Takes the camera away when so many frames have been taken, and puts it back. The camera looks at its script often: it
    must find a whole one."""

    def __init__(self, frames, script, shutter):
        super().__init__(daemon=True)
        self.frames, self.script, self.shutter = frames, script, shutter
        self.replugged_us = None

    def _write(self, text):
        fresh = self.script.with_suffix(".new")
        fresh.write_text(text)
        fresh.replace(self.script)

    def run(self):
        plugged = self.script.read_text()
        while not self.shutter.exists() or self.shutter.read_text().count("\n") < self.frames:
            time.sleep(0.1)
        self._write(plugged + "plugged no\n")
        time.sleep(AWAY_S)
        replugged_us = time.time_ns() // 1000
        self._write(plugged)
        self.replugged_us = replugged_us


def run_live(options, programs):
    """The virtual camera's images are in memory, and its shutter writes down when it opens."""
    demo = Demo(options, programs, rendered_units(options))
    out, frames = options.out, RATE * options.seconds
    script, shutter = out / "camera_script", out / "shutter.txt"
    shutter.unlink(missing_ok=True)
    script.write_text(f"scene {demo.store.path('scene')}\nshutter_file {shutter}\n")
    step(f"live: {options.seconds} s of the virtual camera through the stream at {RATE} Hz")
    hand = Hand(frames // 2, script, shutter)
    if options.unplug:
        hand.start()
    camera = {"LD_LIBRARY_PATH": virtual_camera_of(programs), "HOUGHSTREAM_VIRTUAL_CAMERA": str(script)}
    capture = (programs / "hs-capture", "--source", "openni2", "--frames", frames)
    demo.stream("stream", frames, demo.store.path("training") / "models").play(*capture, **camera)
    if options.unplug:
        hand.join(2 * AWAY_S)
        if not hand.replugged_us:
            die("the stream ended before the camera was taken away and put back")
    for name in ("overlay.png", "overlay.mp4"):
        shutil.copyfile(out / "stream" / name, out / name)
    summary = live.summarise(out, shutter, hand.replugged_us if options.unplug else None)
    write_json(out / "summary.json", {**summary, **report.about_run(options)})
    live.print_summary(summary)
    print(f"{out}/summary.json, {out}/overlay.png, {out}/overlay.mp4")


def run_images(options):
    from studies.demo import front_page  # which alone needs PIL

    front_page.take(options, Demo(options, options.programs, rendered_units(options)))


def run(options):
    if options.pictures:
        run_images(options)
    elif options.teach:
        teach.run(options, options.programs)
    elif options.live:
        run_live(options, options.programs)
    else:
        run_replay(options, options.programs)
