#!/usr/bin/env python3
"""Runs every `edgeslam ...` command that the documentation has: in a folder with recordings, configurations and runs of the
names that it uses, and without a camera or a network. A command that is refused fails, as does one whose options
--help does not know, and one that cannot be run as it stands and is not in how_they_run.py.

usage: documented_commands_test.py PROGRAM REPOSITORY RECORDING BOARD_FRAMES SWINGING [test...]
RECORDING: a simulated one with ground truth; BOARD_FRAMES: of a chessboard 9x6:25mm; SWINGING: a simulated recording
that tells how its inertial unit sits"""
import functools
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import how_they_run
from documentation import Command, commands_of, configurations_of

PROGRAM, REPOSITORY, RECORDING, BOARD_FRAMES, SWINGING = (pathlib.Path(path).resolve() for path in sys.argv[1:6])
LONGEST_S = 400  # a busy machine
# Messages go to a file and come from one: no network is needed.
ENVIRONMENT = {**os.environ, "LCM_DEFAULT_URL": "file://sent.log?mode=w"}
HEARD = "file://heard.log?speed=0"


def pages():
    """{page's name, as docs/calibrating.md: its text}"""
    found = [path for pattern in ("*.md", "docs/**/*.md") for path in sorted(REPOSITORY.glob(pattern))]
    return {str(path.relative_to(REPOSITORY)): path.read_text(encoding="utf-8") for path in found}


def documented():
    """{page's name: its commands}"""
    return {name: commands_of(text) for name, text in pages().items()}


def run(words, folder, **environment):
    if words[0] == "edgeslam":
        words = [str(PROGRAM), *words[1:]]
    return subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace", timeout=LONGEST_S, env={**ENVIRONMENT, **environment}, check=False)


@functools.lru_cache(maxsize=None)
def options_of_help(subcommand):
    """A failure where there is no such subcommand."""
    outcome = run(["edgeslam", *subcommand, "--help"], REPOSITORY)
    if outcome.returncode != 0:
        raise AssertionError(f"`edgeslam {' '.join(subcommand)} --help`: {outcome.stdout}")
    return set(re.findall(r"^ +(?:-\w,)?(--[a-z][a-z-]*)", outcome.stdout, re.M))


class Prepared:
    """What the pages name. Made once, then copied for each page: pages do not disturb each other."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.copy(RECORDING, "my_recording")
        self.copy(RECORDING / "groundtruth.txt", "groundtruth.txt")
        self.copy(RECORDING, "my_data/first")
        self.copy(RECORDING, "my_data/second")
        self.copy(BOARD_FRAMES, "board_camera")
        (self.folder / "swinging").symlink_to(SWINGING)  # large, and only read
        # Not to find a board in many frames takes longer than to find one.
        self.expect("edgeslam", "simulate", "panels_textured", "--output", "short", "--width", "320", "--height", "240",
                    "--frames", "40", "--imu")
        self.copy(RECORDING / "camera.yaml", "cameras/my_camera.yaml")
        self.write("my_robot.yaml", "camera: {calibration: my_recording/camera.yaml}\ncapture: {device: my_recording}\n")
        self.write("changed.yaml", "camera: {calibration: my_recording/camera.yaml}\npoints: {count: 400}\n")
        self.write("board_robot.yaml", "capture: {device: board_camera}\n")
        for name in ("before", "after", "result"):
            self.expect("edgeslam", "replay", "my_recording", "--output", name, "--drawings", "1", "--map-out", "saved.map")
        for name in ("robot.map", "morning.map", "evening.map"):
            self.copy(self.folder / "saved.map", name)
        self.expect("edgeslam", "run", "--config", "my_robot.yaml", "--record", "failure",
                    LCM_DEFAULT_URL="file://heard.log?mode=w")
        self.expect("edgeslam", "benchmark", "my_data", "--output", "all")

    def copy(self, source, name):
        target = self.folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if source.is_dir() else shutil.copyfile)(source, target)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def expect(self, *words, **environment):
        outcome = run(words, self.folder, **environment)
        assert outcome.returncode == 0, f"{words}: {outcome.stdout}"

    def for_page(self, page, folder):
        """A copy, less what the page's own commands make."""
        target = pathlib.Path(folder) / page.replace("/", "_")
        shutil.copytree(self.folder, target, symlinks=True)
        if page in ("docs/debugging.md",):
            shutil.rmtree(target / "failure")
        if page in ("docs/calibrating.md",):  # its robot's camera looks at the board
            shutil.copyfile(target / "board_robot.yaml", target / "my_robot.yaml")
        return target


class DocumentedCommands(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="edgeslam_documented_")
        cls.addClassCleanup(cls.folder.cleanup)
        base = os.path.join(cls.folder.name, "prepared")
        os.mkdir(base)
        cls.prepared = Prepared(base)

    def test_every_command_runs(self):
        ran = 0
        for page, commands in documented().items():
            folder = self.prepared.for_page(page, self.folder.name)
            done = set()
            for command in commands:
                if command.text in done or command.is_name:
                    continue
                done.add(command.text)
                with self.subTest(page=page, command=command.text):
                    began = time.monotonic()
                    self.run_one(command, folder)
                    ran += 1
                    print(f"{time.monotonic() - began:6.1f} s  {page}: {command.text}", flush=True)
        self.assertGreater(ran, 40, "are the commands still found?")

    def run_one(self, command, folder):
        instead = how_they_run.INSTEAD.get(command.text)
        if instead:
            for name in instead.removes:
                (folder / name).unlink()
            for text in instead.commands:
                self.run_instead(text, instead, folder)
            return
        is_ours = command.words[0] == "edgeslam"
        self.assertFalse(is_ours and command.is_template,
                         "cannot be run as it stands: say in how_they_run.py how it is run")
        words = command.words if is_ours else ["bash", "-o", "pipefail", "-c", command.text]
        outcome = run(words, folder)
        finds_nothing = words[0] == "bash" and command.text.startswith("grep ") and outcome.returncode == 1
        self.assertTrue(outcome.returncode == 0 or finds_nothing, f"exit code {outcome.returncode}: {outcome.stdout}")

    def run_instead(self, text, instead, folder):
        if instead.until:
            return self.run_until(shlex.split(text), instead.until, folder)
        outcome = run(shlex.split(text), folder)
        self.assertEqual(outcome.returncode, instead.exit_code, f"{text}: {outcome.stdout}")
        self.assertIn(instead.says, outcome.stdout)

    def run_until(self, words, said, folder):
        with open(folder / "said.txt", "w+", encoding="utf-8") as file, subprocess.Popen(
                [PROGRAM, *words[1:]], cwd=folder, stdin=subprocess.DEVNULL, stdout=file, stderr=file,
                env={**ENVIRONMENT, "LCM_DEFAULT_URL": HEARD}) as process:
            def output():
                return pathlib.Path(file.name).read_text(encoding="utf-8")
            try:
                end = time.monotonic() + LONGEST_S
                while said not in output() and process.poll() is None and time.monotonic() < end:
                    time.sleep(0.05)
                process.send_signal(signal.SIGINT)
                exit_code = process.wait(timeout=LONGEST_S)
                self.assertIn(said, output(), f"{words}: exit code {exit_code}")
                came_to_its_end = f"{HEARD} ended" in output()  # the file of messages: before Ctrl-C came
                self.assertIn(exit_code, (0, -signal.SIGINT, *([2] if came_to_its_end else [])), output())
            finally:
                process.kill()

    def test_every_configuration_is_a_good_one(self):
        checked = 0
        for page, markdown in pages().items():
            folder = self.prepared.for_page("configurations/" + page, self.folder.name)
            shutil.copyfile(folder / "cameras/my_camera.yaml", folder / "camera.yaml")
            write_mask_of((folder / "camera.yaml").read_text(encoding="utf-8"), folder / "mask.png")
            for text in configurations_of(markdown):
                if text in how_they_run.NO_CONFIGURATIONS:
                    continue
                with self.subTest(page=page, configuration=text):
                    for placeholder, value in how_they_run.IN_CONFIGURATIONS.items():
                        text = re.sub(rf"(?<![\w]){re.escape(placeholder)}(?![\w])", value, text)
                    (folder / "documented.yaml").write_text(text, encoding="utf-8")
                    outcome = run(["edgeslam", "check-config", "documented.yaml"], folder)
                    self.assertEqual(outcome.returncode, 0, outcome.stdout)
                    checked += 1
        self.assertGreater(checked, 15, "are the configurations still found?")


def write_mask_of(calibration, path):
    """Black in its upper half; what format it is in the file itself says."""
    width, height = (int(re.search(rf"^{key}: *(\d+)", calibration, re.M).group(1)) for key in ("width", "height"))
    half = width * (height // 2)
    path.write_bytes(b"P5\n%d %d\n255\n" % (width, height) + bytes(half) + b"\xff" * (width * height - half))


class DocumentedOptions(unittest.TestCase):
    def test_help_knows_every_option(self):
        for page, commands in documented().items():
            for command in commands:
                if command.words[0] != "edgeslam":
                    continue
                with self.subTest(page=page, command=command.text):
                    self.assertLessEqual(set(command.options), options_of_help(tuple(command.subcommand)))

    def test_what_is_run_instead_is_documented_and_has_all_of_its_options(self):
        texts = {command.text for commands in documented().values() for command in commands}
        for text, instead in how_they_run.INSTEAD.items():
            with self.subTest(command=text):
                self.assertIn(text, texts, "is not documented any more")
                run_options = {option for ran in instead.commands for option in Command(ran, True).options}
                self.assertLessEqual(set(Command(text, True).options), run_options)
                self.assertTrue(instead.reason)

    def test_every_subcommand_is_documented(self):
        listed = run(["edgeslam", "--help"], REPOSITORY).stdout.split("Subcommands:")[1]
        subcommands = re.findall(r"^  ([a-z-]+)", listed, re.M)
        self.assertGreater(len(subcommands), 10)
        synopses = {command.subcommand[0] for commands in documented().values() for command in commands
                    if command.is_code and command.subcommand}
        for subcommand in subcommands:
            self.assertIn(subcommand, synopses)


class Extraction(unittest.TestCase):
    PAGE = """Text with `edgeslam run` and `edgeslam replay
that --output goes_on`, not `include/edgeslam`.

    $ edgeslam benchmark my_data     # a comment
    table       of   results
    edgeslam record [DEVICE] --output DIR
                    [--frames N]
    cp -r a b && rm b/c

- a list

      build/release/edgeslam view FILE

    viewer: {enabled: true}   # in a block

and `lcm: {ttl: 1}` in a sentence; `a::b: {c}` is none.
"""

    def test_commands(self):
        found = commands_of(self.PAGE)
        self.assertEqual([command.text for command in found], [
            "edgeslam run", "edgeslam replay that --output goes_on", "edgeslam benchmark my_data",
            "edgeslam record [DEVICE] --output DIR [--frames N]", "cp -r a b && rm b/c", "edgeslam view FILE"])
        self.assertEqual([command.is_name for command in found], [True, False, False, False, False, False])
        self.assertEqual([command.is_template for command in found], [False, False, False, True, False, True])
        self.assertEqual(found[3].options, ["--frames", "--output"])
        self.assertEqual(Command("edgeslam calibrate board --columns 9", True).subcommand, ["calibrate", "board"])
        self.assertEqual(Command("edgeslam calibrate frames --board x", True).subcommand, ["calibrate"])
        self.assertEqual(Command("edgeslam map join a.map b.map", True).subcommand, ["map", "join"])

    def test_configurations(self):
        self.assertEqual(configurations_of(self.PAGE), ["viewer: {enabled: true}   # in a block\n", "lcm: {ttl: 1}\n"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[6:]])
