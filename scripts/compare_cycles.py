# SPDX-License-Identifier: Apache-2.0
"""What scripts/compare_cycles.sh has Blender do: render a .vdb with Cycles, compare pictures.

Usage: blender -b --factory-startup -P compare_cycles.py -- render VOLUME STATS OUT [OPTIONS]
       blender -b --factory-startup -P compare_cycles.py -- compare OURS CYCLES_1 CYCLES_2
"""
import argparse
import json
import math
import os
import sys
from array import array

import bpy
from mathutils import Matrix, Vector


def numbers(text):
    return [float(number) for number in text.split(",")]


def parse():
    parser = argparse.ArgumentParser()
    commands = parser.add_subparsers(dest="command", required=True)
    render = commands.add_parser("render")
    render.add_argument("volume")
    render.add_argument("stats", help="of deltasplat's picture: says what its camera was")
    render.add_argument("out")
    render.add_argument("--grid", default="density")
    render.add_argument("--density-scale", type=float, default=0.1)
    render.add_argument("--albedo", type=numbers, default=[1])
    render.add_argument("--anisotropy", type=float, default=0)
    render.add_argument("--light", type=numbers, default=[-1, -0.7, -0.5])
    render.add_argument("--strength", type=float, default=4)
    render.add_argument("--bounces", type=int, default=0)
    render.add_argument("--samples", type=int, default=64)
    render.add_argument("--step", type=float, default=0.5, help="in voxels")
    render.add_argument("--offset", type=float, default=0.5, help="of Blender's values, in voxels")
    render.add_argument("--threads", type=int, default=1)
    render.add_argument("--seed", type=int, default=1)
    compare = commands.add_parser("compare")
    compare.add_argument("pictures", nargs=3)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def link(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_volume(options):
    data = bpy.data.volumes.new("fog")
    data.filepath = os.path.abspath(options.volume)
    if not data.grids.load():
        sys.exit(f"{options.volume}: {data.grids.error_message}")
    if options.grid not in [grid.name for grid in data.grids]:
        sys.exit(f"{options.volume}: no grid {options.grid}")
    world_from_index = data.grids[options.grid].matrix_object
    data.render.space = "WORLD"
    data.render.step_size = options.step * min(world_from_index.to_scale())
    data.render.precision, data.render.clipping = "FULL", 0

    # What is not scattered is swallowed: a "Volume Scatter" node would dim by what it scatters.
    material = bpy.data.materials.new("fog")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    fog = nodes.new("ShaderNodeVolumePrincipled")
    albedo = options.albedo if len(options.albedo) == 3 else options.albedo * 3
    fog.inputs["Color"].default_value = (*albedo, 1)
    fog.inputs["Absorption Color"].default_value = (0, 0, 0, 1)
    fog.inputs["Density"].default_value = options.density_scale
    fog.inputs["Density Attribute"].default_value = options.grid
    fog.inputs["Temperature Attribute"].default_value = ""
    fog.inputs["Anisotropy"].default_value = options.anisotropy
    surface = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(fog.outputs[0], surface.inputs["Volume"])
    data.materials.append(material)
    # Blender has a voxel's value half a voxel off its centre, along each axis.
    link("fog", data).location = world_from_index.to_3x3() @ Vector([-options.offset] * 3)


def add_sun(options):
    # A light of strength 1 has the irradiance pi (scattering.h); a sun of strength 1 here has 1.
    lamp = bpy.data.lights.new("sun", "SUN")
    lamp.energy, lamp.angle = math.pi * options.strength, 0
    sun = link("sun", lamp)
    sun.rotation_mode = "QUATERNION"
    sun.rotation_quaternion = Vector(options.light).to_track_quat("-Z", "Y")


def add_camera(camera):
    data = bpy.data.cameras.new("camera")
    width, height = camera["size"]
    data.sensor_fit = "VERTICAL"
    data.clip_start, data.clip_end = 1e-3, 1e6
    way = Vector(camera["direction"])
    if camera["projection"] == "ortho":
        data.type = "ORTHO"
        data.ortho_scale = camera["frame_width"] * height / width
        eye = Vector(camera["target"]) - way * 10 * camera["frame_width"]
    elif camera["projection"] == "perspective":
        data.angle_y = math.radians(camera["fov"])
        eye = Vector(camera["eye"])
    else:
        sys.exit("projection: got " + camera["projection"] + "; expected ortho or perspective")
    view = Matrix((camera["right"], camera["up"], -way)).transposed().to_4x4()
    thing = link("camera", data)
    thing.matrix_world = Matrix.Translation(eye) @ view
    bpy.context.scene.camera = thing
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100


def render_volume(options):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    with open(options.stats) as file:
        add_camera(json.load(file)["camera"])
    add_volume(options)
    add_sun(options)

    render, cycles = scene.render, scene.cycles
    render.engine, render.film_transparent = "CYCLES", True
    render.threads_mode, render.threads = "FIXED", options.threads
    cycles.device, cycles.samples, cycles.seed = "CPU", options.samples, options.seed
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.volume_bounces = options.bounces
    cycles.volume_max_steps = 65536
    cycles.light_sampling_threshold = cycles.sample_clamp_indirect = 0
    picture = render.image_settings
    picture.file_format, picture.color_mode, picture.color_depth = "OPEN_EXR", "RGBA", "32"
    render.filepath = os.path.abspath(options.out)
    bpy.ops.render.render(write_still=True)


def read_colors(file):
    image = bpy.data.images.load(os.path.abspath(file))
    image.colorspace_settings.name = "Non-Color"
    values = array("f", [0]) * len(image.pixels)
    image.pixels.foreach_get(values)
    return [value for i, value in enumerate(values) if i % 4 < 3]


def psnr(a, b, peak):
    square = sum((x - y) ** 2 for x, y in zip(a, b)) / len(a)
    return math.inf if square == 0 else 10 * math.log10(peak ** 2 / square)


def compare_pictures(files):
    ours, first, second = (read_colors(file) for file in files)
    mean = [(x + y) / 2 for x, y in zip(first, second)]
    peak = max(ours)
    print(f"brightest of ours, the peak below: {peak:.4f}")
    print(f"ours, and the mean of both seeds: {psnr(ours, mean, peak):.2f} dB")
    print(f"one seed, and the other: {psnr(first, second, peak):.2f} dB")
    print(f"mean of ours, of that of Cycles: {sum(ours) / sum(mean):.4f}")


options = parse()
if options.command == "render":
    render_volume(options)
else:
    compare_pictures(options.pictures)
