"""hs-view's page in a real browser: what is there, what changes while the stream goes on, what the buttons do, and that it
comes back by itself when hs-view does. Leaves page_desktop.png, page_phone.png, page_WIDTH.png and scene_WIDTH.png in OUT."""

import argparse
import contextlib
import pathlib
import socket
import sys
import time

from browser import Browser, find_chromium
from studies.stream import Processes, enter_private_network
from scripted_stream import BOWL_HEIGHT, CAMERA, MUG_BOX, ToldStream

SKIPPED = 77
ROWS = "document.querySelectorAll('#objects tr[data-key]:not(.gone)').length"
# A number made of the pixels of an image in the page.
DRAWN = """(() => { const canvas = document.createElement('canvas'), image = PICTURE; canvas.width = 64; canvas.height = 48;
  const pen = canvas.getContext('2d'); pen.drawImage(image, 0, 0, 64, 48);
  return pen.getImageData(0, 0, 64, 48).data.reduce((sum, value, i) => (31 * sum + value * (i % 7 + 1)) % 1000003, 0); })()"""
WORDS = "document.getElementById('link').textContent"


# Samples of the page: which of thirty frames the image is of, by the commonest brightness of its pixels, and which the list.
SAMPLE_BOTH = """(async () => { const pairs = []; const canvas = document.createElement('canvas'); canvas.width = 64; canvas.height = 48;
  const pen = canvas.getContext('2d', { willReadFrequently: true });
  for (let i = 0; i < 120; ++i) { await new Promise(done => setTimeout(done, 25));
    pen.drawImage(document.getElementById('colour'), 0, 0, 64, 48);
    const data = pen.getImageData(0, 0, 64, 48).data, counts = new Array(32).fill(0);
    for (let at = 0; at < data.length; at += 4) if (Math.abs(data[at] - data[at + 1]) < 6 && Math.abs(data[at] - data[at + 2]) < 6) ++counts[data[at] >> 3];
    const score = Number(document.querySelector('#objects td.n').innerText);
    pairs.push([counts.indexOf(Math.max(...counts)), Math.round(100 * (score - 0.6))]); }
  return pairs; })()"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def text_of(selector):
    return f"document.querySelector('{selector}').innerText"


def check_elements(page):
    page.wait_for(f"{WORDS} === 'live'", 60)
    page.wait_for("document.getElementById('colour').naturalWidth === 64")
    page.wait_for("document.getElementById('second').naturalWidth === 64")
    page.wait_for(f"{ROWS} === 2")
    bowl, mug = page.value("[...document.querySelectorAll('#objects tr[data-key]')].map(row => row.innerText)")
    assert "0.100, 0.000, 0.900" in bowl, bowl
    assert "mug <b>" in mug and "rejected by depth" in mug, mug
    page.wait_for(f"{text_of('#processes tbody')}.includes('hs-view')")
    assert "pose.registration" in page.value(text_of("#stages"))
    assert page.value(text_of("#latency-title")).startswith("LATENCY: detections ")
    titles = "[[null, 27], [50, 27], [50, null], [null, null]].map(([detect_ms, pose_ms]) => { Object.assign(frame, { detect_ms, pose_ms }); showStages(); return document.getElementById('latency-title').textContent; })"  # fmt: skip
    assert page.value(titles) == ["LATENCY: poses 27 ms", "LATENCY: detections 50 ms, poses 27 ms", "LATENCY: detections 50 ms, no poses",
                                  "LATENCY: no detections"], page.value(titles)  # fmt: skip
    second = "document.getElementById('second')"
    page.value("{ const view = document.getElementById('second-view'); view.value = '3d'; view.dispatchEvent(new Event('change')); }")
    before = page.value(f"{second}.src")
    page.wait_for(f"{second}.src !== '{before}' && {second}.naturalWidth === 64")


def check_loading(page):
    """Until the first frame the page says that it waits, and shows no broken image."""
    page.wait_for(f"{WORDS} === 'no frames'", 60)
    for image in ("colour", "second"):
        hidden = f"(image => getComputedStyle(image).visibility === 'hidden' && getComputedStyle(image.parentElement, '::before').content)(document.getElementById('{image}'))"
        assert page.value(hidden) == '"waiting for the first frame"', image


# Results reach the page a third of a second late, in their order, so that pictures come before them.
LATE_RESULTS = """(() => { const listen = window.promptListen = EventSource.prototype.addEventListener;
  EventSource.prototype.addEventListener = function (name, act) { listen.call(this, name, event => setTimeout(() => act(event), 300)); };
  connect(); })()"""
# A picture that waits for its results is dropped, as at a new connection, and these come all the same. Are they shown?
LATER_THAN_DROPPED = """(async () => { while (!colour.next) await new Promise(done => setTimeout(done, 5));
  const number = pictured, news = { ...frame };
  colour.again = false; colour.drop(); expectFrame(news, number);
  return frame === news; })()"""
PROMPT_RESULTS = "(() => { EventSource.prototype.addEventListener = window.promptListen; connect(); })()"


def check_same_frame(page):
    """The list and the image beside it are of one frame at any moment: the image's brightness and the score both name it."""
    for when in (None, LATE_RESULTS, PROMPT_RESULTS):
        if when:
            page.value(when)
        told = page.value(SAMPLE_BOTH)
        assert len({score for _, score in told}) >= 5, (when, told)
        others = [pair for pair in told if pair[0] != pair[1]]
        assert not others, (when, others)
        if when == LATE_RESULTS:
            assert not page.value(LATER_THAN_DROPPED)


def check_chart(page):
    """One frame in forty takes five seconds; the scale is that of the others, and it is marked."""
    page.wait_for("Number(document.getElementById('latency').dataset.beyond) >= 1", 60)
    top = page.value("Number(document.getElementById('latency').dataset.top)")
    assert top <= 2000, f"one slow frame makes a scale of {top} ms"


def check_terms(page):
    """A score and a quality are explained where they stand: beside a mouse's pointer, at a touch, and below the list."""
    score, quality = page.value("(row => [row.querySelector('td.n').title, row.querySelector('.muted').title])(document.querySelector('#objects tr[data-key]'))")
    assert "object is there" in score and "pose is right" in quality, (score, quality)
    page.value("document.querySelector('#objects td.n').dispatchEvent(new PointerEvent('pointerup', { bubbles: true, pointerType: 'touch' }))")
    assert page.value(text_of("#explanation")) == score
    page.value("document.body.dispatchEvent(new PointerEvent('pointerup', { bubbles: true, pointerType: 'touch' }))")
    assert page.value("document.getElementById('explanation').hidden")
    unexplained = "[...document.querySelectorAll('th.n')].map(head => head.innerText).filter((words, i) => !document.querySelectorAll('th.n')[i].querySelector('[title]'))"  # fmt: skip
    assert page.value(unexplained) == ["age"], page.value(unexplained)
    assert "score" in page.value(text_of("#terms")) and "quality" in page.value(text_of("#terms"))


def check_processes(page, told):
    """A process that falls silent is shown as ended, without its rate."""
    row = "[...document.querySelectorAll('#processes tbody tr')].find(row => row.innerText.includes('hs-pose'))"
    page.wait_for(f"{row} && {row}.className === 'alive' && {row}.innerText.includes('10.0')")
    told.pose_process_ended.set()
    page.wait_for(f"{row}.className === 'ended' && {row}.innerText.includes('ended') && !{row}.innerText.includes('10.0')")


def box_of(page, selector):
    return page.value(f"(box => [box.left, box.top, box.right, box.bottom])(document.querySelector('{selector}').getBoundingClientRect())")


def check_layout(page, out):
    """The camera's image is the largest thing, with the objects beside it, on a phone below it."""
    for width, height in ((360, 740), (1300, 900), (1920, 1080)):
        page.resize(width, height, width < 900)
        page.wait_for(f"innerWidth === {width} && scrollY === 0")
        left, top, right, bottom = box_of(page, "#colour-frame")
        assert right - left > (0.98 if width < 900 else 0.55) * width, (width, left, right)
        assert bottom <= height, f"the picture leaves the screen of {width} x {height}"
        objects = box_of(page, "#objects-card")
        assert objects[1] >= bottom if width < 900 else objects[0] >= right and objects[1] < top + 50, (width, objects)
        for other in page.value("[...document.querySelectorAll('main section:not([hidden]), .frame')].map(it => it.id || 'second')"):
            if other in ("colour-card", "colour-frame"):
                continue
            box = box_of(page, f"#{other}" if other != "second" else "#second-card .frame")
            assert (other != "second" and width < 900) or (box[2] - box[0]) * (box[3] - box[1]) < (right - left) * (bottom - top), (width, other, box)
        page.photograph(out / f"page_{width}.png", whole=width < 900)


def check_world(page):
    """Beside the image: the world from above, which changes as the objects do, and its list."""
    page.wait_for("!document.getElementById('world-card').hidden")
    bowl, mug = page.wait_for("[...document.querySelectorAll('#world tbody tr')].map(row => row.innerText)")
    assert "#1 bowl" in bowl and "visible" in bowl, bowl
    assert "#2 mug <b>" in mug and "hidden" in mug and "occluded by a nearer surface" in mug, mug
    page.value("{ const view = document.getElementById('second-view'); view.value = 'world'; view.dispatchEvent(new Event('change')); }")
    second = "document.getElementById('second')"
    page.wait_for(f"{second}.naturalWidth === 440 && {second}.naturalHeight === 330")
    page.wait_for(f"{text_of('#second-words')} === 'WORLD from above, 2 cameras'")
    sums, end = set(), time.monotonic() + 30
    while time.monotonic() < end and len(sums) < 3:
        sums.add(page.value(DRAWN.replace("PICTURE", second)))
        time.sleep(0.2)
    assert len(sums) >= 3, "the world stands still"


CHOOSE_SCENE = "{ const view = document.getElementById('second-view'); view.value = 'scene'; view.dispatchEvent(new Event('change')); }"
DRAWN_PIXELS = """(() => { const canvas = document.createElement('canvas'); canvas.width = 160; canvas.height = 120;
  const pen = canvas.getContext('2d'); scene3d.draw(); pen.drawImage(document.getElementById('scene'), 0, 0, 160, 120);
  const data = pen.getImageData(0, 0, 160, 120).data; let drawn = 0;
  for (let at = 0; at < data.length; at += 4) drawn += Math.abs(data[at] - 0x16) + Math.abs(data[at + 1] - 0x18) + Math.abs(data[at + 2] - 0x1b) > 60;
  return drawn; })()"""
POINT = """(events => events.forEach(([name, id, x, y]) => { const at = document.getElementById('scene').getBoundingClientRect();
  document.getElementById('scene').dispatchEvent(new PointerEvent(`pointer${name}`, { pointerId: id, pointerType: 'touch', clientX: at.left + x, clientY: at.top + y, buttons: 1 })); }))"""


def away(page):
    """From what the 3-D view looks at to where it looks from: [x, y, z]."""
    return page.value("scene3d.camera.position.clone().sub(scene3d.target).toArray()")


def length(vector):
    return sum(value * value for value in vector) ** 0.5


def close(some, others):
    return len(some) == len(others) and all(abs(a - b) < 1e-6 for a, b in zip(some, others))


def check_scene_falls_back(page):
    """Without libjs-three, or without WebGL, the page says so in a line and goes on."""
    page.value("fetchThree = window.fetch, window.fetch = (url, ...more) => url === 'three.js' ? Promise.resolve(new Response("
               "'three.js is not there: sudo apt-get install libjs-three', { status: 404 })) : fetchThree(url, ...more), 0")  # fmt: skip
    page.value(CHOOSE_SCENE)
    page.wait_for(f"{text_of('#scene-words')} === 'The world cannot be drawn in 3-D here. three.js is not there: sudo apt-get install libjs-three'")
    page.value("window.fetch = fetchThree, contextOf = HTMLCanvasElement.prototype.getContext, HTMLCanvasElement.prototype.getContext ="
               " function (kind, ...more) { return kind === 'webgl' ? null : contextOf.call(this, kind, ...more); },"
               " sceneLoading = null, showScene()")  # fmt: skip
    page.wait_for(f"{text_of('#scene-words')}.endsWith('This browser has no WebGL.')")
    assert page.value("document.getElementById('scene').hidden")
    page.value("HTMLCanvasElement.prototype.getContext = contextOf, sceneLoading = null, showScene()")


def check_scene(page, out):
    """The world in 3-D: objects as the boxes of the messages, cameras, and that it turns, moves and comes nearer by hand."""
    if page.value("fetch('three.js').then(answer => answer.status)") != 200:
        print("3-D view: not looked at, sudo apt-get install libjs-three")
        return
    check_scene_falls_back(page)
    page.wait_for("scene3d !== null && !document.getElementById('scene').hidden && scene3d.objects.size === 2")
    place = "(group => ({ position: group.position.toArray(), size: group.userData.box.scale.toArray(), quaternion: [group.quaternion.w, group.quaternion.x, group.quaternion.y, group.quaternion.z] }))(scene3d.objects.get(%d))"
    mug = page.value(place % 2)
    for key, expected in MUG_BOX.items():
        assert close(mug[key], expected), (key, mug, expected)
    places = set()
    for _ in range(100):
        shown, told = page.value(f"[{place % 1}, frame.world.objects[0]]")
        assert close(shown["position"], told["box"]["position"]), (shown, told)
        x, y, z = told["position"]
        assert close(shown["position"], [x, y, z + BOWL_HEIGHT / 2]) and abs(x * x + y * y - 0.09) < 1e-6, (shown, told)
        places.add(tuple(shown["position"]))
        if len(places) > 2:
            break
        time.sleep(0.1)
    assert len(places) > 2, "the bowl stands still in the 3-D view"
    assert close(page.value("scene3d.cameras.get('OPENNI_FRAME').position.toArray()"), [0.0, -0.8, 0.6])
    assert page.value("scene3d.cameras.size") == 2 and page.value("scene3d.ground.position.z") == 0
    assert page.value(DRAWN_PIXELS) > 300, "hardly anything is drawn"
    before = away(page)
    page.value(f"{POINT}([['down', 1, 100, 60], ['move', 1, 160, 60], ['up', 1, 160, 60]])")
    turned = away(page)  # what moves does not move the view
    assert not close(before, turned) and abs(length(before) - length(turned)) < 1e-6 and abs(before[2] - turned[2]) < 1e-6, (before, turned)
    page.value(f"{POINT}([['down', 1, 100, 60], ['down', 2, 140, 60], ['move', 2, 180, 60], ['up', 1, 0, 0], ['up', 2, 0, 0]])")
    assert abs(length(away(page)) - 0.5 * length(turned)) < 1e-6, "two fingers that part come nearer"
    page.value("document.getElementById('scene').dispatchEvent(new WheelEvent('wheel', { deltaY: 500, cancelable: true }))")
    assert length(away(page)) > 0.7 * length(turned)
    page.value("document.getElementById('scene').dispatchEvent(new MouseEvent('dblclick'))")
    for width, height in ((360, 740), (1300, 900), (1920, 1080)):
        page.resize(width, height, width < 900)
        page.wait_for(f"innerWidth === {width} && document.getElementById('scene').clientWidth > {width // 4}")
        assert page.value("document.documentElement.scrollWidth") <= width
        time.sleep(0.5)
        page.photograph(out / f"scene_{width}.png", whole=True)


def check_live_change(page):
    scores, images = set(), set()
    end = time.monotonic() + 60
    while time.monotonic() < end and min(len(scores), len(images)) < 3:
        scores.add(page.value("document.querySelector('#objects td.n').innerText"))
        images.add(page.value("document.getElementById('colour').src"))
        time.sleep(0.1)
    assert min(len(scores), len(images)) >= 3, (scores, images)


def check_picking(page):
    page.value("document.querySelectorAll('#objects tr[data-key]')[1].click()")
    page.wait_for(f"{text_of('#evidence')}.includes('contradicts the measured depth')")
    page.wait_for("document.getElementById('mark').style.display === 'block'")
    page.value("document.querySelectorAll('#objects tr[data-key]')[0].click()")
    page.wait_for(f"{text_of('#evidence')}.includes('wxyz 1.000, 0.000, 0.000, 0.000')")


def check_buttons(page):
    page.value("{ const slider = document.getElementById('threshold'); slider.value = 0.5; slider.dispatchEvent(new Event('change')); }")
    page.wait_for(f"{ROWS} === 1")
    page.wait_for(f"{text_of('#objects-title')} === 'OBJECTS: 1, 1 weaker'")
    page.value("document.getElementById('pause').click()")
    page.wait_for(f"{WORDS} === 'paused'")
    utime = page.wait_for("frame.utime")
    time.sleep(0.5)
    assert page.value("frame.utime") == utime, "frames go on while paused"
    page.value("document.getElementById('pause').click()")
    page.wait_for(f"{WORDS} === 'live' && frame.utime > {utime}")


def check_token(page, start_view):
    """Served to other machines, buttons without the printed token are refused, and the page says so."""
    port = free_port()
    view = start_view(f"0.0.0.0:{port}", "hs-view-open")
    address = view.log.read_text().split("page: ")[1].split()[0]
    token = address.split("?token=")[1]
    for words, expected in (("", True), (f"?token={token}", False)):
        page.open(f"http://127.0.0.1:{port}/{words}")
        page.wait_for(f"location.port === '{port}' && location.search === '{words}' && {WORDS} === 'live'", 60)
        page.value("document.getElementById('pause').click()")
        if expected:
            page.wait_for(f"{text_of('#notice')}.includes('need the token')")
        else:
            page.wait_for(f"{WORDS} === 'paused'")
    view.stop(10)


# A long row in the list of objects: whether the list stays within its card, and on how many lines the name stands.
LONG_ROW = """(() => { const table = document.getElementById('objects'), row = table.tBodies[0].rows[0].cloneNode(true);
  row.cells[0].lastChild.textContent = 'coffee_mug';
  row.cells[2].innerHTML = '-0.243, -0.117, 1.853<div class="muted">quality 0.36, by shape 0.93</div>';
  table.tBodies[0].append(row);
  const name = document.createRange(); name.selectNodeContents(row.cells[0].lastChild);
  const found = [table.getBoundingClientRect().right <= table.parentElement.getBoundingClientRect().right, name.getClientRects().length];
  row.remove(); return found; })()"""


def check_phone(page, out):
    page.resize(360, 740, True)
    page.wait_for("innerWidth === 360")
    assert page.value(LONG_ROW) == [True, 1], page.value(LONG_ROW)
    page.resize(390, 844, True)
    page.wait_for("innerWidth === 390")
    assert page.value("document.documentElement.scrollWidth") <= 390, "a phone has to scroll sideways"
    assert page.value("document.getElementById('pause').getBoundingClientRect().height") >= 36, "a button too low for a thumb"
    page.photograph(out / "page_phone.png", whole=True)


def check_page(program, arguments):
    out, port = arguments.out, free_port()
    with contextlib.ExitStack() as stack:
        processes, page = stack.enter_context(Processes(out)), stack.enter_context(Browser(program))

        def start_view(address, name="hs-view"):
            view = processes.start(name, arguments.tools / "hs-view", "--http", address, "--camera", CAMERA)
            view.wait_until_ready(60)
            return view

        view = start_view(port)
        page.resize(1280, 900, False)
        page.open(f"http://127.0.0.1:{port}/")
        check_loading(page)
        told = stack.enter_context(ToldStream())
        check_elements(page)
        check_live_change(page)
        check_same_frame(page)
        check_chart(page)
        check_terms(page)
        check_layout(page, out)
        page.resize(1280, 900, False)
        check_processes(page, told)
        check_world(page)
        check_scene(page, out)
        page.resize(1280, 900, False)
        check_picking(page)
        page.photograph(out / "page_desktop.png")
        check_buttons(page)
        last = page.value("frame.utime")
        view.stop(10)
        page.wait_for(f"{WORDS} === 'reconnecting'")
        view = start_view(port, "hs-view-again")
        page.wait_for(f"{WORDS} === 'live' && frame.utime > {last}", 60)
        check_phone(page, out)
        assert not page.errors, page.errors
        elsewhere = [url for url in page.requests if not url.startswith((f"http://127.0.0.1:{port}/", "blob:http://127.0.0.1", "data:"))]
        assert not elsewhere, elsewhere
        view.stop(10)
        check_token(page, start_view)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tools", type=pathlib.Path, required=True, help="folder of hs-view")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for pictures and words")
    arguments = parser.parse_args()
    program = find_chromium()
    if program is None:
        print("skipped: no Chromium here; sudo apt-get install chromium")
        sys.exit(SKIPPED)
    enter_private_network()
    arguments.out.mkdir(parents=True, exist_ok=True)
    check_page(program, arguments)
    print("the page works in", program)


if __name__ == "__main__":
    main()
