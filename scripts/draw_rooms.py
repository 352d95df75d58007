#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the rooms of src/ as docs/rooms.svg: a box for each, bottom to top as CMakeLists.txt declares
them, and a line for each room that uses another, as wide as there are includes.
Usage: python3 scripts/draw_rooms.py [--check]
  --check  writes nothing; ends with 1 where the drawing is not that of the includes"""
import collections
import math
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent


def rooms():
    """Names of rooms, bottom to top, and the room of each public header."""
    text = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    names, owners = [], {}
    for call in re.findall(r"^deltasplat_room\((.*?)\)$", text, re.M | re.S):
        words = call.split()
        names.append(words[0])
        word = ""
        for item in words[1:]:
            if item.isupper():
                word = item
            elif word == "PUBLIC":
                owners["deltasplat/" + item] = words[0]
    return names, owners


def includes(names, owners):
    """How many includes lead from a room to another, and files and lines of each room."""
    uses, sizes = collections.Counter(), {}
    for name in names:
        files = sorted(path for path in (root / "src" / name).rglob("*") if path.suffix in (".h", ".cpp"))
        texts = [path.read_text(encoding="utf-8") for path in files]
        sizes[name] = (len(files), sum(text.count("\n") for text in texts))
        for header in re.findall(r'^#include "([^"]+)"', "\n".join(texts), re.M):
            other = owners.get(header, header.split("/")[0])
            if other in names and other != name:
                uses[name, other] += 1
    return uses, sizes


def drawing(names, uses, sizes):
    step, left, width, height = 44, 16, 250, 30
    top = {name: 16 + step * (len(names) - 1 - i) for i, name in enumerate(names)}
    lines = []
    for (user, used), count in sorted(uses.items(), key=lambda use: names.index(use[0][0])):
        begin, end = top[user] + height / 2 + 4, top[used] + height / 2 - 4
        reach = left + width + 30 + 22 * (abs(names.index(user) - names.index(used)))
        x = left + width
        lines.append(
            f'<path d="M{x} {begin:g} C{reach} {begin:g} {reach} {end:g} {x} {end:g}" fill="none" '
            f'stroke="#3b6ea5" stroke-opacity="0.45" stroke-width="{0.6 + math.log2(1 + count) / 2:.2f}">'
            f"<title>{user} includes {used} {count} times</title></path>"
        )
    for name in names:
        files, count = sizes[name]
        lines.append(
            f'<rect x="{left}" y="{top[name]}" width="{width}" height="{height}" rx="4" fill="#f2f2f2" '
            'stroke="#555"/>'
            f'<text x="{left + 10}" y="{top[name] + 20}" font-weight="bold">{name}</text>'
            f'<text x="{left + width - 10}" y="{top[name] + 20}" text-anchor="end" fill="#555">'
            f"{files} files, {count} lines</text>"
        )
    high = step * len(names) + 20
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 560 {high}" width="560" height="{high}" '
        'font-family="sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="white"/>\n'
        + "\n".join(lines)
        + "\n</svg>\n"
    )


def main():
    names, owners = rooms()
    text = drawing(names, *includes(names, owners))
    file = root / "docs" / "rooms.svg"
    if sys.argv[1:] == ["--check"]:
        arrows = lambda svg: re.findall(r"<title>(\w+ includes \w+)", svg)
        if file.exists() and arrows(file.read_text(encoding="utf-8")) == arrows(text):
            return 0
        print("docs/rooms.svg: got another drawing; expected that of scripts/draw_rooms.py")
        return 1
    file.write_text(text, encoding="utf-8")
    return 0


sys.exit(main())
