#!/usr/bin/env python3
"""Checks what README.md and docs/ say against the repository: links and their headings, paths, keys of the configuration, the
example driver, the drawing.

usage: documentation.py REPOSITORY     exit status 1 where something is not there
       documentation.py --self-test"""
import glob
import pathlib
import re
import subprocess
import sys

OWN_FOLDERS = ("src/", "drivers/", "tests/", "firmware_cfg/", "docs/", "examples/", "include/", "systemd/", "toolchains/",
               "packaging/", ".ci/")
# Names of files that look like keys.
FILE_ENDINGS = ("yaml", "txt", "ply", "csv", "html", "png", "svg", "map", "pdf", "md", "h", "cpp", "mp4", "json", "so", "py")


def without_code_blocks(page):
    return re.sub(r"^```.*?^```$", "", page, flags=re.M | re.S)


def anchors(page):
    """Of the headings, as Git hosts make them."""
    headings = re.findall(r"^#+ (.+)$", without_code_blocks(page), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(name, page, read, exists):
    """`read`: text of a page or None; `exists`: of a path, both relative to the repository."""
    problems = []
    folder = name.rpartition("/")[0]
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code_blocks(page)):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        goal = name if not path else str(pathlib.PurePosixPath(folder) / path) if folder else path
        goal = re.sub(r"(^|/)[^/]+/\.\./", r"\1", goal)
        if path and not exists(goal):
            problems.append(f"{name}: {target}: there is no {goal}")
        elif anchor and anchor not in anchors(read(goal)):
            problems.append(f"{name}: {target}: no such heading")
    return problems


def missing_paths(name, page, is_there):
    problems = []
    for code in re.findall(r"`([^`]+)`", without_code_blocks(page)):
        path = code.split(" ")[0].rstrip("/")
        if not path.startswith(OWN_FOLDERS) or re.search(r"[A-Z]{3,}(?![a-z.])", path):
            continue
        if not is_there(path):
            problems.append(f"{name}: `{path}` is not there")
    return problems


def documented_keys(configuration):
    """{section: keys} of firmware_cfg/edgeslam.yaml, also those that are commented out."""
    keys, section = {}, None
    for line in configuration.splitlines():
        if match := re.match(r"([a-z_]+):", line):
            section = match.group(1)
            keys[section] = set()
        elif section and (match := re.match(r"  (?:# )?(\w+): ", line)):
            keys[section].add(match.group(1))
    return keys


def unknown_keys(name, page, keys):
    problems = []
    for code in re.findall(r"`([^`]+)`", without_code_blocks(page)):
        for section, key in re.findall(r"(?<![\w./-])([a-z_]+)\.([a-zA-Z_]+)(?![\w(/-])", code):
            if section in keys and key not in keys[section] and key not in FILE_ENDINGS:
                problems.append(f"{name}: `{section}.{key}` is no key of the configuration")
    return problems


def differing_example(page, header):
    """The driver in docs/camera_drivers.md is the one that is tested."""
    shown = re.findall(r"^```cpp\n(.*?)^```$", page, re.M | re.S)
    if len(shown) == 1 and shown[0].strip() in header:
        return []
    return ["docs/camera_drivers.md: its example is not what stands in tests/unit/frame_capture/pipe_camera.h"]


def check(repository):
    def read(path):
        return (repository / path).read_text(encoding="utf-8")

    def exists(path):
        return (repository / path).exists()

    def is_there(path):
        """Also for stages' files, which docs name without `src/` and without their ending."""
        return bool(glob.glob(str(repository / path)) or glob.glob(str(repository / path) + ".*"))

    keys = documented_keys(read("firmware_cfg/edgeslam.yaml"))
    problems = [] if len(keys) > 20 else ["the configuration's keys are not found any more"]
    for path in [repository / "README.md", *sorted((repository / "docs").glob("*.md"))]:
        name = str(path.relative_to(repository))
        page = read(name)
        problems += broken_links(name, page, read, exists)
        problems += missing_paths(name, page, is_there)
        problems += unknown_keys(name, page, keys)
    problems += differing_example(read("docs/camera_drivers.md"), read("tests/unit/frame_capture/pipe_camera.h"))
    drawn = subprocess.run([sys.executable, "-B", repository / "docs/drawings/frames.py"], stdout=subprocess.PIPE,
                           text=True, check=True).stdout
    if drawn != read("docs/frames.svg"):
        problems.append("docs/frames.svg: is not what docs/drawings/frames.py draws")
    return problems


def self_test():
    pages = {"README.md": "# A b\n[x](docs/c.md#d-e) [x](#a-b) [x](https://a/b) [x](docs/none.md) [x](#none)",
             "docs/c.md": "# C\n## D, `e`\n[x](../README.md#a-b) [x](#gone) `map.file` `map.fil` `map.ply` `src/there.h`"
                          " `src/gone.h` `drivers/NAME/`"}
    keys = documented_keys("map:\n  # where\n  # file: a\n  go_on: false\n")
    found = []
    for name, page in pages.items():
        found += broken_links(name, page, pages.get, lambda path: path in pages)
        found += missing_paths(name, page, lambda path: path == "src/there.h")
        found += unknown_keys(name, page, keys)
    expected = ["README.md: docs/none.md: there is no docs/none.md", "README.md: #none: no such heading",
                "docs/c.md: #gone: no such heading", "docs/c.md: `src/gone.h` is not there",
                "docs/c.md: `map.fil` is no key of the configuration"]
    if found != expected:
        print(f"self-test: expected {expected}, found {found}")
        return 1
    return 0


if __name__ == "__main__":
    if sys.argv[1:] == ["--self-test"]:
        sys.exit(self_test())
    PROBLEMS = check(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(PROBLEMS))
    sys.exit(1 if PROBLEMS else 0)
