#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Sends a sequence, or one picture in parts, to OpenCue by PyOutline.

    opencue.py --show testing --shot sh010 --frames 1-100 in/smoke.####.vdb out/smoke.####.exr \
        -- --size 1024x1024
    opencue.py --show testing --shot sh010 --parts 4 smoke.vdb smoke.exr -- --size 8192x8192

What follows -- are options of render. The files lie where all hosts reach them; a frame that is
retried, or a job that is sent again, goes on where it was.
"""

import argparse
import getpass

import outline
import outline.cuerun
from outline.modules.shell import Shell


def sequence(job, args):
    first_pass = args.output + ".json"
    common = [args.program, "render", args.input, "--first-pass", first_pass]
    look = Shell("first_pass", command=common + ["--frames", args.frames] + args.options,
                 range="1", threads=args.threads)
    # A host's frames: #FRAMESPEC# is all of a chunk, the last one's included, however many it has.
    render = Shell("render",
                   command=common + ["-o", args.output, "--frames", "#FRAMESPEC#",
                                     "--skip-existing", "--keep-going", "--alf-progress",
                                     "--threads", str(args.threads)] + args.options,
                   range=args.frames, chunk=args.chunk, threads=args.threads)
    render.depend_all(look)
    job.add_layer(look)
    job.add_layer(render)


def picture(job, args):
    count = args.parts
    parts = Shell("parts",
                  command=[args.program, "render", args.input, "-o",
                           f"{args.output}.#IFRAME#.slabs", "--slab-range", f"#IFRAME#/{count}",
                           "--alf-progress", "--threads", str(args.threads)] + args.options,
                  range=f"1-{count}", chunk=1, threads=args.threads)
    files = [f"{args.output}.{i}.slabs" for i in range(1, count + 1)]
    fold = Shell("fold", command=[args.program, "fold"] + files + ["-o", args.output],
                 range="1", threads=args.threads)
    fold.depend_all(parts)
    job.add_layer(parts)
    job.add_layer(fold)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--show", required=True)
    parser.add_argument("--shot", required=True)
    parser.add_argument("--frames", default="1-100")
    parser.add_argument("--chunk", type=int, default=10)
    parser.add_argument("--parts", type=int, default=0, help="of one picture, in place of frames")
    parser.add_argument("--threads", type=int, default=1, help="cores of a task")
    parser.add_argument("--program", default="deltasplat")
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("options", nargs="*")
    args = parser.parse_args()
    job = outline.Outline("deltasplat", shot=args.shot, show=args.show, user=getpass.getuser())
    (picture if args.parts else sequence)(job, args)
    outline.cuerun.launch(job, use_pycuerun=False)


if __name__ == "__main__":
    main()
