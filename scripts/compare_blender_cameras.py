# SPDX-License-Identifier: Apache-2.0
"""What scripts/compare_blender_cameras.sh has Blender do: see where a box's corners are in pictures
by Blender and by deltasplat, of the same cameras.

Usage: blender -b --factory-startup -P compare_blender_cameras.py -- PROGRAM FOLDER
"""
import json
import math
import os
import subprocess
import sys
from array import array

import bpy
from mathutils import Euler, Matrix, Vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "blender"))
import export_camera  # noqa: E402

MIDDLE, HALF = Vector((0.3, -0.2, 0.5)), Vector((1.5, 1.0, 0.7))
CORNERS = [MIDDLE + Vector([h if i >> axis & 1 else -h for axis, h in enumerate(HALF)])
           for i in range(8)]
RADIUS = 0.05
WIDE, HIGH = (320, 200), (200, 300)
# name, picture, pixels' aspect (x, y), how the sensor fits, shift, ortho_scale, frames
CASES = [
    ("perspective", WIDE, (1, 1), "AUTO", (0, 0), None, None),
    ("perspective, shifted, wide pixels", WIDE, (2, 1), "AUTO", (0.12, -0.03), None, None),
    ("perspective, upright, shifted, high pixels", HIGH, (1, 1.25), "AUTO", (-0.1, 0.15), None, None),
    ("perspective, sensor's height, shifted", WIDE, (1, 1.5), "VERTICAL", (0.2, 0.1), None, None),
    ("perspective, sensor's width, upright", HIGH, (1, 1), "HORIZONTAL", (0.1, -0.1), None, None),
    ("ortho", WIDE, (1, 1), "AUTO", (0, 0), 5.5, None),
    ("ortho, shifted, wide pixels", WIDE, (1.5, 1), "AUTO", (-0.08, 0.05), 11, None),
    ("ortho, upright, shifted, high pixels", HIGH, (1, 1.4), "AUTO", (0.05, 0.1), 12, None),
    ("perspective, moving, frame 7", WIDE, (1, 1), "AUTO", (0.05, 0), None, (1, 7, 10)),
]


def link(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def make_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    render = scene.render
    render.engine, render.film_transparent = "CYCLES", True
    render.resolution_percentage = 100
    scene.cycles.device, scene.cycles.samples = "CPU", 64
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type = "BOX"
    picture = render.image_settings
    picture.file_format, picture.color_mode, picture.color_depth = "OPEN_EXR", "RGBA", "32"
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=RADIUS)
    return scene, bpy.context.object


def add_camera(scene, case):
    name, size, aspect, fit, shift, ortho, frames = case
    data = bpy.data.cameras.new(name)
    data.lens = 40 if aspect == (1, 1) and fit == "AUTO" else 18
    data.sensor_width, data.sensor_height = 36, 20
    data.sensor_fit, (data.shift_x, data.shift_y) = fit, shift
    data.clip_start, data.clip_end = 0.5, 50
    if ortho:
        data.type, data.ortho_scale = "ORTHO", ortho
    camera = link(name, data)
    # Within another object that is moved and turned.
    stand = link("stand", None)
    stand.location, stand.rotation_euler = (0.4, 0.1, -0.3), Euler((0.1, -0.2, 0.3))
    camera.parent = stand
    camera.location = (3.5, -5.2, 3.6) if min(size) < size[0] else (4.6, -6.8, 4.7)
    way = stand.matrix_basis.inverted() @ MIDDLE - camera.location
    camera.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    if frames:
        first, _, last = frames
        for frame, to in ((first, (0, 0, 0)), (last, (0.5, 0.3, -0.4))):
            stand.rotation_euler = Euler((0.1 + 0.1 * to[0], -0.2, 0.3 + 0.2 * to[1]))
            stand.location = Vector((0.4, 0.1, -0.3)) + Vector(to)
            stand.keyframe_insert("rotation_euler", frame=frame)
            stand.keyframe_insert("location", frame=frame)
    scene.camera = camera
    render = scene.render
    render.resolution_x, render.resolution_y = size
    render.pixel_aspect_x, render.pixel_aspect_y = aspect
    bpy.context.view_layer.update()
    return camera


def middle_of(file):
    """Returns the mean place of what is not clear, in pixels from the upper left corner."""
    image = bpy.data.images.load(file)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    values = array("f", [0]) * len(image.pixels)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    sums = [0.0, 0.0, 0.0]
    for i, alpha in enumerate(values[3::4]):
        if alpha > 0:
            sums[0] += alpha
            sums[1] += alpha * (i % width + 0.5)
            sums[2] += alpha * (height - i // width - 0.5)
    if sums[0] == 0:
        sys.exit(f"{file}: nothing is seen")
    return sums[1] / sums[0], sums[2] / sums[0]


def write_blob(folder):
    """A round blob, the middle one of whose 11 x 11 x 11 voxels lies at the origin."""
    name = os.path.join(folder, "blob_11x11x11_uint8.raw")
    with open(name, "wb") as file:
        for i in range(11 ** 3):
            square = sum((i // 11 ** axis % 11 - 5) ** 2 for axis in range(3))
            file.write(bytes([round(255 * math.exp(-square / 8)) if square <= 25 else 0]))
    return name


def predicted(key, size, aspect, corner):
    """Where a corner should be, by the numbers of the .json."""
    back = Matrix([row for row in key["matrix"]]).transposed().inverted() @ corner.to_4d()
    width = key.get("frame_width") or key["aperture"] / key["focal"] * -back.z
    shift = [offset * width / key["aperture"] for offset in key["offset"]]
    pixel = width / size[0]
    return (size[0] / 2 + (back.x - shift[0]) / pixel,
            size[1] / 2 - (back.y - shift[1]) / pixel * aspect)


def compare(program, folder):
    scene, ball = make_scene()
    blob = write_blob(folder)
    voxel = RADIUS / 2.5
    worst = 0
    for number, case in enumerate(CASES):
        name, size, aspect, _, _, _, frames = case
        camera = add_camera(scene, case)
        described = export_camera.describe(scene, camera, frames)
        frame = frames[1] if frames else 1
        scene.frame_set(frame)
        file = os.path.join(folder, f"camera_{number}.json")
        with open(file, "w") as out:
            json.dump(described, out, indent=1)
        key = next((one for one in described.get("keys", []) if one["frame"] == frame), described)
        apart, off = [], []
        for i, corner in enumerate(CORNERS):
            ball.location = corner
            theirs = os.path.join(folder, f"blender_{number}_{i}.exr")
            scene.render.filepath = theirs
            bpy.ops.render.render(write_still=True)
            ours = os.path.join(folder, f"ours_{number}_{i}")
            origin = ",".join(repr(c - 5 * voxel) for c in corner)
            command = [program, "render", blob, "-o", ours + (".#.exr" if frames else ".exr"),
                       "--camera", file, f"--spacing={voxel},{voxel},{voxel}",
                       f"--origin={origin}", "--float", "-qq"]
            subprocess.run(command + (["--frames", str(frame)] if frames else []), check=True)
            a = middle_of(theirs)
            b = middle_of(ours + (f".{frame}.exr" if frames else ".exr"))
            apart.append(math.dist(a, b))
            off.append(math.dist(b, predicted(key, size, described["pixel_aspect"], corner)))
        print(f"{name}: corners at most {max(apart):.3f} pixels apart; ours at most "
              f"{max(off):.3f} from where they should be")
        worst = max(worst, *apart, *off)
    print(f"largest distance: {worst:.3f} pixels")
    if worst > 0.5:
        sys.exit("more than half a pixel")


compare(*sys.argv[sys.argv.index("--") + 1:])
