"""The sample .pmd and the systemd units start executables that exist, with options that they know; what --help says is so.

Usage: samples_test.py SOURCE_FOLDER EXECUTABLES_FOLDER
"""

import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE, EXECUTABLES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
SAMPLES = SOURCE / "tools" / "stream"


def check_command(test, name, words):
    """Every option of the command is one that the executable's help names."""
    words_of_help = subprocess.run([str(EXECUTABLES / name), "--help"], capture_output=True, text=True, check=True).stdout
    options = re.findall(r"--[a-z-]+", words)
    test.assertTrue(options)
    for option in options:
        test.assertRegex(words_of_help, rf"(?m)^ .*{option}\b", f"{name} {words}")


def help_of(*words):
    """Returns what --help of a program, or of a program's job, says."""
    return subprocess.run([str(EXECUTABLES / words[0]), *words[1:], "--help"], capture_output=True, text=True, check=False).stdout


def jobs_in(text):
    """The jobs that a help names."""
    listed = re.search(r"^Subcommands:\n(.*?)(?:\n\n|\Z)", text, re.M | re.S)
    return re.findall(r"^  ([a-z][a-z-]*) ", listed[1], re.M) if listed else []


def every_help(*words):
    """(command, what its --help says) of a program and of each of its jobs."""
    text = help_of(*words)
    yield " ".join(words), text
    for job in jobs_in(text):
        yield from every_help(*words, job)


class Help(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.helps = dict(pair for program in sorted(EXECUTABLES.glob("hs-*")) for pair in every_help(program.name))

    def test_it_fits_a_screen(self):
        columns, lines = 80, 50
        self.assertGreater(len(self.helps), 40)
        for command, text in self.helps.items():
            taken = sum(max(1, math.ceil(len(line) / columns)) for line in text.rstrip("\n").split("\n"))
            self.assertLessEqual(taken, lines, command)

    def test_it_ends_with_examples_whose_options_are_there(self):
        for command, text in self.helps.items():
            examples = text.partition("\n\nExamples:\n")[2].splitlines()
            self.assertTrue(examples, command)
            for example in examples:
                self.assertTrue(example.startswith("  $ ") and command in example, f"{command}: {example}")
                here = max((known for known in self.helps if known in example), key=len)
                for option in re.findall(r"(?<=\s)--?[a-z3][\w-]*", example[4:]):
                    self.assertIn(option, self.helps[here], example)

    def test_the_product_offers_no_settings_that_studies_alone_have(self):
        for word in ("gall", "pfh", "--scale-handling"):
            self.assertNotRegex(help_of("hs-train"), rf"(?<![\w-]){word}\b")
            self.assertRegex(help_of("hs-study", "train"), rf"(?<![\w-]){word}\b")

    def test_a_benchmark_names_its_own_options(self):
        self.assertIn("--scene", help_of("hs-study", "kernels"))

    def test_what_names_no_study_is_refused_in_one_line(self):
        for words, refusal in (
            ((), "hs-study: without a command, expected train, evaluate,"),
            (("nosuch",), "hs-study: unknown command 'nosuch', expected train, evaluate,"),
            (("-v", "pose"), "hs-study: the name of the study stands first: hs-study NAME --help"),
            (("pose", "--nosuch"), "hs-study pose: unknown option --nosuch"),
        ):
            done = subprocess.run([EXECUTABLES / "hs-study", *words], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode != 0, done.stdout, done.stderr.count("\n")), (True, "", 1), words)
            self.assertTrue(done.stderr.startswith(refusal), done.stderr)


class Configuration(unittest.TestCase):
    def test_what_init_prints_is_read_and_changes_nothing(self):
        programs = [program for program in sorted(EXECUTABLES.glob("hs-*")) if "init" in jobs_in(help_of(program.name))]
        self.assertIn("hs-stream", [program.name for program in programs])
        with tempfile.TemporaryDirectory() as folder:
            for program in programs:
                printed = subprocess.run([program, "init"], capture_output=True, text=True, check=True)
                file = pathlib.Path(folder) / f"{program.name}.toml"
                file.write_text(printed.stdout)
                # Without a store or a forest both end with the same line, before anything is started.
                without, read = (subprocess.run([program, *words], capture_output=True, text=True, check=False, timeout=60)
                                 for words in ((), ("--config", file)))  # fmt: skip
                self.assertEqual((read.returncode, read.stderr), (without.returncode, without.stderr), printed.stdout)
                self.assertIn("expected either --objects STORE or --forest FILE", read.stderr)


class Completion(unittest.TestCase):
    def completed(self, *words):
        """Returns what the last of the words may become."""
        script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _houghstream "$1"; printf "%s\\n" "${COMPREPLY[@]}"'
        words = (str(EXECUTABLES / words[0]), *words[1:])
        said = subprocess.run(["bash", "-c", script, "bash", str(SAMPLES / "bash_completion"), *words], capture_output=True,
                              text=True, check=True)  # fmt: skip
        return said.stdout.split()

    def test_jobs_wherever_one_is_awaited(self):
        self.assertEqual(self.completed("hs-log", "ex"), ["export"])
        self.assertEqual(self.completed("hs-log", "-v", "fi"), ["filter"])
        self.assertIn("objects-json", self.completed("hs-log", "export", ""))
        self.assertEqual(self.completed("hs-log", "info", ""), [])
        self.assertEqual(self.completed("hs-stream", "--objects", "in"), [], "that is a file")
        self.assertEqual(self.completed("hs-study", "li"), ["linemod"])

    def test_the_build_folder_has_one_to_source(self):
        script = 'source "$1" && complete -p hs-log hs-teach && COMP_WORDS=("$2" ex) COMP_CWORD=1 && _houghstream "$2" && echo "${COMPREPLY[@]}"'
        words = (EXECUTABLES.parent / "completion.bash", EXECUTABLES / "hs-log")
        said = subprocess.run(["bash", "-c", script, "bash", *map(str, words)], capture_output=True, text=True, check=True)
        self.assertEqual(said.stdout.splitlines()[-1], "export")
        self.assertEqual(said.stdout.count("-F _houghstream hs-"), 2, said.stdout)

    def test_options_of_the_job_that_help_lists(self):
        self.assertEqual(self.completed("hs-view", "--3"), ["--3d"])
        self.assertEqual(self.completed("hs-log", "export", "csv", "--"), ["--help", "--replace", "--verbose"])
        self.assertIn("--channels", self.completed("hs-log", "filter", "a", "--"))
        self.assertNotIn("--invert", self.completed("hs-log", "--"))
        self.assertEqual(self.completed("hs-stream", "--loo"), [])
        self.assertEqual(self.completed("hs-spy", "--he"), ["--help", "--heap"])
        self.assertEqual(self.completed("hs-study", "linemod", "--tu"), ["--tune"])


class Samples(unittest.TestCase):
    def test_pmd(self):
        commands = re.findall(r'exec = "build/bin/(\S+) ([^"]*)"', (SAMPLES / "houghstream.pmd").read_text())
        self.assertEqual([name for name, _ in commands], ["hs-capture", "hs-detect", "hs-pose", "hs-view"])
        for name, words in commands:
            check_command(self, name, words)

    def test_pmd_is_balanced(self):
        text = (SAMPLES / "houghstream.pmd").read_text()
        self.assertEqual(text.count("{"), text.count("}"))
        groups = set(re.findall(r'^group "(.*)"', text, re.M))
        self.assertEqual(set(re.findall(r'(?:start|stop) group "(.*)"', text)), groups)

    def test_units(self):
        settings = (SAMPLES / "systemd" / "houghstream.env").read_text()
        wanted = (SAMPLES / "systemd" / "houghstream.target").read_text()
        units = sorted((SAMPLES / "systemd").glob("*.service"))
        self.assertEqual(len(units), 3)
        for unit in units:
            text = unit.read_text()
            name, words = re.search(r'exec "\$HOUGHSTREAM_BIN/(\S+)" (.*)\'$', text, re.M).groups()
            check_command(self, name, words)
            self.assertIn(unit.name, wanted)
            for variable in re.findall(r"\$(HOUGHSTREAM_\w+)", text):
                self.assertRegex(settings, rf"(?m)^{variable}=")

    def test_a_unit_is_never_given_up_and_waits_longer_from_try_to_try(self):
        steps = []
        for unit in sorted((SAMPLES / "systemd").glob("*.service")):
            text = unit.read_text()
            self.assertIn("\nStartLimitIntervalSec=0\n", text)
            lines = re.search(r"^ExecStartPre=/bin/sh -c '(.*?)'$", text, re.M | re.S)[1]
            steps.append(lines.replace("\\\n", "").replace("$$", "$").replace("%%", "%"))
        self.assertEqual(len(set(steps)), 1)
        with tempfile.TemporaryDirectory() as folder:
            def pause(ago=0):
                """Returns how long the next start would wait, where the last one was `ago` seconds ago."""
                tries = pathlib.Path(folder) / "tries"
                if tries.exists():
                    _, deaths = tries.read_text().split()
                    tries.write_text(f"{int(time.time()) - ago} {deaths}\n")
                script = steps[0].replace("sleep ", "echo PAUSE ")
                said = subprocess.run(["/bin/sh", "-c", script], env={**os.environ, "RUNTIME_DIRECTORY": folder}, check=True,
                                      capture_output=True, text=True)  # fmt: skip
                self.assertEqual(said.stderr, "")
                return int(re.search(r"PAUSE (\d+)", said.stdout)[1])

            self.assertEqual([pause() for _ in range(11)], [0, 0, 1, 2, 4, 8, 16, 32, 64, 64, 64])
            self.assertEqual(pause(60), 0, "a run of a minute makes up for earlier ones")

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd here")
    def test_units_are_understood(self):
        with tempfile.TemporaryDirectory() as folder:
            for unit in (SAMPLES / "systemd").iterdir():
                shutil.copy(unit, folder)
            units = [str(path) for path in pathlib.Path(folder).glob("*.service")]
            environment = dict(os.environ, XDG_RUNTIME_DIR=folder)
            result = subprocess.run(["systemd-analyze", "--user", "verify", *units], capture_output=True, text=True,
                                    check=False, env=environment)
            complaints = [line for line in result.stderr.splitlines() if folder in line or "houghstream" in line]
            self.assertEqual(complaints, [])

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd here")
    def test_units_keep_to_what_a_stream_needs(self):
        units = [str(path) for path in (SAMPLES / "systemd").glob("*.service")]
        result = subprocess.run(["systemd-analyze", "security", "--offline=true", "--threshold=60", "--no-pager", *units],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
