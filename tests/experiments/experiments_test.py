#!/usr/bin/env python3
"""Tests of the experiments: what their tables say is what the runs' summaries say.

usage: experiments_test.py PROGRAM SEQUENCE [test...]     SEQUENCE: a short recording in TUM layout with ground truth"""
import json
import math
import os
import random
import re
import stat
import struct
import subprocess
import sys
import tempfile
import unittest

import sequence_part
from runs import BadInput

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAM, SEQUENCE = (os.path.abspath(path) for path in sys.argv[1:3])
EXPERIMENTS = ["initialisation", "recoveries", "loop_closing"]

# Stands for the program: writes the summary that lies in the sequence's folder, or fails as the folder says.
STAND_IN = """#!/usr/bin/env python3
import os, shutil, sys
sequence, output = sys.argv[2], sys.argv[sys.argv.index("--output") + 1]
fails = os.path.join(sequence, "fails")
if os.path.exists(fails):
    print("edgeslam: " + sequence + ": a message", file=sys.stderr)
    sys.exit(int(open(fails).read()))
os.makedirs(output)
shutil.copy(os.path.join(sequence, "summary.json"), output)
"""
SUMMARY = {
    "initialisation": "flat start from frame 3 to frame 17, quality 40 of 50 edge pieces, parallax 1.00 deg, 90 points",
    "recoveries": 4, "relocalisations": 2, "states": {"lost": 7}, "coverage_from_first_pose": 0.98765,
    "closed_loops": [
        {"frame": 70, "how": "by its looks", "keyframe_error_before": {"rmse_m": 0.5}, "keyframe_error_after": None},
        {"frame": 90, "how": "by its points"}],
    "absolute_trajectory_error": {"trajectory": {"rmse_m": 0.0123}, "keyframes": {"rmse_m": 0.0456}},
}


class Outcome:
    def __init__(self, experiment, *arguments):
        run = subprocess.run([os.path.join(HERE, experiment), *arguments], capture_output=True, text=True, check=False)
        self.code, self.said = run.returncode, run.stderr
        table = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in run.stdout.splitlines()]
        self.heading, self.rows = (table[0], table[2:]) if table else ([], [])

    def columns(self, row, *names):
        return [self.rows[row][self.heading.index(name)] for name in names]


def program_summary(sequence, settings, folder):
    """What the program itself says of a run."""
    os.makedirs(folder)
    configuration = os.path.join(folder, "settings.yaml")
    with open(configuration, "w", encoding="utf-8") as file:
        file.write(settings + "\n")
    subprocess.run([PROGRAM, "replay", sequence, "--config", configuration, "--drawings", "0", "--output", folder],
                   check=True, capture_output=True)
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        return json.load(file)


def centimetres(summary, of):
    return f"{100 * summary['absolute_trajectory_error'][of]['rmse_m']:.2f}"


class WithFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.stand_in = self.write("edgeslam", STAND_IN)
        os.chmod(self.stand_in, stat.S_IRWXU)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def sequence(self, name, summary, fails=None):
        """A folder of 200 frames of which the stand-in for the program says this."""
        self.write(name + "/rgb.txt", "# time file\n" + "".join(f"{i} {i}.png\n" for i in range(200)))
        self.write(name + "/summary.json", json.dumps(summary))
        if fails is not None:
            self.write(name + "/fails", str(fails))
        return self.path(name)


class EveryExperiment(WithFolder):
    def test_wrong_use_and_bad_input_end_with_2_and_no_table(self):
        os.makedirs(self.path("empty"))
        for experiment in EXPERIMENTS:
            for arguments in ([], [PROGRAM], [self.path("nothing"), SEQUENCE], [PROGRAM, self.path("nothing")],
                              [HERE, SEQUENCE], [PROGRAM, self.path("empty")], [PROGRAM, SEQUENCE, "--nonsense"]):
                with self.subTest(experiment=experiment, arguments=arguments):
                    outcome = Outcome(experiment, *arguments)
                    self.assertEqual(outcome.code, 2)
                    self.assertEqual(outcome.rows, [])
                    self.assertIn(experiment + ": ", outcome.said)
                    self.assertNotIn("Traceback", outcome.said)

    def test_help(self):
        for experiment in EXPERIMENTS:
            outcome = Outcome(experiment, "--help")
            self.assertEqual((outcome.code, outcome.said), (0, ""), experiment)

    def test_bad_input_found_by_the_program_is_told_in_its_words(self):
        sequence = self.sequence("sequence", SUMMARY, fails=2)
        for experiment in EXPERIMENTS:
            outcome = Outcome(experiment, self.stand_in, sequence)
            self.assertEqual(outcome.code, 2, experiment)
            self.assertEqual(outcome.said.count("\n"), 1)
            self.assertIn(": a message", outcome.said)

    def test_a_failed_run_is_an_x_and_ends_with_1(self):
        good, bad = self.sequence("good", SUMMARY), self.sequence("bad", SUMMARY, fails=1)
        for experiment in EXPERIMENTS:
            outcome = Outcome(experiment, self.stand_in, good, bad)
            self.assertEqual(outcome.code, 1, experiment)
            self.assertIn("the run failed", outcome.said)
            by_name = {row[0]: row for row in outcome.rows}
            self.assertIn("X", by_name["bad"])
            self.assertNotIn("X", [cell for row in outcome.rows if row[0] != "bad" for cell in row[:2] + row[5:]])

    def test_without_ground_truth_there_is_no_error(self):
        blind = dict(SUMMARY, absolute_trajectory_error=None, closed_loops=[{"frame": 70, "how": "by its looks"}])
        sequence = self.sequence("blind", blind)
        for experiment, column in (("initialisation", "error [cm]"), ("recoveries", "error [cm]"),
                                   ("loop_closing", "run with loops [cm]")):
            outcome = Outcome(experiment, self.stand_in, sequence)
            self.assertEqual(outcome.code, 0, experiment)
            self.assertEqual(outcome.columns(0, column), ["-"])


class Initialisation(WithFolder):
    def test_table_says_what_the_summaries_say(self):
        frames, starts = 60, 2
        outcome = Outcome("initialisation", PROGRAM, SEQUENCE, "--frames", str(frames), "--starts", str(starts))
        self.assertEqual(outcome.code, 0, outcome.said)
        length = len(sequence_part.frame_lines(SEQUENCE))
        errors = []
        for row, first in enumerate([0, length - frames]):
            part = self.path(f"part_{row}")
            sequence_part.write_part(SEQUENCE, first, frames, part)
            expected = [os.path.basename(SEQUENCE), str(first)]
            for setting in ("", "initialisation: {least_quality: 0}"):
                summary = program_summary(part, setting, self.path(f"result_{row}_{bool(setting)}"))
                method, one, other, kept, pieces = re.match(
                    r"(.*) from frame (\d+) to frame (\d+), quality (\d+) of (\d+)", summary["initialisation"]).groups()
                error = centimetres(summary, "trajectory")
                errors.append(error)
                expected += [f"{method}, {first + int(one)} and {first + int(other)}", f"{kept} of {pieces}", error]
            self.assertEqual(outcome.rows[row], expected + ["-", "-"])
        self.assertEqual(outcome.rows[2][1], "median")
        self.assertEqual(outcome.rows[2][4], max(errors[0::2], key=float))  # the higher of two

    def test_paper_figure_stands_beside_its_sequence(self):
        sequence = self.sequence("rgbd_dataset_freiburg2_desk", SUMMARY)
        outcome = Outcome("initialisation", self.stand_in, sequence, "--starts", "3")
        paper = [outcome.columns(row, "paper with [cm]", "paper without [cm]") for row in range(3)]
        self.assertEqual(paper, [["0.48", "1.12"], ["-", "-"], ["-", "-"]])
        self.assertEqual([row[1] for row in outcome.rows], ["0", "41", "82", "median"])
        self.assertEqual(outcome.rows[1][2:5], ["flat start, 44 and 58", "40 of 50", "1.23"])

    def test_a_sequence_too_short_is_told(self):
        outcome = Outcome("initialisation", self.stand_in, self.sequence("short", SUMMARY), "--frames", "201")
        self.assertEqual(outcome.code, 2)
        self.assertIn("has 200 frames", outcome.said)


class Recoveries(WithFolder):
    def test_table_says_what_the_summary_says(self):
        outcome = Outcome("recoveries", PROGRAM, SEQUENCE)
        self.assertEqual(outcome.code, 0, outcome.said)
        summary = program_summary(SEQUENCE, "", self.path("result"))
        self.assertEqual(outcome.rows[0][1:6], [
            str(summary["recoveries"]), str(summary["relocalisations"]), str(summary["states"]["lost"]),
            f"{100 * summary['coverage_from_first_pose']:.1f}", centimetres(summary, "keyframes")])

    def test_paper_figures_stand_beside_theirs_and_the_others_below(self):
        outcome = Outcome("recoveries", self.stand_in, self.sequence("living_room_traj1_frei_png", SUMMARY),
                          self.sequence("office_room_traj1_loop", SUMMARY))
        self.assertEqual(outcome.rows[0][1:8], ["4", "2", "7", "98.8", "4.56", "-", "-"])
        self.assertEqual(outcome.rows[1][1:8], ["4", "2", "7", "98.8", "4.56", "5", "19.5"])
        self.assertEqual([row[0] for row in outcome.rows[2:]],
                         ["fr3_structure_notexture_near", "fr3_structure_notexture_far"])
        self.assertEqual(outcome.columns(3, "recoveries", "paper recoveries"), ["-", "7"])


class LoopClosing(WithFolder):
    def test_table_says_what_the_summaries_say(self):
        outcome = Outcome("loop_closing", PROGRAM, SEQUENCE)
        self.assertEqual(outcome.code, 0, outcome.said)
        summary = program_summary(SEQUENCE, "", self.path("with"))
        without = program_summary(SEQUENCE, "loops: {enabled: false}", self.path("without"))
        self.assertEqual(without["closed_loops"], [])
        loops = summary["closed_loops"]
        self.assertGreater(len(loops), 0, "the recording returns to its start")
        for row, loop in enumerate(loops):
            self.assertEqual(outcome.rows[row][1:5], [
                str(loop["frame"]), loop["how"], f"{100 * loop['keyframe_error_before']['rmse_m']:.2f}",
                f"{100 * loop['keyframe_error_after']['rmse_m']:.2f}"])
        self.assertEqual(outcome.rows[0][5:7], [centimetres(without, "keyframes"), centimetres(summary, "keyframes")])

    def test_every_loop_has_a_row_and_the_paper_its_figures(self):
        outcome = Outcome("loop_closing", self.stand_in, self.sequence("fr2_desk", SUMMARY),
                          self.sequence("straight", dict(SUMMARY, closed_loops=[])))
        self.assertEqual(outcome.rows, [
            ["fr2_desk", "70", "by its looks", "50.00", "X", "4.56", "4.56", "9.5", "1.75"],
            ["fr2_desk", "90", "by its points", "-", "-", "-", "-", "-", "-"],
            ["straight", "-", "-", "-", "-", "4.56", "4.56", "-", "-"]])


class PoseUncertainty(WithFolder):
    """Poses with errors of known size, in a map turned, scaled and shifted against the truth."""
    SIGMA_M, SIGMA_RAD = 0.01, 0.004  # in map units, and as stated

    def setUp(self):
        super().setUp()
        if subprocess.run(["/usr/bin/python3", "-c", "import numpy"], capture_output=True, check=False).returncode != 0:
            self.skipTest("no numpy (Debian: python3-numpy)")

    def write_run(self, name, times_stated, outlying=0):
        """A run whose errors are `times_stated` times what it states; of the first `outlying` poses 100 times."""
        noise = random.Random(1)
        scale, turn, shift = 2.5, (math.sin(0.4), 0.0, 0.0, math.cos(0.4)), (3.0, -1.0, 2.0)
        columns = [*("live_" + name for name in ("world", "x", "y", "z", "qx", "qy", "qz", "qw")),
                   *("sigma_" + name for name in ("x", "y", "z", "rx_rad", "ry_rad", "rz_rad"))]
        truth, rows = [], [",".join(["time_s", "state", *columns])]
        for i in range(600):
            seconds = 0.1 * i
            place = (math.sin(seconds), math.cos(1.3 * seconds), math.sin(0.7 * seconds))
            rotation = product((0.0, math.sin(0.1 * seconds), 0.0, math.cos(0.1 * seconds)),
                               (0.0, 0.0, math.sin(seconds), math.cos(seconds)))
            size = times_stated * (100 if i < outlying else 1)
            off = turned(rotation, [size * noise.gauss(0, self.SIGMA_M) for _ in range(3)])
            small = [0.5 * size * noise.gauss(0, self.SIGMA_RAD) for _ in range(3)]
            measured = product(rotation, (*small, 1.0))
            pose = [place[k] + off[k] for k in range(3)] + list(measured)
            sigmas = [self.SIGMA_M] * 3 + [self.SIGMA_RAD] * 3
            rows.append(",".join(map(str, [seconds, "tracking", 0, *pose, *sigmas])))
            at = turned(turn, place)
            true_place = [scale * at[k] + shift[k] for k in range(3)]
            truth.append(" ".join(map(str, [seconds + 0.001, *true_place, *product(turn, rotation)])))
        rows.insert(1, "0,initialising" + "," * 14)
        rows.insert(2, "0.05,predicted,0," + ",".join(["9"] * 13))
        rows.extend(f"{60 + i},tracking,1," + ",".join(["9"] * 13) for i in range(5))  # in another world
        self.write(name + "/frames.csv", "\n".join(rows) + "\n")
        self.write(name + "_truth/groundtruth.txt", "# time pose\n" + "\n".join(truth) + "\n")
        return self.path(name), self.path(name + "_truth")

    def figures(self, *run):
        outcome = Outcome("pose_uncertainty", *run)
        self.assertEqual(outcome.code, 0, outcome.said)
        return [[float(cell) for cell in row[1:]] for row in outcome.rows]

    def test_errors_as_stated_give_one_and_ones_of_three_times_their_size_nine(self):
        honest, sure = self.figures(*self.write_run("honest", 1), *self.write_run("sure", 3))
        for poses, *figures in (honest, sure):
            self.assertEqual(poses, 600)
        for figure in honest[1::2]:
            self.assertAlmostEqual(figure, 1, delta=0.15)
        for beyond in honest[2::2]:
            self.assertLess(beyond, 3)
        for figure in sure[1::2]:
            self.assertAlmostEqual(figure, 9, delta=1.4)
        for beyond in sure[2::2]:
            self.assertAlmostEqual(beyond, 74, delta=8)  # chi squared of three: P(x > 11.345 / 9)

    def test_poses_that_are_far_off_do_not_spoil_the_others(self):
        [figures] = self.figures(*self.write_run("outlying", 1, outlying=30))
        self.assertAlmostEqual(figures[2], 6, delta=2)  # 5 % outlying and 1 % of the others
        self.assertAlmostEqual(figures[4], 6, delta=2)

    def test_bad_input_is_told(self):
        run, truth = self.write_run("run", 1)
        elsewhere = os.path.dirname(self.write("elsewhere/groundtruth.txt", "1e6 0 0 0 0 0 0 1\n1e7 0 0 0 0 0 0 1\n"))
        broken = os.path.dirname(self.write("broken/groundtruth.txt", "1 2 three\n"))
        for arguments in ([], [run], [run, self.path("nothing")], [truth, truth], [run, elsewhere], [run, broken]):
            with self.subTest(arguments=arguments):
                outcome = Outcome("pose_uncertainty", *arguments)
                self.assertEqual((outcome.code, outcome.rows), (2, []))
                self.assertIn("pose_uncertainty: ", outcome.said)
                self.assertNotIn("Traceback", outcome.said)


def product(a, b):
    """Of quaternions x y z w."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def turned(rotation, vector):
    x, y, z, w = rotation
    return product(product(rotation, (*vector, 0.0)), (-x, -y, -z, w))[:3]


def box(kind, content):
    return struct.pack(">I4s", 8 + len(content), kind.encode()) + content


def video(edits=1, intervals=1):
    """A film of 100 frames of 512 ticks at 15,360 ticks a second, without pictures."""
    clock = struct.pack(">4x8xII", 1000, 6666)
    edit = box("edts", box("elst", struct.pack(">4xI", edits) + struct.pack(">IiI", 3333, 1024, 1 << 16) * edits))
    times = box("stts", struct.pack(">4xI", intervals) + struct.pack(">II", 100, 512) * intervals)
    media = box("mdia", box("mdhd", struct.pack(">4x8xII", 15360, 51200)) + box("minf", box("stbl", times)))
    return box("ftyp", b"isom") + box("mdat", b"\1" * 50) + box("moov", box("mvhd", clock) + box("trak", edit + media))


class SequencePart(WithFolder):
    def test_euroc_folder(self):
        self.write("euroc/mav0/cam0/data.csv", "#time,file\n" + "".join(f"{i},{i}.png\n" for i in range(10)))
        self.write("euroc/mav0/cam0/data/4.png", "a picture")
        self.write("euroc/mav0/state_groundtruth_estimate0/data.csv", "poses")
        sequence_part.write_part(self.path("euroc"), 4, 3, self.path("part"))
        self.assertEqual(sequence_part.frame_lines(self.path("part")), ["4,4.png\n", "5,5.png\n", "6,6.png\n"])
        for linked in ("cam0/data/4.png", "state_groundtruth_estimate0/data.csv"):
            self.assertTrue(os.path.samefile(self.path("euroc/mav0/" + linked), self.path("part/mav0/" + linked)))

    def video_sequence(self, data):
        self.write("film/times.txt", "".join(f"{i}\n" for i in range(100)))
        with open(self.path("film/video.mp4"), "wb") as file:
            file.write(data)
        return self.path("film")

    def test_video_is_shown_in_part(self):
        whole = video()
        sequence_part.write_part(self.video_sequence(whole), 30, 50, self.path("part"))
        with open(self.path("part/video.mp4"), "rb") as file:
            part = file.read()
        edit = whole.index(b"elst") + 4
        duration, start = struct.unpack_from(">Ii", part, edit + 8)
        self.assertEqual(start, 1024 + 30 * 512)
        self.assertEqual(duration, 1666)  # of 1666.67 ms: one more and frame 51 would be shown
        self.assertEqual(part[:edit + 8] + part[edit + 16:], whole[:edit + 8] + whole[edit + 16:])
        with open(self.path("film/video.mp4"), "rb") as file:
            self.assertEqual(file.read(), whole)
        self.assertEqual(len(sequence_part.frame_lines(self.path("part"))), 50)

    def test_other_videos_are_refused_in_words(self):
        whole = video()
        for number, data in enumerate([video(edits=2), video(intervals=2), b"", b"no film", whole[:-40], whole[:120],
                                       whole.replace(b"elst", b"free"), b"\0" * 100]):
            with self.subTest(number=number), self.assertRaises(BadInput):
                sequence_part.write_part(self.video_sequence(data), 0, 50, self.path(f"part_{number}"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
