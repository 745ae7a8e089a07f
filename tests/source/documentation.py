#!/usr/bin/env python3
"""Checks what the documentation says against the repository: links and their headings, paths, keys of the configuration, the
example driver, the drawing, the length of README.md, the folders in the design. And what comments of the sources say of it:
paths, and sections of docs/design.md with the topics that they name.

usage: documentation.py REPOSITORY     exit status 1 where something is not there
       documentation.py --self-test"""
import glob
import pathlib
import re
import subprocess
import sys

OWN_FOLDERS = ("src/", "drivers/", "tests/", "firmware_cfg/", "docs/", "examples/", "include/", "systemd/", "toolchains/",
               "packaging/", ".ci/")
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "docs/**/*.md", "examples/*.md", "tests/*/README.md")
LONGEST_README = 150  # lines: it is the front door
CONFIGURATIONS = ("firmware_cfg/edgeslam.yaml", "firmware_cfg/expert.yaml")
# Sources whose comments are read, and how a comment begins in each.
SOURCE_FOLDERS = ("src", "drivers", "include", "tests")
COMMENT_SIGNS = {".h": "//", ".cpp": "//", ".lcm": "//", ".js": "//", ".in": "//", ".py": "#", ".sh": "#", ".cmake": "#",
                 ".txt": "#"}
DESIGN = re.compile(r"\bdesign(?:\.md)?,? section (\d+(?:\.\d+)*)(?:: ([^,.;:()\"]*[^,.;:()\" ]))?")
PATH = re.compile(r"(?<![\w./<\"-])(?:" + "|".join(re.escape(folder) for folder in OWN_FOLDERS) + r")[\w./*-]*\w")
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


def has_placeholder(path):
    return re.search(r"[A-Z]{3,}(?![a-z.])", path) is not None


def missing_paths(name, page, is_there, stages=()):
    """`stages`: names of folders in src/ and drivers/, whose files pages name without what is before them."""
    problems = []
    for code in re.findall(r"`([^`]+)`", without_code_blocks(page)):
        path = code.split(" ")[0].rstrip("/")
        of_stage = re.fullmatch(r"(\w+)/[\w/]+(?:\.h|\.cpp)?", path)
        if of_stage and of_stage.group(1) in stages:
            if not any(is_there(folder + path) for folder in ("src/", "drivers/")):
                problems.append(f"{name}: `{path}` is not there")
        elif path.startswith(OWN_FOLDERS) and not has_placeholder(path) and not is_there(path):
            problems.append(f"{name}: `{path}` is not there")
    return problems


def documented_keys(*configurations):
    """{section: keys} of the files in firmware_cfg/, also those that are commented out."""
    keys, section = {}, None
    for line in "\n".join(configurations).splitlines():
        if match := re.match(r"([a-z_]+):", line):
            section = match.group(1)
            keys.setdefault(section, set())
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


def comments(source, sign):
    """Each in one line, as often as lines with a comment follow each other."""
    found, current = [], []
    for line in source.splitlines() + [""]:
        if match := re.search(rf"(?:^|\s){sign}+ ?(.*)$", line):
            current.append(match.group(1).strip())
        elif current:
            found.append(" ".join(current))
            current = []
    return found


def numbered_sections(page):
    """{number: text under the heading, in one line and in small letters}"""
    parts = re.split(r"^#+ (\d+(?:\.\d+)*)\.? ", without_code_blocks(page), flags=re.M)
    return {number: re.sub(r"\s+", " ", text).lower() for number, text in zip(parts[1::2], parts[2::2])}


def wrong_folders(folders, layout):
    """`folders`: those of src/ and drivers/; `layout`: the section of docs/design.md with a row for each."""
    described = set(re.findall(r"\| `(\w+)` \|", layout))
    return ([f"docs/design.md: section 3 has no row for the folder {name}" for name in sorted(folders - described)] +
            [f"docs/design.md: section 3 has a row for {name}, which is no folder" for name in sorted(described - folders)])


def wrong_comments(name, source, sections, is_there):
    """`sections`: of docs/design.md."""
    problems = []
    for comment in comments(source, COMMENT_SIGNS[pathlib.PurePosixPath(name).suffix]):
        for number, topic in DESIGN.findall(comment):
            if number not in sections:
                problems.append(f"{name}: docs/design.md has no section {number}")
            elif not re.search(rf"\b{re.escape(topic.lower())}\b", sections[number]):
                problems.append(f"{name}: section {number} of docs/design.md says nothing of '{topic}'")
        for path in PATH.findall(comment):
            if not has_placeholder(path) and not is_there(path):
                problems.append(f"{name}: {path} is not there")
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

    keys = documented_keys(*(read(path) for path in CONFIGURATIONS if exists(path)))
    problems = [] if len(keys) > 20 else ["the configuration's keys are not found any more"]
    stages = {path.name for folder in ("src", "drivers") for path in (repository / folder).iterdir() if path.is_dir()}
    for path in (path for pattern in PAGES for path in sorted(repository.glob(pattern))):
        name = str(path.relative_to(repository))
        page = read(name)
        problems += broken_links(name, page, read, exists)
        problems += missing_paths(name, page, is_there, stages)
        problems += unknown_keys(name, page, keys)
    lines = len(read("README.md").splitlines())
    if lines > LONGEST_README:
        problems.append(f"README.md: has {lines} lines, at most {LONGEST_README}: move some to docs/")
    sections = numbered_sections(read("docs/design.md"))
    problems += wrong_folders(stages, sections["3"])
    for path in (path for folder in SOURCE_FOLDERS for path in sorted((repository / folder).rglob("*"))):
        if path.suffix in COMMENT_SIGNS and path != pathlib.Path(__file__).resolve() and "corpus" not in path.parts:
            problems += wrong_comments(str(path.relative_to(repository)), path.read_text(encoding="utf-8"), sections, is_there)
    problems += differing_example(read("docs/camera_drivers.md"), read("tests/unit/frame_capture/pipe_camera.h"))
    drawn = subprocess.run([sys.executable, "-B", repository / "docs/drawings/frames.py"], stdout=subprocess.PIPE,
                           text=True, check=True).stdout
    if drawn != read("docs/frames.svg"):
        problems.append("docs/frames.svg: is not what docs/drawings/frames.py draws")
    return problems


def self_test():
    pages = {"README.md": "# A b\n[x](docs/c.md#d-e) [x](#a-b) [x](https://a/b) [x](docs/none.md) [x](#none)",
             "docs/c.md": "# C\n## D, `e`\n[x](../README.md#a-b) [x](#gone) `map.file` `map.fil` `map.ply` `map.size` `lcm.ttl`"
                          " `src/there.h` `src/gone.h` `drivers/NAME/` `flow/there` `flow/gone` `result/a`"}
    keys = documented_keys("map:\n  # where\n  # file: a\n  go_on: false\n", "map:\n  size: 1\nlcm:\n  ttl: 0\n")
    found = []
    for name, page in pages.items():
        found += broken_links(name, page, pages.get, lambda path: path in pages)
        found += missing_paths(name, page, lambda path: path in ("src/there.h", "src/flow/there"), {"flow"})
        found += unknown_keys(name, page, keys)
    sections = numbered_sections("# D\n## 4. Threads\nNone.\n## 5. The method\n**Flow**, what a\nmeasurement is\n")
    source = """// Sees docs/c.md and docs/none.md. (design, section 4)
int a;  // design, section 5: flow, "b"
// As of (P1 and design,
// section 5: what a measurement is), docs/design.md, section 6; section 3.3 of the paper; tests/unit/STAGE/*.cpp
// mirrors it. design, section 5: low
"design, section 7"
"""
    found += wrong_folders({"flow", "edges"}, "| folder | what | |---|---| | `flow` | follows `points` | | `old` | was |")
    found += wrong_comments("src/a.h", source, sections, lambda path: path in ("docs/c.md", "docs/design.md"))
    found += wrong_comments("tests/a.py", "#!/bin/b\n# design, section 8\n", sections, lambda path: False)
    expected = ["README.md: docs/none.md: there is no docs/none.md", "README.md: #none: no such heading",
                "docs/c.md: #gone: no such heading", "docs/c.md: `src/gone.h` is not there",
                "docs/c.md: `flow/gone` is not there", "docs/c.md: `map.fil` is no key of the configuration",
                "docs/design.md: section 3 has no row for the folder edges",
                "docs/design.md: section 3 has a row for old, which is no folder",
                "src/a.h: docs/design.md has no section 6", "src/a.h: section 5 of docs/design.md says nothing of 'low'",
                "src/a.h: docs/none.md is not there", "tests/a.py: docs/design.md has no section 8"]
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
