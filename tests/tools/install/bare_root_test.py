"""The packages as a new user meets them: on a bare Debian 12 root they are installed, the main job runs, the README's lines
under "Use it in your program" print poses, and after their removal nothing is left. It takes root's rights, mmdebstrap,
Debian's archive, half an hour and 6 GB: skipped, with the reason, where no such root can be made, and unless
$HOUGHSTREAM_BARE_ROOT asks for it, as `tools/test --packages` does.

Usage: bare_root_test.py SOURCE_FOLDER BUILD_FOLDER"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
PACKAGES = ("houghstream", "houghstream-java", "libhoughstream-dev", "python3-houghstream")
SAMPLES = "houghstream-samples"  # where they have been made: cmake --build BUILD -t samples
FIRST_MINUTE_S = 60
SOURCES = ("/etc/apt/sources.list.d/debian.sources", "/etc/apt/sources.list")
# Mounts that end with the command: the host sees none of them.
ENTER = 'mount --rbind /proc "$1/proc" && mount --rbind /dev "$1/dev" && root=$1 && shift && exec chroot "$root" "$@"'
PRIVATE = "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo"
HOME = "/root/try"  # where the user of the root works
ENVIRONMENT = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "LANG": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"}


class Failed(Exception):
    pass


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def run(*words, seconds=600, **options):
    words = [str(word) for word in words]
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=seconds,
                          check=False, **options)  # fmt: skip
    if done.returncode != 0:
        raise Failed(f"{' '.join(words)}: status {done.returncode}\n{done.stdout[-4000:]}")
    return done.stdout


def inside(root, script, seconds=600):
    """Runs lines of bash in the root, each of which must succeed."""
    return run("unshare", "--mount", "sh", "-c", ENTER, "sh", root, "bash", "-ec", script, seconds=seconds, env=ENVIRONMENT)


def step(words):
    print(words, flush=True)


def build_packages(build, out):
    """The four packages, and that of the samples where they have been made, which lintian finds no error in where it is there."""
    run("cpack", "--config", build / "CPackConfig.cmake", "-B", out, cwd=build)
    packages = sorted(out.glob("*.deb"))
    names = tuple(sorted(package.name.split("_")[0] for package in packages))
    if tuple(name for name in names if name != SAMPLES) != PACKAGES:
        raise Failed(f"packages {names}, expected {PACKAGES}")
    if shutil.which("lintian"):
        step(run("lintian", "--fail-on", "error", "--allow-root", *packages))
    else:
        step("lintian is not there: sudo apt-get install lintian")
    return packages


def make_root(root):
    """A bare Debian 12, from the archive that this machine uses and in the way in which it is reached."""
    sources = next((file for file in SOURCES if os.path.isfile(file)), None)
    words = ["mmdebstrap", "--variant=apt", "--mode=root"]
    words += [f"--aptopt={line}" for line in run("apt-config", "dump", "Acquire").splitlines() if "::" in line]
    try:
        run(*words, "bookworm", root, *filter(None, [sources]), seconds=1200)
    except Failed as problem:
        skip(f"mmdebstrap makes no root: {str(problem).splitlines()[-1]}")
    if os.path.isfile("/etc/resolv.conf"):
        shutil.copy("/etc/resolv.conf", root / "etc/resolv.conf")
    try:
        inside(root, "true")
    except Failed as problem:
        skip(f"the root cannot be entered: {str(problem).splitlines()[-1]}")


def install(root, packages):
    here = root / HOME[1:] / "build/packages"
    here.mkdir(parents=True)
    for package in packages:
        shutil.copy(package, here)
    inside(root, f"apt-get update && cd {HOME} && apt-get install -y ./build/packages/*.deb", 2400)


def show_samples(root):
    """Objects found within a minute of the command, with nothing to teach."""
    if not (root / "usr/share/houghstream/samples").is_dir():
        return step("no samples have been made: tools/demo, then cmake --build BUILD -t samples")
    begin = time.monotonic()
    said = inside(root, f"cd {HOME} && houghstream-demo --picture found.png")
    seconds = time.monotonic() - begin
    if said.count("] found ") < 4 or seconds > FIRST_MINUTE_S:
        raise Failed(f"houghstream-demo: {seconds:.0f} s, expected four objects within {FIRST_MINUTE_S} s\n{said}")
    return step(f"four objects found {seconds:.0f} s after the command")


def run_main_job(root):
    inside(root, f"cd {HOME} && houghstream-demo measure", 2400)
    summary = json.loads((root / HOME[1:] / "out/demo/summary.json").read_text())
    right, inspected = summary["followed"]["right_fraction"]["all"], summary["processed"]["auc"]["mean"]
    if not (root / HOME[1:] / "out/demo/report.html").is_file() or right < 0.9 or inspected < 0.8:
        raise Failed(f"houghstream-demo measure: {right} of the followed poses right, mean AUC {inspected} in the frames that hs-detect "
                     "inspected, expected 0.9 or more, 0.8 or more, and report.html")  # fmt: skip


def lines_of_readme(source):
    """Its lines under "Use it in your program" behind the first one, which is what install() does."""
    section = (source / "README.md").read_text().split("\n## Use it in your program\n")[1].split("\n## ")[0]
    lines = [line[4:] for line in section.splitlines() if line.startswith("    ")]
    if "apt-get install ./build/packages/*.deb" not in lines[0]:
        raise Failed(f"README: '{lines[0]}', expected the packages' installation first")
    return lines[1:]


def follow_readme(root, source):
    """Python, C++ and Java each print poses."""
    script = "\n".join([PRIVATE, f"cd {HOME}", *lines_of_readme(source)])
    said = run("unshare", "--mount", "--net", "sh", "-c", ENTER, "sh", root, "bash", "-c", script, env=ENVIRONMENT, seconds=300)
    place = r"at -?\d+\.\d{3} -?\d+\.\d{3} -?\d+\.\d{3} m, "
    for language, line in (("Python", rf"^\d+ \w+ +{place}quality"), ("C++", rf"^\w+ +{place}quaternion .* quality"),
                           ("Java", rf"^\w+ {place}quality")):  # fmt: skip
        found = len(re.findall(line, said, re.MULTILINE))
        step(f"{language}: {found} poses")
        if found < 100:
            raise Failed(f"README: {found} poses printed by {language}, expected 100 or more\n{said[-4000:]}")


def use_pkg_config(root):
    inside(root, "cd /usr/share/doc/libhoughstream-dev/examples/cpp && for name in poses_in_base find_in_images own_camera; do "
                 "g++ -std=c++17 $name.cpp -o /tmp/$name $(pkg-config --cflags --libs houghstream); done")  # fmt: skip
    said = inside(root, "/tmp/find_in_images || true")
    if "expected STORE COLOUR DEPTH" not in said:
        raise Failed(f"find_in_images, built with pkg-config, says {said}")


def remove(root):
    samples = [SAMPLES] if (root / "usr/share/houghstream/samples").is_dir() else []
    inside(root, f"apt-get purge -y {' '.join([*PACKAGES, *samples])}")
    left = inside(root, r"find /boot /etc /lib /opt /srv /usr /var \( -iname '*houghstream*' -o -name 'hs-*' \) "
                        "-not -path '/var/cache/apt/*' -not -path '/var/log/*'")  # fmt: skip
    if left:
        raise Failed(f"left behind after the packages' removal:\n{left}")


def main():
    source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    if "HOUGHSTREAM_BARE_ROOT" not in os.environ:
        skip("it takes half an hour; tools/test --packages runs it")
    if os.geteuid() != 0:
        skip("a root is made by root only")
    for program, package in (("mmdebstrap", "mmdebstrap"), ("cpack", "cmake"), ("unshare", "util-linux")):
        if not shutil.which(program):
            skip(f"no {program} here; sudo apt-get install {package}")
    with tempfile.TemporaryDirectory(prefix="houghstream_root_") as folder:
        root = pathlib.Path(folder) / "root"
        packages = build_packages(build, pathlib.Path(folder) / "packages")
        make_root(root)
        step("a bare root")
        try:
            install(root, packages)
            step("installed")
            show_samples(root)
            run_main_job(root)
            step("the main job has run")
            follow_readme(root, source)
            use_pkg_config(root)
            step("built with pkg-config")
            remove(root)
        finally:
            subprocess.run(["rm", "-rf", str(root)], check=False)
    print("nothing is left of the packages")


if __name__ == "__main__":
    try:
        main()
    except Failed as problem:
        sys.exit(f"bare_root_test: {problem}")
