#!/usr/bin/env python3
"""Draws docs/frames.svg: the frames of camera, world, body, local and odom, and the pixels. Writes it to standard output.

usage: frames.py > docs/frames.svg"""
import math

WIDTH, HEIGHT = 1000, 530
UNIT = 78                                             # [px a metre]
FORWARD, LEFT, UP = (0.97, -0.16), (-0.42, -0.34), (0.0, -1.0)  # of the drawing's ground, on the paper
COLOURS = ("#c62828", "#2e7d32", "#1565c0")           # x, y, z
CAMERA_ON_BODY = (0.75, 0.0, 1.3)
CAMERA_AXES = ((0, -1, 0), (0, 0, -1), (1, 0, 0))     # in the body's frame: x right, y down, z forward


def paper(point):
    x, y, z = point
    return (165 + UNIT * (FORWARD[0] * x + LEFT[0] * y + UP[0] * z),
            385 + UNIT * (FORWARD[1] * x + LEFT[1] * y + UP[1] * z))


class Robot:
    def __init__(self, place, yaw_deg):
        self.place, self.yaw = place, math.radians(yaw_deg)

    def vector(self, v):
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])

    def point(self, p):
        return tuple(a + b for a, b in zip(self.place, self.vector(p)))


def line(a, b, colour, width=2, extra=""):
    (ax, ay), (bx, by) = a, b
    return f'<line x1="{ax:.1f}" y1="{ay:.1f}" x2="{bx:.1f}" y2="{by:.1f}" stroke="{colour}" stroke-width="{width}" {extra}/>'


def text(at, words, size=15, colour="#1c1c1c", anchor="start", extra=""):
    return f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" font-size="{size}" fill="{colour}" text-anchor="{anchor}" {extra}>{words}</text>'


def polygon(points, fill, colour="#6b7280"):
    corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polygon points="{corners}" fill="{fill}" stroke="{colour}" stroke-width="1.3" stroke-linejoin="round"/>'


def axes(origin, vectors, length, names="xyz"):
    """Those that lead away from who looks are drawn first."""
    parts = []
    begin = paper(origin)
    for vector, colour, name in sorted(zip(vectors, COLOURS, names), key=lambda axis: -axis[0][1]):
        end = paper(tuple(o + length * v for o, v in zip(origin, vector)))
        dx, dy = end[0] - begin[0], end[1] - begin[1]
        size = math.hypot(dx, dy)
        if size < 1:
            continue
        ux, uy = dx / size, dy / size
        tip = [(end[0] + 7 * ux, end[1] + 7 * uy), (end[0] - 4 * uy, end[1] + 4 * ux), (end[0] + 4 * uy, end[1] - 4 * ux)]
        parts.append(line(begin, end, colour, 2.6))
        parts.append(polygon(tip, colour, colour))
        parts.append(text((end[0] + 17 * ux, end[1] + 17 * uy + 5), name, 15, colour, "middle", 'font-weight="bold"'))
    return parts


def robot(of):
    """A box on wheels with a camera on a post."""
    x0, x1, y, z0, z1 = -0.5, 0.5, 0.38, 0.16, 0.5
    at = lambda *p: paper(of.point(p))
    parts = [polygon([at(x0, -y, z1), at(x1, -y, z1), at(x1, y, z1), at(x0, y, z1)], "#f1f3f5"),
             polygon([at(x0, -y, z0), at(x1, -y, z0), at(x1, -y, z1), at(x0, -y, z1)], "#dde1e6"),
             polygon([at(x1, -y, z0), at(x1, y, z0), at(x1, y, z1), at(x1, -y, z1)], "#c9ced6")]
    for x in (-0.36, 0.36):
        centre = at(x, -y - 0.02, 0.17)
        parts.append(f'<ellipse cx="{centre[0]:.1f}" cy="{centre[1]:.1f}" rx="11" ry="12" fill="#4b5563" stroke="#374151"/>')
    cx, cy, cz = CAMERA_ON_BODY
    parts.append(line(at(0.2, cy, z1), at(0.2, cy, cz), "#6b7280", 5))
    parts.append(line(at(0.2, cy, cz), at(cx, cy, cz), "#6b7280", 5))
    corners = [at(cx + 0.28, sy * 0.16, cz + sz * 0.12) for sy, sz in ((-1, 1), (1, 1), (1, -1), (-1, -1))]
    tip = at(cx, cy, cz)
    for a, b in zip(corners, corners[1:] + corners[:1]):
        parts.append(polygon([tip, a, b], "#fde68a", "#92750c"))
    return parts


def arrow(begin, end, bend, label, at, colour="#7c3aed"):
    """From the frame that the pose leads to, to the one that it is of."""
    (ax, ay), (bx, by) = begin, end
    mx, my = (ax + bx) / 2 + bend[0], (ay + by) / 2 + bend[1]
    size = math.hypot(bx - mx, by - my)
    ux, uy = (bx - mx) / size, (by - my) / size
    tip = [(bx, by), (bx - 11 * ux - 5 * uy, by - 11 * uy + 5 * ux), (bx - 11 * ux + 5 * uy, by - 11 * uy - 5 * ux)]
    return [f'<path d="M{ax:.1f},{ay:.1f} Q{mx:.1f},{my:.1f} {bx - 8 * ux:.1f},{by - 8 * uy:.1f}" fill="none" stroke="{colour}" '
            'stroke-width="1.8" stroke-dasharray="6 4"/>', polygon(tip, colour, colour),
            text(at, label, 15, colour, "middle", 'font-family="DejaVu Sans Mono, monospace" font-weight="bold"')]


def pixels(left, top, side):
    parts = [text((left, top - 58), "Pixels", 16, extra='font-weight="bold"')]
    for row in range(3):
        for column in range(4):
            parts.append(f'<rect x="{left + column * side}" y="{top + row * side}" width="{side}" height="{side}" '
                         'fill="#f8fafc" stroke="#9aa3af"/>')
    centre = (left + side / 2, top + side / 2)
    for (dx, dy), colour, name in (((1, 0), COLOURS[0], "u"), ((0, 1), COLOURS[1], "v")):
        reach = 2.1 * side
        end = (centre[0] + reach * dx, centre[1] + reach * dy)
        parts.append(line(centre, end, colour, 2.6))
        parts.append(polygon([(end[0] + 8 * dx, end[1] + 8 * dy), (end[0] - 4 * dy, end[1] - 4 * dx),
                              (end[0] + 4 * dy, end[1] + 4 * dx)], colour, colour))
        parts.append(text((end[0] + 18 * dx + (12 if dy else 0), end[1] + 10 * dy + (5 if dx else 0)), name, 15, colour, "middle",
                          'font-weight="bold"'))
    parts.append(f'<circle cx="{centre[0]}" cy="{centre[1]}" r="4.5" fill="#1c1c1c"/>')
    parts.append(text((left, top - 32), "(0, 0) is the centre", 14))
    parts.append(text((left, top - 14), "of the top-left pixel", 14))
    return parts


def main():
    first, now, drifted = Robot((0, 0, 0), 0), Robot((5.3, 0.4, 0), 24), Robot((0.9, -3.5, 0), 6)
    unit = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
             'font-family="DejaVu Sans, Helvetica, Arial, sans-serif" role="img">',
             "<title>Frames: world and local at the first keyframe, odom, which drifts away from local, camera and body now, and pixels</title>",
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    ground = [paper((x, y, 0)) for x, y in ((-1.2, -1.0), (7.2, -1.0), (7.2, 1.9), (-1.2, 1.9))]
    parts.append(polygon(ground, "#f6f7f2", "#e3e6da"))
    for of in (first, now):
        parts += robot(of)
        parts += axes(of.point((0, 0, 0)), [of.vector(v) for v in unit], 0.95)
        parts += axes(of.point(CAMERA_ON_BODY), [of.vector(v) for v in CAMERA_AXES], 0.72)
    parts += axes(drifted.place, [drifted.vector(v) for v in unit], 0.75)
    world, camera = paper(first.point(CAMERA_ON_BODY)), paper(now.point(CAMERA_ON_BODY))
    local, body, odom = paper(first.place), paper(now.place), paper(drifted.place)
    parts += arrow((world[0] + 8, world[1] - 12), (camera[0] - 10, camera[1] - 8), (-10, -110), "world_T_camera",
                   ((world[0] + camera[0]) / 2 - 20, (world[1] + camera[1]) / 2 - 88))
    parts += arrow((local[0] + 14, local[1] + 10), (body[0] - 6, body[1] + 9), (0, 74), "local_T_body",
                   ((local[0] + body[0]) / 2 + 26, (local[1] + body[1]) / 2 + 10))
    parts += arrow((local[0] + 11, local[1] + 15), (odom[0] - 14, odom[1] - 1), (-24, 30), "local_T_odom",
                   ((local[0] + odom[0]) / 2 - 22, odom[1] + 20))
    parts += arrow((odom[0] + 14, odom[1] + 4), (body[0] + 3, body[1] + 12), (62, 74), "odom_T_body",
                   (body[0] + 16, body[1] + 140))
    parts += arrow((body[0] + 12, body[1] + 2), (camera[0] + 8, camera[1] + 8), (110, 14), "body_T_camera",
                   ((body[0] + camera[0]) / 2 + 140, (body[1] + camera[1]) / 2 + 44))
    parts += [text((world[0] - 62, world[1] - 62), "world", 17, extra='font-weight="bold"', anchor="middle"),
              text((world[0] - 62, world[1] - 44), "camera at the first keyframe", 13, anchor="middle"),
              text((local[0] - 20, local[1] + 62), "local", 17, extra='font-weight="bold"', anchor="middle"),
              text((local[0] - 20, local[1] + 80), "body at the first keyframe", 13, anchor="middle"),
              text((odom[0], odom[1] + 32), "odom", 17, extra='font-weight="bold"', anchor="middle"),
              text((odom[0], odom[1] + 50), "never jumps, but drifts", 13, anchor="middle"),
              text((camera[0] - 10, camera[1] - 62), "camera", 17, extra='font-weight="bold"'),
              text((camera[0] - 10, camera[1] - 44), "x right, y down, z forward", 13),
              text((body[0] + 16, body[1] + 72), "body", 17, extra='font-weight="bold"'),
              text((body[0] + 16, body[1] + 90), "x forward, y left, z up", 13)]
    parts += pixels(835, 90, 34)
    print("\n".join(parts + ["</svg>"]))


main()
