#!/usr/bin/env python3
"""Checks that docs/states.md has every state and every reason that the program gives, and none that it does not.

usage: documented_states.py REPOSITORY     exit status 1 where one is missing or left over
       documented_states.py --self-test

Reasons are put together from string literals and numbers. Every literal of the sources below is a piece of a reason, and
must be found in one that is documented, unless it is listed here as something else; and the pieces of every documented
reason, between its placeholders, must be found in the sources."""
import pathlib
import re
import sys

# What says why a frame has no measured pose, why it cannot be read, why there is no camera, and no scale. Beside each its
# literals that are no reasons.
SOURCES = {
    "src/tracking/tracker.cpp": ["first", "recovery"],  # of keyframes
    "src/tracking/frame_location.cpp": ["0."],
    "src/pipeline/tracking_worker.cpp": [],
    "src/pipeline/mapping_worker.cpp": [  # events
        "map ", " begins beside those before: ", "recovered from three keyframes, ", " points", "relocalised at keyframe ",
        "the wheels tell metres: a map unit is %.3f m +- %.1f %%",
        "the camera has a rolling shutter and reads its rows over %.1f ms: with "
        "camera.readout: %.4f in the configuration this is known from the start",
        "the focal length is not that of the calibration, but %.1f pixels: calibrate the camera",
        "the principal point is not that of the calibration, but cx: %.1f, cy: %.1f pixels: calibrate the camera",
        "the distortion is not that of the calibration, but k1: %.4f, k2: %.4f: calibrate the camera",
        "the inertial unit tells metres and upright: a map unit is %.3f m +- %.1f %%",
        "the inertial unit's clock differs from the camera's by %.1f ms +- %.1f: with time_offset_s: %.4f beside "
        "imu_T_camera this is known from the start",
        "the inertial unit is turned by %.2f degrees +- %.2f against what imu_T_camera says: with quaternion: [%.6f, "
        "%.6f, %.6f, %.6f] there this is known from the start",
        "the inertial unit seems to be turned by %.1f degrees against what imu_T_camera says: calibrate it; the camera goes on alone",
        "the inertial unit moves against the camera in %.0f %% of the time, by up to %.1f degrees: is it loose? The camera "
        "goes on alone"],
    "src/mapping/initialisation.cpp": [" from frame ", " to frame ", ", "],  # what the start was
    "src/mapping/initialisation.h": [],
    "src/mapping/standing_camera.cpp": [" of "],
    "src/mapping/initial_judgement.cpp": ["quality ", " edge pieces, parallax ", " deg, ", " points"],  # likewise
    "src/mapping/mapper.cpp": ["a saved map", "recovery"],
    "src/mapping/track_loss_recovery.cpp": [],
    "src/places/relocalisation.cpp": [],
    "src/places/guided_search.cpp": [],
    "src/map/map_view.cpp": [],
    "src/scale/ground_plane.cpp": [],
    "src/frames/frame_problem.cpp": [],
    "src/geometry/scale_estimate.cpp": [],
    "src/scale/scale_from_camera_height.cpp": [],
    "src/scale/scale_from_odometry.cpp": [],
    "src/scale/scale_search.cpp": ["odometry", "camera_height"],  # values of scale.source
    "src/service/metric_scale.cpp": [  # lines of the log
        "the scale is %.6g metres a map unit, standard deviation %.2g %%",
        "the scale is unknown again: another map was begun", "the scale is unknown again: the inertial unit contradicts the camera", "the scale is unknown in this map",
        ", in a map that the camera is not in now", "the scale is not known yet: ",
        "the scale is not renewed: "],
    "src/frames/image_file.cpp": [],
    "drivers/lcm/messages.cpp": [],
    "drivers/frame_capture/grey_conversion.cpp": [],
    "src/image_formats/jpeg_decoder.cpp": ["extraneous bytes before marker 0xd9"],  # a warning that is let pass
    "drivers/frame_capture/reopening_camera.cpp": [],
    "drivers/replay/replay_camera.cpp": [],
    "drivers/v4l2/buffer_queue.cpp": [],
    "drivers/v4l2/capture_device.cpp": [],
    "drivers/v4l2/control_setting.cpp": [  # names and values
        "exposure", "gain", "white_balance", "focus", "true", "false", "auto", "off", "power_line_frequency", "none"],
    "drivers/v4l2/stream_setup.cpp": [],
    "drivers/v4l2/v4l2_camera.cpp": [  # of the stream's description
        ", exposure up to ", ", exposure without limit (the driver has none to set)", "exposure", "auto"],
    "drivers/libcamera/control_values.cpp": [  # names and values
        "ExposureTimeMode", "AnalogueGainMode", "AeEnable", "auto", "exposure", "gain", "ExposureTime", "AnalogueGain",
        "white_balance", "AwbEnable", "ColourTemperature", "focus", "AfMode", "LensPosition", "off", "AeFlickerMode",
        "AeFlickerPeriod", "true", "false", "none", "power_line_frequency"],
    "drivers/libcamera/frame_memory.cpp": [],
    "drivers/libcamera/left_out/left_out.cpp": [],
    "drivers/libcamera/libcamera_camera.cpp": ["none", "Virtual"],
    "drivers/libcamera/manager.cpp": [  # codes of formats, and of libcamera's environment
        "R8  ", "R10 ", "R12 ", "R16 ", "NV12", "NV21", "YU12", "YUYV", "UYVY", "MJPG", "BG24", "RG24",
        "LIBCAMERA_LOG_LEVELS", "*:ERROR"],
}
# Of sources that are mostly about other things: the literals that are pieces of reasons.
SINGLE_PIECES = {
    "src/frames/folder_source.cpp": ["those before are"],
    "src/recording/frame_archive.cpp": [
        ": at byte ", "the frame is cut off", "the frame cannot be read", "the frame is damaged: its checksum is another one"],
    "src/recording/recording_source.cpp": ["the camera's frame was unreadable", " says"],
    "src/frames/video_source.cpp": ["cannot be decoded", ": frame ", "those before are"],
}
# Other sources that give reasons to a `reason`: of loops, keyframes, recordings, not of a frame.
REASONS_OF_OTHERS = {
    "src/places/loop_closing.cpp", "src/places/loop_search.cpp", "src/places/loop_verification.cpp",
    "src/tracking/keyframe_selection.cpp", "src/tracking/keyframe_selection.h",
}
FRAME_FOLDERS = ["src/tracking", "src/mapping", "src/places", "src/pipeline", "src/map"]
GIVES_REASON = re.compile(r'(?:reason|waiting_for|not_found)\w*\s*(?:=|\+=|\.assign\()[^;]*"[^"\n]*[a-z][^"\n]*"')
COMMENT = re.compile(r"//[^\n]*")

TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|^\s*#[^\n]*|"((?:[^"\\]|\\.)*)"|\'(?:[^\'\\]|\\.)\'', re.S | re.M)
FORMAT = re.compile(r"%[-+ 0#]*[0-9]*(?:\.[0-9]+)?[a-z]+|%%")
PLACEHOLDER = re.compile(r"\b(?:N|PATH|NAME|SIZE|FORMAT|VALUE|ALLOWED|ERROR|WHY)\b")


def literals(text):
    """String literals of C++, those that follow each other joined; without comments and preprocessor lines."""
    found, end = [], None
    for match in TOKEN.finditer(text):
        if match.group(1) is None:
            continue
        if end is not None and text[end:match.start()].strip() == "":
            found[-1] += match.group(1)
        else:
            found.append(match.group(1))
        end = match.end()
    return found


def pieces(text, parted_by):
    """What stands between the placeholders, where it has a word."""
    found = (piece.strip(" ") for piece in parted_by.split(text))
    return [piece for piece in found if re.search(r"[A-Za-z]{2}", piece)]


def documented_reasons(page):
    """The code in the first column of the tables, but that of the states."""
    tables = re.sub(r"^## States$.*?(?=^## )", "", page, flags=re.M | re.S)
    first_columns = re.findall(r"^\|([^|]*)\|", tables, re.M)
    return [reason for column in first_columns for reason in re.findall(r"`([^`]+)`", column)]


def check_reasons(page, sources, single_pieces):
    """`sources`: {path: (text, literals that are no reasons)}; `single_pieces`: {path: (text, literals that are)}."""
    problems = []
    reasons = documented_reasons(page)
    known = []
    for path, (text, others) in sources.items():
        found = literals(text)
        problems += [f"{path}: the literal {other!r} is not there any more" for other in others if other not in found]
        for literal in found:
            known += pieces(literal, FORMAT)
            if literal in others:
                continue
            problems += [f"docs/states.md: {piece!r} of {path} is in no documented reason"
                         for piece in pieces(literal, FORMAT) if not any(piece in reason for reason in reasons)]
    for path, (text, wanted) in single_pieces.items():
        found = literals(text)
        problems += [f"{path}: the literal {piece!r} is not there any more" for piece in wanted if piece not in found]
        known += [piece.strip() for piece in wanted]
        problems += [f"docs/states.md: {piece!r} of {path} is in no documented reason" for piece in wanted
                     if not any(piece.strip() in reason for reason in reasons)]
    for reason in reasons:
        for piece in pieces(reason, PLACEHOLDER):
            if not covered(piece, known):
                problems.append(f"docs/states.md: of {reason!r}, {piece!r} is not in the program")
    return problems


def covered(text, known):
    """Whether pieces that the program knows make up all of it; colons, parentheses and the like may stand between."""
    reached = {0}
    for start in range(len(text)):
        if start not in reached:
            continue
        if not text[start].isalnum():
            reached.add(start + 1)
        reached.update(start + len(piece) for piece in known if text.startswith(piece, start))
    return len(text) in reached


def check_states(page, run_result, state_type, view_script):
    names = re.findall(r'return "(\w+)";', run_result)
    names = [name for name in names if name != "unknown"]
    messages = [name for name in re.findall(r"const int8_t (\w+)", state_type)]
    shown = re.search(r"const STATE_TEXT = \{(.*?)\};", view_script, re.S).group(1)
    texts = sorted(set(re.findall(r"'([^']+)'", shown))) + ["No camera"]
    states = page.split("## States")[1].split("##")[0]
    problems = []
    for name in names:
        if f"| `{name}` |" not in states:
            problems.append(f"docs/states.md: the state {name} is not documented")
    for name in messages:
        if f"`{name}`" not in page:
            problems.append(f"docs/states.md: {name} of state_t is not documented")
    for text in texts:
        if f"| {text} |" not in states:
            problems.append(f"docs/states.md: the page's state {text!r} is not documented")
    documented = re.findall(r"^\| `(\w+)` \|", states, re.M)
    problems += [f"docs/states.md: there is no state {name}" for name in documented
                 if name not in names and name != "frames"]
    if len(names) < 6 or len(messages) < 6 or len(texts) < 6:
        problems.append("the states are not found in the sources any more")
    return problems


def check_other_sources(repository):
    problems = []
    for folder in FRAME_FOLDERS:
        for path in sorted((repository / folder).glob("*.*")):
            name = str(path.relative_to(repository))
            if name in SOURCES or name in REASONS_OF_OTHERS:
                continue
            if GIVES_REASON.search(COMMENT.sub("", path.read_text(encoding="utf-8"))):
                problems.append(f"{name}: seems to give reasons; add it to this test")
    return problems


def check(repository):
    def read(path):
        return (repository / path).read_text(encoding="utf-8")
    page = read("docs/states.md")
    problems = check_reasons(page, {path: (read(path), others) for path, others in SOURCES.items()},
                             {path: (read(path), wanted) for path, wanted in SINGLE_PIECES.items()})
    problems += check_states(page, read("src/tracking/frame_result.cpp"), read("drivers/lcm/types/state_t.lcm"),
                             read("drivers/viewer/page/view.js"))
    return problems + check_other_sources(repository)


def self_test():
    source = ('reason = "too few points (" + std::to_string(n) + ")";  // "a comment"\n#include "a/header.h"\n'
              'reason = format("%d of them "\n "agree", n); event = "an event";')
    page = "| reason | what |\n|---|---|\n| `too few points (N)`, `N of them agree` | `--else` |\n"
    cases = [
        (page, ["an event"], 0),
        (page, [], 1),                                              # a piece that is documented nowhere
        (page.replace("`N of them agree`", "`ERROR`"), ["an event"], 1),
        (page + "| `too many points (N)` | |\n", ["an event"], 1),  # what the program does not say
        (page, ["an event", "gone"], 1),
    ]
    for number, (text, others, expected) in enumerate(cases):
        found = check_reasons(text, {"a.cpp": (source, others)}, {})
        if len(found) != expected:
            print(f"self-test {number}: expected {expected} problems, found {found}")
            return 1
    return 0


if __name__ == "__main__":
    if sys.argv[1:] == ["--self-test"]:
        sys.exit(self_test())
    PROBLEMS = check(pathlib.Path(sys.argv[1]))
    print("\n".join(PROBLEMS))
    sys.exit(1 if PROBLEMS else 0)
