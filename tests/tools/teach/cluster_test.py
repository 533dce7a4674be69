"""The scripts that share a teaching out: GNU parallel runs theirs where it is installed; Slurm's is run by a small sbatch of this test.

Usage: cluster_test.py SOURCE_FOLDER
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(sys.argv[1]).resolve() / "tools" / "teach" / "cluster"

# Writes down what it is asked for, and makes the store.
TEACH = """#!/bin/sh
echo "$*" >> "$LOG"
while [ "$1" != --out ] && [ $# -gt 0 ]; do shift; done
[ $# -eq 0 ] || mkdir -p "$2"
"""

# Runs a job at once: each task of an array.
SBATCH = """#!/bin/sh
job=$(mktemp) && cat > "$job"
for word; do case "$word" in --array=0-*) last=${word#--array=0-};; --dependency=*) [ "$word" = --dependency=afterok:77 ] || exit 9;; esac; done
for task in $(seq 0 "${last:-0}"); do SLURM_ARRAY_TASK_ID=$task sh "$job" || exit; done
echo 77
"""


class Cluster(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.models = self.folder / "bop models"
        self.models.mkdir()
        ids = {str(number): {} for number in (*range(1, 10), 21, 101, 102, 103, 104, 105, 106)}
        (self.models / "models_info.json").write_text(json.dumps(ids), encoding="utf-8")
        programs = self.folder / "bin"
        programs.mkdir()
        for name, text in (("hs-teach", TEACH), ("sbatch", SBATCH)):
            (programs / name).write_text(text, encoding="utf-8")
            (programs / name).chmod(0o755)
        self.log = self.folder / "log"
        self.environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "LOG": str(self.log)}
        self.out = self.folder / "a house"

    def start(self, script, *words):
        return subprocess.run([str(SCRIPTS / script), *map(str, words)], capture_output=True, text=True, timeout=60,
                              env=self.environment, check=False)

    def expect_taught(self):
        groups = ["1,2,3,4,5,6,7", "8,9,21,101,102,103,104", "105,106"]
        lines = self.log.read_text(encoding="utf-8").splitlines()
        parts = {group: f"{self.out}.parts/{group}.store" for group in groups}
        self.assertEqual(sorted(lines[:3]), sorted(
            f"mesh {self.models} --ids {group} --out {part} --threads 2" for group, part in parts.items()))
        self.assertEqual(lines[3:], [f"merge {' '.join(sorted(parts.values()))} --out {self.out}"])

    def test_ids_come_in_sevens(self):
        said = self.start("id_groups", self.models)
        self.assertEqual(said.stdout, "1,2,3,4,5,6,7\n8,9,21,101,102,103,104\n105,106\n")
        said = self.start("id_groups", self.folder)
        self.assertNotEqual(said.returncode, 0)
        self.assertEqual(said.stderr.count("\n"), 1, said.stderr)
        self.assertIn("models_info.json", said.stderr)

    def test_a_job_array_teaches_and_a_job_after_it_merges(self):
        said = self.start("teach_with_slurm", self.models, self.out)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.expect_taught()
        self.start("teach_with_slurm", self.models, self.out)
        lines = self.log.read_text(encoding="utf-8").splitlines()
        self.assertEqual([line.split()[0] for line in lines[4:]], ["merge"], "parts are not taught again")

    @unittest.skipUnless(shutil.which("parallel"), "not run: GNU parallel is not installed")
    def test_gnu_parallel_teaches_and_merges(self):
        said = self.start("teach_with_parallel", self.models, self.out, 2)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.expect_taught()

    def test_what_is_not_meant_is_refused_in_a_line(self):
        for script in ("id_groups", "teach_with_parallel", "teach_with_slurm"):
            said = self.start(script, "--nonsense")
            self.assertNotEqual(said.returncode, 0, script)
            self.assertEqual(said.stderr.count("\n"), 1, said.stderr)
            self.assertIn("--nonsense", said.stderr)
            self.assertIn(script, self.start(script, "--help").stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
