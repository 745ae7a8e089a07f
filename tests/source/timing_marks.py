#!/usr/bin/env python3
"""Holds that every test which hangs on time has the label `timing` (docs/testing.md).

It hangs on time if it reads the clock, or runs the program live: as a daemon, beside the test, or at the pace of time stamps.
Refusals of wrong use do not count. Compares the sources with what ctest lists.

    timing_marks.py SOURCE_FOLDER BUILD_FOLDER CTEST
    timing_marks.py --self-test
"""
import fnmatch
import json
import pathlib
import re
import subprocess
import sys

TEST = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.MULTILINE)
LIVE = re.compile(r'steady_clock::now|\bBackgroundProcess\b|\bstart(?:On|Faulty|Daemon|Recording)\(|"--realtime"')
REFUSAL = re.compile(r"exit_code, (?:exit_bad_input|2)\)")


def hanging_on_time(source):
    """Names Suite.Test of the tests in the text of a C++ file that hang on time."""
    starts = list(TEST.finditer(source))
    names = []
    for start, after in zip(starts, starts[1:] + [None]):
        body = source[start.end():after.start() if after else len(source)].split("\n}\n")[0]
        if LIVE.search(body) and not REFUSAL.search(body):
            names.append(f"{start[1]}.{start[2]}")
    return names


def listed_tests(build_folder, ctest):
    """What ctest runs, as (name, command, labels)."""
    listing = subprocess.run([ctest, "--test-dir", build_folder, "--show-only=json-v1"], check=True, capture_output=True, text=True)
    tests = []
    for test in json.loads(listing.stdout)["tests"]:
        labels = [label for p in test.get("properties", []) if p["name"] == "LABELS" for label in p["value"]]
        tests.append((test["name"], test.get("command", []), labels))
    return tests


def runs(test, name):
    """Whether this test of ctest runs the test Suite.Test, which may be of a suite that is instantiated or in a filter."""
    listed, command, _ = test
    if re.search(rf"(?:^|[./]){re.escape(name)}(?:/|$)", listed):
        return True
    filters = [word.split("=", 1)[1] for word in command if word.startswith("--gtest_filter=")]
    return any(fnmatch.fnmatch(name, pattern) for f in filters if not f.startswith("-") for pattern in f.split(":"))


def problems(names_of_files, tests, is_built):
    """`names_of_files`: {path: [Suite.Test]}. `is_built`: whether ctest knows the tests of that path at all."""
    found = []
    for path, names in names_of_files.items():
        for name in names if is_built(path) else []:
            of_name = [test for test in tests if runs(test, name)]
            if not of_name or any("timing" not in labels for _, _, labels in of_name):
                found.append(f"{path}: {name} hangs on time and has not the label `timing` (edgeslam_timing_tests in CMake)")
    return found


def check(source_folder, build_folder, ctest):
    root = pathlib.Path(source_folder)
    names_of_files = {}
    for folder in ("unit", "system", "soak"):
        for path in sorted((root / "tests" / folder).rglob("*.cpp")):
            names_of_files[str(path.relative_to(root))] = hanging_on_time(path.read_text())
    tests = listed_tests(build_folder, ctest)
    built = {name for name, command, _ in tests if command}

    def is_built(path):
        """Not where an option leaves the folder out, or its program was not built: then ctest knows none of its tests."""
        parts = pathlib.Path(path).parts
        if parts[1] == "unit":
            return f"{parts[2]}.unit_tests" in built
        in_file = [f"{m[1]}.{m[2]}" for m in TEST.finditer((root / path).read_text())]
        return any(runs(test, name) for test in tests for name in in_file)

    return problems(names_of_files, tests, is_built)


def self_test():
    source = 'TEST(A, Looks) {\n  f(steady_clock::now());\n}\n\nTEST_F(B, Runs) {\n  startOn(hall);\n}\n\nTEST(B, Rests) {\n  g();\n}\n'
    assert hanging_on_time(source) == ["A.Looks", "B.Runs"]
    assert not hanging_on_time('TEST(C, D) {\n  run("--realtime");\n  EXPECT_EQ(exit_code, 2);\n}\n')
    tests = [("system.B.Runs", [], ["system", "timing"]), ("a.timing_tests", ["a", "--gtest_filter=X.*:A.Lo*"], ["timing"])]
    assert not problems({"a": ["A.Looks", "B.Runs"]}, tests, lambda _: True)
    unmarked = [("system.I/B.Runs/1", [], ["system"]), ("a.unit_tests", ["a", "--gtest_filter=-A.Looks"], [])]
    assert len(problems({"a": ["A.Looks", "B.Runs"]}, unmarked, lambda _: True)) == 2
    assert not problems({"a": ["A.Looks"]}, unmarked, lambda _: False)


def main(arguments):
    if arguments == ["--self-test"]:
        self_test()
        return 0
    if len(arguments) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    found = check(*arguments)
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
