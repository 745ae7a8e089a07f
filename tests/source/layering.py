#!/usr/bin/env python3
"""Checks that every stage includes only itself and the stages before it, and that CMake links it to just those.

usage: layering.py REPOSITORY     exit status 1 where an include goes against the order, or a link and the includes differ
       layering.py --self-test"""
import pathlib
import re
import sys
import tempfile

ORDER = ["files", "plugins", "image_formats", "geometry", "samples", "inertia", "wheels", "frames", "image", "edges", "flow", "map", "adjustment", "tracking", "visual_odometry", "mapping", "places",
         "pipeline", "recording", "scale", "evaluation", "report", "benchmark", "simulator", "calibration", "drivers/frame_capture",
         "drivers/v4l2", "drivers/libcamera", "drivers/replay", "drivers/cameras", "drivers/lcm", "drivers/ros2", "drivers/viewer",
         "configuration", "library", "service", "app"]
INCLUDE = re.compile(r'^\s*#\s*include\s*"((?:drivers/)?[^"/]+)/')
# Programs of their own, built as a user builds them.
LEFT_OUT = {"drivers/lcm/examples"}


def stage_of(path, repository):
    parts = path.relative_to(repository).parts
    return parts[1] if parts[0] == "src" else "/".join(parts[:2])


def includes(repository):
    """({stage: stages that it includes}, what is wrong)."""
    found, problems = {}, []
    paths = sorted(path for root in ("src", "drivers") for path in (repository / root).rglob("*") if path.suffix in (".h", ".cpp", ".in"))
    if not paths:
        problems.append(f"{repository}: no sources found")
    for path in paths:
        name = path.relative_to(repository).as_posix()
        if any(name.startswith(folder + "/") for folder in LEFT_OUT):
            continue
        stage = stage_of(path, repository)
        if stage not in ORDER:
            problems.append(f"{name}: no stage is called {stage}")
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match or match.group(1) in ("edgeslam", stage):  # the public headers, and messages
                continue
            included = match.group(1)
            if included not in ORDER:
                problems.append(f"{name}:{number}: no stage is called {included}")
            elif ORDER.index(included) > ORDER.index(stage):
                problems.append(f"{name}:{number}: {stage} comes before {included} and must not include it")
            else:
                found.setdefault(stage, set()).add(included)
    return found, problems


def links(text, folder):
    """{stage: stages that it is linked to} by a CMakeLists.txt in src/, drivers/ or drivers/lcm/."""
    found = {}
    by_target = {stage.rpartition("/")[2]: stage for stage in ORDER}
    # Each driver's first definition counts; the others are of builds without it.
    calls = re.findall(r"^\s*edgeslam_(?:stage|driver)\((\w+)([^)]*)\)", text, re.M)
    if folder == "drivers/lcm":
        calls = re.findall(r"target_link_libraries\(edgeslam_(lcm) PUBLIC([^)]*)\)", text)
    for name, rest in calls:
        linked = {by_target[target] for target in re.findall(r"\bedgeslam_(\w+)", rest) if target in by_target}
        found.setdefault(by_target[name], linked)
    return found


def differing_links(included, linked):
    problems = []
    for stage in ORDER:
        missing = included.get(stage, set()) - linked.get(stage, set())
        needless = linked.get(stage, set()) - included.get(stage, set())
        problems += [f"{stage} includes {other} and is not linked to it" for other in sorted(missing)]
        problems += [f"{stage} is linked to {other} and does not include it" for other in sorted(needless)]
    return problems


def check(repository):
    included, problems = includes(repository)
    linked = {}
    for folder in ("src", "drivers", "drivers/lcm"):
        linked.update(links((repository / folder / "CMakeLists.txt").read_text(encoding="utf-8"), folder))
    return problems + differing_links(included, linked)


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder)
        for name, text in {"src/edges/good.h": '#include "edges/a.h"\n#include "image/b.h"\n#include "edgeslam/c.h"\n#include <map/d.h>\n',
                           "src/edges/late.cpp": '\n#include "tracking/e.h"\n', "src/flow/odd.cpp": '# include "utils/f.h"\n',
                           "drivers/v4l2/g.cpp": '#include "files/h.h"\n#include "drivers/lcm/i.h"\n',
                           "src/CMakeLists.txt": "edgeslam_stage(edges edgeslam_image\n  edgeslam_files)\n",
                           "drivers/CMakeLists.txt": "edgeslam_driver(v4l2 opencv_core)\n", "drivers/lcm/CMakeLists.txt": ""}.items():
            (source / name).parent.mkdir(exist_ok=True, parents=True)
            (source / name).write_text(text)
        found = check(source)
        expected = ["drivers/v4l2/g.cpp:2: drivers/v4l2 comes before drivers/lcm and must not include it",
                    "src/edges/late.cpp:2: edges comes before tracking and must not include it",
                    "src/flow/odd.cpp:1: no stage is called utils", "edges is linked to files and does not include it",
                    "drivers/v4l2 includes files and is not linked to it"]
        return [] if found == expected else [f"self-test: found {found}, expected {expected}"]


if __name__ == "__main__":
    problems = self_test() if sys.argv[1:] == ["--self-test"] else check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(problems))
    sys.exit(1 if problems else 0)
