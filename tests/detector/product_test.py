"""Which programs hold code that exists for comparisons only: product_test.py NM PRODUCT... -- STUDY..."""

import re
import subprocess
import sys

BASELINE = re.compile(r"houghstream::baseline::|scale_space|honv|pfh|curvature_|reference_", re.IGNORECASE)


def baseline_symbols(nm, program):
    listed = subprocess.run([nm, "--demangle", program], check=True, capture_output=True, text=True).stdout
    return [line for line in listed.splitlines() if BASELINE.search(line)]


def main(nm, programs):
    failures = 0
    border = programs.index("--")
    for program in programs[:border]:
        for line in baseline_symbols(nm, program)[:5]:
            print(f"{program}: holds {line}, expected nothing of detector/baseline")
            failures += 1
    for program in programs[border + 1 :]:  # else nothing would be found anywhere
        if not baseline_symbols(nm, program):
            print(f"{program}: holds nothing of detector/baseline, expected its symbols")
            failures += 1
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
