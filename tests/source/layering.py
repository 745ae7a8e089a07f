#!/usr/bin/env python3
"""Checks that every stage includes only itself and the stages before it.

usage: layering.py FOLDER... exit status 1 where an include goes against the order; src, and drivers as one stage of its own
       layering.py --self-test"""
import pathlib
import re
import sys
import tempfile

ORDER = ["image", "geometry", "edges", "flow", "map", "adjustment", "tracking", "mapping", "places", "pipeline", "dataset", "calibration", "benchmark", "drivers", "app", "library"]
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"/]+)/')


def violations(source):
    found = []
    paths = sorted(path for path in source.rglob("*") if path.suffix in (".h", ".cpp", ".in"))
    if not paths:
        found.append(f"{source}: no sources found")
    for path in paths:
        stage = "drivers" if source.name == "drivers" else path.relative_to(source).parts[0]
        if stage not in ORDER:
            found.append(f"{path}: no stage is called {stage}")
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match or match.group(1) == "edgeslam":  # the public headers
                continue
            included = match.group(1)
            if included not in ORDER:
                found.append(f"{path}:{number}: no stage is called {included}")
            elif ORDER.index(included) > ORDER.index(stage):
                found.append(f"{path}:{number}: {stage} comes before {included} and must not include it")
    return found


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder)
        for name, text in {"edges/good.h": '#include "edges/a.h"\n#include "image/b.h"\n#include "edgeslam/c.h"\n#include <map/d.h>\n',
                           "edges/late.cpp": '\n#include "tracking/e.h"\n', "flow/odd.cpp": '# include "utils/f.h"\n'}.items():
            (source / name).parent.mkdir(exist_ok=True)
            (source / name).write_text(text)
        found = [line.replace(folder + "/", "") for line in violations(source)]
        expected = ["edges/late.cpp:2: edges comes before tracking and must not include it", "flow/odd.cpp:1: no stage is called utils"]
        return [] if found == expected else [f"self-test: found {found}, expected {expected}"]


if __name__ == "__main__":
    problems = self_test() if sys.argv[1:] == ["--self-test"] else [line for folder in sys.argv[1:] for line in violations(pathlib.Path(folder))]
    print("\n".join(problems))
    sys.exit(1 if problems else 0)
