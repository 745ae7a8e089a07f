#!/usr/bin/env python3
"""Compares two replays of one recording, frame by frame: what they differ in first, and by how much at most.

usage: compare_runs.py RESULT OTHER_RESULT [--most DISTANCE] [--most-angle RAD]
Lengths are map units. Exit code 1 where states or keyframes differ, or a pose by more than --most or --most-angle.
"""
import argparse
import csv
import math
import sys


def frames_of(folder):
    with open(folder + "/frames.csv", newline="") as file:
        return list(csv.DictReader(file))


def pose(frame, name):
    values = [frame[f"{name}_{column}"] for column in ("x", "y", "z", "qx", "qy", "qz", "qw")]
    return None if "" in values else [float(value) for value in values]


def angle_between(a, b):
    if a == b:
        return 0.0
    w, x, y, z = a[3], -a[0], -a[1], -a[2]
    u, p, q, r = b[3], b[0], b[1], b[2]
    vector = (w * p + x * u + y * r - z * q, w * q - x * r + y * u + z * p, w * r + x * q - y * p + z * u)
    return 2 * math.atan2(math.hypot(*vector), abs(w * u - x * p - y * q - z * r))


def first_difference(frames, others):
    for frame, other in zip(frames, others):
        for column in frame:
            if not column.endswith("_ms") and frame[column] != other[column]:
                return f"frame {frame['index']}, {column}: {frame[column]} and {other[column]}"
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("result")
    parser.add_argument("other")
    parser.add_argument("--most", type=float, default=0)
    parser.add_argument("--most-angle", type=float, default=0)
    arguments = parser.parse_args()
    frames, others = frames_of(arguments.result), frames_of(arguments.other)
    failures = []
    if not frames or len(frames) != len(others):
        sys.exit(f"expected as many frames, got {len(frames)} and {len(others)}")

    distance = angle = 0.0
    compared = 0
    for frame, other in zip(frames, others):
        for column in ("time_s", "state", "keyframe"):
            if frame[column] != other[column]:
                failures.append(f"frame {frame['index']}: {column} {frame[column]} and {other[column]}")
        for name in ("live", "final"):
            a, b = pose(frame, name), pose(other, name)
            if (a is None) != (b is None):
                failures.append(f"frame {frame['index']}: only one has a {name} pose")
            elif a is not None:
                compared += 1
                distance = max(distance, math.dist(a[:3], b[:3]))
                angle = max(angle, angle_between(a[3:], b[3:]))
    if compared == 0:
        failures.append("no poses to compare")
    if distance > arguments.most:
        failures.append(f"positions differ by {distance:.3g}, most allowed is {arguments.most:g}")
    if angle > arguments.most_angle:
        failures.append(f"rotations differ by {angle:.3g} rad, most allowed is {arguments.most_angle:g}")

    difference = first_difference(frames, others)
    print(f"{len(frames)} frames, {compared} poses: " + ("the same to the last digit" if difference is None else
          f"positions within {distance:.3g}, rotations within {angle:.3g} rad; first difference: {difference}"))
    for failure in failures[:10]:
        print(failure)
    sys.exit(1 if failures else 0)


main()
