"""The package houghstream-samples, where the samples have been made (target `samples`): what is in it, that it is below 40 MB, and
that an installed houghstream-demo finds its four objects within a minute. Arguments: the source folder, the build folder."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
MOST_BYTES, MOST_SECONDS = 40_000_000, 60
FILES = ("forest", "frames.lcmlog", "models/models_info.json", "models/names.json", "samples.json")


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300,
                          check=False, **options)  # fmt: skip
    assert done.returncode == 0, f"{words}: status {done.returncode}\n{done.stdout}"
    return done.stdout


def check_package(build, folder):
    run("cpack", "--config", build / "CPackConfig.cmake", "-D", "CPACK_COMPONENTS_ALL=samples", "-B", folder, cwd=build)
    packages = list(folder.glob("*.deb"))
    assert len(packages) == 1 and packages[0].name.startswith("houghstream-samples_"), packages
    size = packages[0].stat().st_size
    assert size < MOST_BYTES, f"{packages[0].name}: {size} bytes, expected less than {MOST_BYTES}"
    listed = run("dpkg-deb", "--contents", packages[0])
    for file in FILES:
        assert f"./usr/share/houghstream/samples/{file}\n" in listed, f"{file} is not in {packages[0].name}\n{listed}"
    assert re.search(r"^ Depends: houghstream \(= [\d.]+\)$", run("dpkg-deb", "--info", packages[0]), re.M)
    print(f"{packages[0].name}: {size / 1e6:.1f} MB")


def check_demo(build, home):
    for component in ("programs", "python", "samples"):
        run("cmake", "--install", build, "--prefix", home, "--component", component)
    image, begin = home / "found.png", time.monotonic()
    without_display = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY", "PYTHONPATH")}
    said = run(home / "bin/houghstream-demo", "--picture", image, cwd=home, env=without_display)
    seconds = time.monotonic() - begin
    found = sorted(re.findall(r"found (\w+) at ", said))
    assert found == ["bowl", "cereal_box", "coffee_mug", "soda_can"], said
    assert seconds < MOST_SECONDS, f"{seconds:.0f} s, expected less than {MOST_SECONDS}\n{said}"
    assert image.read_bytes()[:4] == b"\x89PNG"
    print(f"found {', '.join(found)}; from the command to the image {seconds:.1f} s")


def main():
    build = pathlib.Path(sys.argv[2]).resolve()
    if not (build / "samples/samples.json").is_file():
        print("skipped: no samples here; tools/demo, then cmake --build BUILD -t samples")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory(prefix="houghstream_samples_") as folder:
        check_demo(build, pathlib.Path(folder) / "usr")
        check_package(build, pathlib.Path(folder) / "packages")


if __name__ == "__main__":
    main()
