#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures whether sequences pump: renders frames as a sequence and each by itself, and prints how
far a fixed point moves over the frames, how much a still fog's brightness changes, and how much the
frame's width does. Of three sequences: a still ball of fog beside a ball that grows, brightens and
moves away, which this script makes; the frames of a folder; and a turntable of one volume. Needs
python3-pil and the program: build/release/bin/deltasplat, or the one on the path.

Usage: python3 scripts/measure_pumping.py FOLDER [--frames PATTERN RANGE]... [--turntable VOLUME]
"""
import argparse
import json
import os
import shutil
import subprocess

from PIL import Image

SIZE = (256, 256)
DIMS = (128, 48, 48)
STILL, RADIUS = (22, 24, 24), 14
FRAMES = 12


def find_program():
    built = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../build/release/bin/deltasplat")
    return built if os.path.exists(built) else shutil.which("deltasplat")


def render(volume, picture, stats, *options):
    subprocess.run([find_program(), "-qq", "render", volume, "-o", picture, "--stats", stats,
                    "--size", "%dx%d" % SIZE, *options], check=True)


def ball(center, radius):
    """Voxels (index, distance from the middle over the radius) of a ball."""
    for z in range(DIMS[2]):
        for y in range(DIMS[1]):
            for x in range(DIMS[0]):
                squared = sum((a - b) ** 2 for a, b in zip((x, y, z), center))
                if squared < radius ** 2:
                    yield x + DIMS[0] * (y + DIMS[1] * z), (squared ** 0.5) / radius


def write_fog(folder):
    still = list(ball(STILL, RADIUS))
    for frame in range(1, FRAMES + 1):
        voxels = bytearray(DIMS[0] * DIMS[1] * DIMS[2])
        for index, _ in ball((50 + 5 * frame, 24, 24), 3 + frame):
            voxels[index] = 60 + 16 * frame
        for index, distance in still:
            voxels[index] = round(20 + 80 * (1 - distance))
        name = "fog.%04d_%dx%dx%d_uint8.raw" % (frame, *DIMS)
        with open(os.path.join(folder, name), "wb") as file:
            file.write(voxels)
    return os.path.join(folder, "fog.####_%dx%dx%d_uint8.raw" % DIMS), range(1, FRAMES + 1)


def pixel_of(stats, point):
    """Where a point of the world is in a parallel camera's picture, in pixels."""
    camera = stats["camera"]
    size = camera["frame_width"] / camera["size"][0]
    from_target = [a - b for a, b in zip(point, camera["target"])]
    along = [sum(a * b for a, b in zip(from_target, camera[axis])) / size for axis in ("right", "up")]
    return camera["size"][0] / 2 + along[0], camera["size"][1] / 2 - along[1]


def brightness(picture, stats, point, radius):
    """The mean of the pixels of a disc that is fixed in the world, 0 to 255."""
    x, y = pixel_of(stats, point)
    pixels = radius * stats["camera"]["size"][0] / stats["camera"]["frame_width"]
    image = Image.open(picture).convert("L")
    values = [image.getpixel((i, j)) for i in range(SIZE[0]) for j in range(SIZE[1])
              if (i + 0.5 - x) ** 2 + (j + 0.5 - y) ** 2 <= pixels ** 2]
    return sum(values) / len(values)


def most_apart(values):
    return max(values) / min(values)


def report(what, shots, point, fog):
    pixels = [pixel_of(stats, point) for _, stats in shots]
    moved = max(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 for a in pixels for b in pixels)
    widths = most_apart([stats["frame_width"] for _, stats in shots])
    line = "%-32s point moves %7.3f pixels, frame's width %6.3f-fold" % (what, moved, widths)
    if fog:
        mean = [brightness(picture, stats, point, fog) for picture, stats in shots]
        line += ", brightness %6.3f-fold (%.2f to %.2f)" % (most_apart(mean), min(mean), max(mean))
    print(line)


def load(folder, name, frame):
    base = os.path.join(folder, "%s.%04d" % (name, frame))
    with open(base + ".json") as file:
        return base + ".png", json.load(file)


def compare(name, folder, pattern, frames, fog=None, point=None):
    listed = ",".join(map(str, frames))
    together, alone = os.path.join(folder, name + "_all"), os.path.join(folder, name + "_one")
    render(pattern, together + ".####.png", together + ".####.json", "--frames", listed)
    for frame in frames:
        one = "%s.%04d" % (alone, frame)
        render(pattern.replace("####", "%04d" % frame), one + ".png", one + ".json")
    shots = {kind: [load(folder, name + kind, frame) for frame in frames]
             for kind in ("_all", "_one")}
    point = point or shots["_all"][0][1]["target"]
    report(name + ", a sequence", shots["_all"], point, fog)
    report(name + ", each by itself", shots["_one"], point, fog)


def compare_turntable(folder, volume, count=24):
    name = os.path.join(folder, "turn")
    render(volume, name + "_all.####.png", name + "_all.####.json", "--turntable", str(count))
    together = [load(folder, "turn_all", frame) for frame in range(1, count + 1)]
    for frame, (_, stats) in enumerate(together, 1):
        one = "%s_one.%04d" % (name, frame)
        camera = stats["camera"]
        axes = ["--%s=%s" % (axis, ",".join(map(repr, camera[axis]))) for axis in ("direction", "up")]
        render(volume, one + ".png", one + ".json", *axes)
    alone = [load(folder, "turn_one", frame) for frame in range(1, count + 1)]
    middle = together[0][1]["target"]
    report("turntable, a sequence", together, middle, None)
    report("turntable, each by itself", alone, middle, None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", help="pictures are left here")
    parser.add_argument("--frames", nargs=2, action="append", default=[],
                        metavar=("PATTERN", "RANGE"), help="with #### for the number; as 1-10")
    parser.add_argument("--turntable", metavar="VOLUME")
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    pattern, frames = write_fog(options.folder)
    compare("fog", options.folder, pattern, frames, fog=RADIUS / 2, point=STILL)
    for pattern, frames in options.frames:
        first, last = map(int, frames.split("-"))
        name = os.path.basename(os.path.dirname(os.path.abspath(pattern)))
        compare(name, options.folder, pattern, range(first, last + 1))
    if options.turntable:
        compare_turntable(options.folder, options.turntable)


if __name__ == "__main__":
    main()
