"""A stretch of a sequence as a sequence of its own. The files are linked, not copied. A video is copied whole, and its
edit list says which of its frames are shown: nothing is coded anew."""
import mmap
import os
import shutil
import struct

from runs import BadInput

# What lists the frames, one a line: TUM RGB-D, ICL-NUIM, EuRoC, a video's times.
LISTS = ["rgb.txt", "associations.txt", "mav0/cam0/data.csv", "cam0/data.csv", "data.csv", "times.txt"]


def list_of(sequence):
    for path in LISTS:
        if os.path.isfile(os.path.join(sequence, path)):
            return path
    raise BadInput(f"{sequence}: cannot be begun later; expected one of {', '.join(LISTS)}")


def frame_lines(sequence):
    with open(os.path.join(sequence, list_of(sequence)), encoding="utf-8", errors="replace") as file:
        return [line for line in file if line.strip() and not line.startswith("#")]


def write_part(sequence, first, count, folder):
    """The `count` frames from number `first` on, which must be there."""
    path = list_of(sequence)
    link_beside(sequence, path.split("/"), folder)
    with open(os.path.join(folder, path), "w", encoding="utf-8") as file:
        file.writelines(frame_lines(sequence)[first:first + count])
    if path == "times.txt":
        videos = [name for name in os.listdir(folder) if name.lower().endswith((".mp4", ".mov", ".m4v"))]
        if len(videos) != 1:
            raise BadInput(f"{sequence}: cannot be begun later; expected one video (.mp4) beside times.txt")
        show_part(os.path.join(folder, videos[0]), first, count)


def link_beside(source, path, target):
    """Links to everything in `source` but the file at `path` (a list of names), whose folders are made."""
    os.makedirs(target)
    for name in os.listdir(source):
        if name != path[0]:
            os.symlink(os.path.abspath(os.path.join(source, name)), os.path.join(target, name))
    if len(path) > 1:
        link_beside(os.path.join(source, path[0]), path[1:], os.path.join(target, path[0]))


def show_part(link, first, count):
    """Puts a copy in the place of a linked video that shows only these frames (ISO 14496-12, 8.6.6)."""
    video = os.path.realpath(link)
    os.remove(link)
    shutil.copyfile(video, link)
    try:
        with open(link, "r+b") as file, mmap.mmap(file.fileno(), 0) as data:
            write_edit(data, first, count)
    except (struct.error, ValueError) as problem:
        raise BadInput(f"{video}: cannot be begun later: {problem}") from problem


def write_edit(data, first, count):
    """Makes the one edit of a video, which shows all of it, show these frames only."""
    movie = content(data, (0, len(data)), "moov")
    track = content(data, movie, "trak")
    media = content(data, track, "mdia")
    samples = content(data, content(data, media, "minf"), "stbl")
    movie_version, movie_rate = struct.unpack_from(">B11xI", data, content(data, movie, "mvhd")[0])
    media_version, media_rate = struct.unpack_from(">B11xI", data, content(data, media, "mdhd")[0])
    intervals, interval = struct.unpack_from(">4xI4xI", data, content(data, samples, "stts")[0])
    edit = content(data, content(data, track, "edts"), "elst")[0]
    edit_version, edits, _, start = struct.unpack_from(">B3xIIi", data, edit)
    if movie_version or media_version or edit_version or intervals != 1 or edits != 1 or start < 0 or media_rate == 0:
        raise ValueError("expected frames at one interval, and one edit")
    # Rounded down: rounded up, it could reach into one frame more.
    duration = count * interval * movie_rate // media_rate
    struct.pack_into(">Ii", data, edit + 8, duration, start + first * interval)


def content(data, within, kind):
    """Where the content of the first box of this kind begins and ends."""
    at, end = within
    while at + 8 <= end:
        size, found = struct.unpack_from(">I4s", data, at)
        header = 8
        if size == 1:
            size, header = struct.unpack_from(">Q", data, at + 8)[0], 16
        if size < header:
            break
        if found == kind.encode():
            return at + header, at + size
        at += size
    raise ValueError(f"it has no box '{kind}'")
