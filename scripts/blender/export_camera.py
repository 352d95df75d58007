# SPDX-License-Identifier: Apache-2.0
"""Writes a camera of a Blender scene for `deltasplat render --camera` (docs/cameras.md).

Usage: blender -b SHOT.blend -P export_camera.py -- OUT.json [--camera NAME] [--frames FIRST-LAST]

Without --camera it is the scene's, without --frames it stands still where it is at the current
frame. The world is Blender's, z up: a .vdb that Blender has imported without moving it lies there
as it does for deltasplat.
"""
import argparse
import json
import sys

import bpy

PROJECTIONS = {"PERSP": "perspective", "ORTHO": "ortho"}


def film(scene, data):
    """Width of the film back in mm, and what mm the sensor's size is (shifts are shares of it)."""
    render = scene.render
    width, height = picture_size(scene)
    tall = height * render.pixel_aspect_y / render.pixel_aspect_x  # in widths of pixels
    fit = data.sensor_fit
    if fit == "AUTO":
        fit = "HORIZONTAL" if width >= tall else "VERTICAL"
        sensor = data.sensor_width
    else:
        sensor = data.sensor_width if fit == "HORIZONTAL" else data.sensor_height
    # The sensor is as long as the picture's width or height, whichever it fits.
    return sensor * width / (width if fit == "HORIZONTAL" else tall), sensor


def picture_size(scene):
    render = scene.render
    share = render.resolution_percentage / 100
    return int(render.resolution_x * share), int(render.resolution_y * share)


def key(scene, camera):
    """What may change from frame to frame."""
    data = camera.data
    aperture, sensor = film(scene, data)
    # Points as rows; Blender's cameras are never scaled.
    matrix = camera.matrix_world.normalized().transposed()
    result = {
        "aperture": aperture,
        "offset": [data.shift_x * sensor, data.shift_y * sensor],
        "near": data.clip_start,
        "far": data.clip_end,
        "matrix": [list(row) for row in matrix],
    }
    if data.type == "ORTHO":
        result["frame_width"] = data.ortho_scale * aperture / sensor
    else:
        result["focal"] = data.lens
    return result


def describe(scene, camera, frames=None):
    """Returns the camera as the JSON file has it; `frames` are to be keys."""
    data = camera.data
    if data.type not in PROJECTIONS:
        sys.exit(f"{camera.name}: got a camera of type {data.type}; expected one of "
                 + ", ".join(PROJECTIONS))
    render = scene.render
    result = {
        "projection": PROJECTIONS[data.type],
        "size": list(picture_size(scene)),
        "pixel_aspect": render.pixel_aspect_x / render.pixel_aspect_y,
        "up_axis": "z",
    }
    if not frames:
        result.update(key(scene, camera))
        return result
    result["keys"] = []
    for frame in frames:
        scene.frame_set(frame)
        result["keys"].append({"frame": frame, **key(scene, camera)})
    return result


def frame_range(text):
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def main(arguments):
    parser = argparse.ArgumentParser(prog="export_camera.py")
    parser.add_argument("out")
    parser.add_argument("--camera", help="name of the object; else the scene's")
    parser.add_argument("--frames", type=frame_range, help="such as 1-100: a key for each")
    options = parser.parse_args(arguments)
    scene = bpy.context.scene
    camera = bpy.data.objects.get(options.camera) if options.camera else scene.camera
    if camera is None or camera.type != "CAMERA":
        sys.exit(f"--camera: got {options.camera or 'a scene without one'}; expected a camera's name")
    with open(options.out, "w") as file:
        json.dump(describe(scene, camera, options.frames), file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:])
