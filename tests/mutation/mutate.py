#!/usr/bin/env python3
"""Breaks thresholds and signs of the core one at a time, and says which of these mutants no unit test notices.

usage: mutate.py BUILD [--each N] [--only STAGE/FILE,...] [--seed N] [--jobs N] [--report FILE]

BUILD is a configured build folder of this source tree with the tests. For every mutant the file is changed in place, the tests of
its stage are built and run, and the file is put back, also after Ctrl-C. Mutants that do not compile are left out. Exit code 1: the
tests failed before anything was broken.
"""
import argparse
import pathlib
import random
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# What a pose comes from, in the order of the stages.
CORE = '''image/halving geometry/camera geometry/epipolar geometry/relative_rotation geometry/three_point_pose geometry/three_view_check
geometry/triangulation geometry/resectioning geometry/similarity edges/structure_tensor edges/zero_crossing edges/thinning
edges/edge_detection edges/point_choice edges/blur_gate flow/patch_alignment flow/optical_flow map/map map/map_check
adjustment/pose_adjustment adjustment/bundle_linearization adjustment/bundle_minimization adjustment/reduced_solver
adjustment/pose_graph tracking/keyframe_selection tracking/pose_estimation tracking/point_following tracking/patch_refinement
tracking/map_search mapping/culling mapping/new_points mapping/local_adjustment mapping/map_uncertainty
places/loop_verification places/guided_matching places/guided_search places/loop_search places/similarity_estimation'''.split()

# Pattern and what takes its place. A pattern is looked for in code, never in comments, texts or includes.
BREAKS = [
    ('comparison turned', re.compile(r'(?<=[\w\])] )<(?= )'), '>'),
    ('comparison turned', re.compile(r'(?<=[\w\])] )>(?= )'), '<'),
    ('comparison turned', re.compile(r'(?<= )<=(?= )'), '>'),
    ('comparison turned', re.compile(r'(?<= )>=(?= )'), '<'),
    ('sign turned', re.compile(r'(?<= )\+(?= )'), '-'),
    ('sign turned', re.compile(r'(?<=[\w\])] )-(?= )'), '+'),
    ('sign dropped', re.compile(r'(?<=[=(,] )-(?=[\w(])|(?<=return )-(?=[\w(])'), ''),
    ('and for or', re.compile(r'(?<= )&&(?= )'), '||'),
    ('or for and', re.compile(r'(?<= )\|\|(?= )'), '&&'),
    ('equal for unequal', re.compile(r'(?<= )==(?= )'), '!='),
    ('threshold doubled', re.compile(r'(?<![\w.])(?:\d+\.\d+|[2-9]|[1-9]\d+)(?![\w.]|e-)(?=[fLu]?\b)'), None),
]


def code_of(line):
    """The line with comments and texts blanked, of the same length."""
    line = re.sub(r'"(?:\\.|[^"\\])*"', lambda text: ' ' * len(text.group()), line)
    return re.sub(r'//.*', lambda text: ' ' * len(text.group()), line)


def mutants_of(path):
    found = []
    for number, line in enumerate(path.read_text().splitlines()):
        code = code_of(line)
        if code.lstrip().startswith('#') or 'template' in code or 'assert' in code:
            continue
        for name, pattern, replacement in BREAKS:
            for match in pattern.finditer(code):
                new = replacement if replacement is not None else f'(2 * {match.group()})'
                if replacement is None and re.search(r'<(?:[\w:]+, )*$', code[:match.start()]):
                    continue  # an argument of a template, a size
                found.append((number, name, line, line[:match.start()] + new + line[match.end():]))
    return found


def build_and_test(build, stage, jobs):
    """'killed', 'survived', or 'no build' with what the compiler said."""
    program = f'{stage}_tests'
    built = subprocess.run(['cmake', '--build', build, '-j', str(jobs), '--target', program], capture_output=True, text=True)
    if built.returncode != 0:
        return 'no build', built.stdout[-2000:]
    try:
        run = subprocess.run([f'{build}/{program}', '--gtest_brief=1', '--gtest_fail_fast', '--gtest_filter=-*Speed*'], cwd=build,
                             capture_output=True, text=True, errors='replace', timeout=300)
    except subprocess.TimeoutExpired:
        return 'killed', 'does not end'
    return ('survived', '') if run.returncode == 0 else ('killed', run.stdout[-2000:])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build')
    parser.add_argument('--each', type=int, default=4, help='mutants of each file (default 4; 0: all)')
    parser.add_argument('--only', help='files, as STAGE/FILE without its ending')
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--report', help='Markdown file for the survivors')
    options = parser.parse_args()
    options.build = str(pathlib.Path(options.build).resolve())
    names = options.only.split(',') if options.only else CORE
    for stage in sorted({name.split('/')[0] for name in names}):
        outcome, said = build_and_test(options.build, stage, options.jobs)
        if outcome != 'survived':
            sys.exit(f'{stage}: {outcome} before anything was broken\n{said}')
    counts, survivors, begin = {'killed': 0, 'survived': 0, 'no build': 0}, [], time.time()
    for name in names:
        path = ROOT / 'src' / f'{name}.cpp'
        mutants = mutants_of(path)
        if options.each:
            random.Random(f'{options.seed} {name}').shuffle(mutants)
            mutants = sorted(mutants[:options.each])
        whole = path.read_text()
        for number, kind, before, after in mutants:
            lines = whole.splitlines(keepends=True)
            lines[number] = after + '\n'
            try:
                path.write_text(''.join(lines))
                outcome, _ = build_and_test(options.build, name.split('/')[0], options.jobs)
            finally:
                path.write_text(whole)
            counts[outcome] += 1
            print(f'{outcome:9} {name}.cpp:{number + 1} {kind}: {after.strip()}', flush=True)
            if outcome == 'survived':
                survivors.append((name, number + 1, kind, before.strip(), after.strip()))
    print(f'{counts["killed"]} killed, {counts["survived"]} survived, {counts["no build"]} did not compile; '
          f'{(time.time() - begin) / 60:.0f} min')
    if options.report:
        with open(options.report, 'w') as file:
            file.write('| place | was | became | why no test fails |\n|---|---|---|---|\n')
            for name, number, kind, before, after in survivors:
                cells = [f'{name}.cpp:{number}'] + [f'`{text}`'.replace('|', '\\|') for text in (before, after)]
                file.write(f'| {" | ".join(cells)} | |\n')


if __name__ == '__main__':
    main()
