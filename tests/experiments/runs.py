"""What the experiments share: the command line, replays side by side on all cores, figures, and Markdown tables."""
import argparse
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile

FAILED = "X"   # the run gave no figure
NOTHING = "-"  # there is none to be had: the paper has none, or the sequence has no ground truth


class BadInput(Exception):
    """What a user can act on, in one line; ends the experiment with exit code 2."""


def parser_of(text):
    """The command line that every experiment takes; `text` is its help."""
    parser = argparse.ArgumentParser(
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description=text,
        epilog="Exit codes: 0 done, 1 a run failed (X in the table), 2 wrong use or bad input.")
    parser.add_argument("edgeslam", metavar="EDGESLAM", help="the program, say build/release/edgeslam")
    parser.add_argument("sequences", metavar="SEQUENCE_FOLDER", nargs="+",
                        help="a folder that edgeslam replay takes, with ground truth")
    return parser


def run_experiment(parser, experiment):
    """Calls experiment(arguments, work folder), which returns the summaries of its runs; returns the exit code."""
    arguments = parser.parse_args()
    try:
        if not (os.path.isfile(arguments.edgeslam) and os.access(arguments.edgeslam, os.X_OK)):
            raise BadInput(f"{arguments.edgeslam}: no such program")
        arguments.edgeslam = os.path.abspath(arguments.edgeslam)
        for sequence in arguments.sequences:
            if not os.path.isdir(sequence):
                raise BadInput(f"{sequence}: no such folder")
        with tempfile.TemporaryDirectory(prefix="edgeslam_") as work:
            summaries = experiment(arguments, work)
    except (BadInput, OSError) as problem:
        print(f"{parser.prog}: {problem}", file=sys.stderr)
        return 2
    return 1 if None in summaries else 0


def replay(edgeslam, sequence, settings, folder):
    """The summary of one run, or None where it failed. `settings` is the configuration's text."""
    os.makedirs(folder)
    configuration = os.path.join(folder, "settings.yaml")
    with open(configuration, "w", encoding="utf-8") as file:
        file.write(settings + "\n")
    results = os.path.join(folder, "results")
    run = subprocess.run(
        [edgeslam, "replay", sequence, "--config", configuration, "--drawings", "0", "--output", results],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace")
    told = (run.stderr.strip() or run.stdout.strip() or "it said nothing").splitlines()[-1]
    if run.returncode == 2:
        raise BadInput(told)
    if run.returncode != 0:
        print(f"{name_of(sequence)}: the run failed (exit code {run.returncode}): {told}", file=sys.stderr)
        return None
    try:
        with open(os.path.join(results, "summary.json"), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as problem:
        raise BadInput(f"{edgeslam}: its summary.json of {sequence} cannot be read: {problem}") from problem


def replay_all(edgeslam, runs, work):
    """Summaries of (sequence, settings) runs, in their order, as many at a time as there are cores."""
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        jobs = [pool.submit(replay, edgeslam, sequence, settings, os.path.join(work, f"run_{number}"))
                for number, (sequence, settings) in enumerate(runs)]
        try:
            return [job.result() for job in jobs]
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def name_of(sequence):
    return os.path.basename(os.path.abspath(sequence))


def paper_name(sequence):
    """The paper's name of a sequence, as edgeslam's report knows it: fr2_desk for rgbd_dataset_freiburg2_desk, office1
    for ICL-NUIM's."""
    name = re.sub(r"^(rgbd_dataset_|tum_)", "", name_of(sequence).lower())
    name = re.sub(r"^freiburg", "fr", name)
    office = re.fullmatch(r"(icl[_-])?(nuim[_-])?of(fice)?(_room)?[_-]?(traj|kt)?[_-]?([0-3])"
                          r"([_-]?frei[_-]png|[_-]?loop|n)?", name)
    return "office" + office.group(6) if office else name


def centimetres(error):
    """Of an error of summary.json, null where the poses cannot be compared."""
    return f"{100 * error['rmse_m']:.2f}" if error else FAILED


def trajectory_error(summary, of):
    """Absolute trajectory error [cm] of a run; `of` is "trajectory" (all frames) or "keyframes"."""
    if summary is None:
        return FAILED
    errors = summary["absolute_trajectory_error"]
    return centimetres(errors[of]) if errors else NOTHING


def rows_not_run(paper, sequences, our_columns):
    """The paper's rows of the sequences that were not run."""
    run = {paper_name(sequence) for sequence in sequences}
    return [[name] + [NOTHING] * our_columns + list(figures) for name, figures in paper.items() if name not in run]


def print_table(heading, rows):
    for row in (heading, ["---"] * len(heading), *rows):
        print("| " + " | ".join(str(cell) for cell in row) + " |")
