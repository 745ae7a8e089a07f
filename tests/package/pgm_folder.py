#!/usr/bin/env python3
"""A recording's grey PNG images (8 bits) as PGM files named by their time stamp. usage: pgm_folder.py RECORDING FOLDER"""
import pathlib
import struct
import sys
import zlib


def read_png(path):
    data = path.read_bytes()
    position, packed = 8, b""
    width = height = 0
    while position < len(data):
        size, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert (depth, colour) == (8, 0), f"{path}: grey, 8 bits expected"
        packed += body if kind == b"IDAT" else b""
        position += size + 12
    return width, height, unfiltered(zlib.decompress(packed), width, height)


def unfiltered(raw, width, height):
    rows, above = [], bytes(width)
    for y in range(height):
        kind, line = raw[y * (width + 1)], bytearray(raw[y * (width + 1) + 1:(y + 1) * (width + 1)])
        for x in range(width):
            left, corner = (line[x - 1], above[x - 1]) if x else (0, 0)
            guess = left + above[x] - corner
            nearest = min((left, above[x], corner), key=lambda value: abs(guess - value))
            line[x] = (line[x] + (0, left, above[x], (left + above[x]) // 2, nearest)[kind]) & 255
        above = bytes(line)
        rows.append(above)
    return b"".join(rows)


if __name__ == "__main__":
    recording, folder = map(pathlib.Path, sys.argv[1:])
    for line in (recording / "rgb.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        stamp, name = line.split()
        width, height, pixels = read_png(recording / name)
        (folder / f"{stamp}.pgm").write_bytes(b"P5\n%d %d\n255\n" % (width, height) + pixels)
