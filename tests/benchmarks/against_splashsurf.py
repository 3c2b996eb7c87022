#!/usr/bin/env python3
"""Tracking against meshing anew: FlowSkin and splashsurf on the same particles, CPU time of one thread.

A sloshing block (2 : 1 : 1, with vortices, jittered by 0.2 spacings, moving about 0.3 spacings a frame) is written as
files. `flowskin track` follows it; splashsurf (PyPI: pysplashsurf) meshes each frame anew with the same cell of 0.75
spacings, smooths it 25 times with weights, cleans up, computes normals, and carries over velocity and rest position.
Times are CPU time: whole process for FlowSkin, the difference between a long and a short sequence, so that starting and
the first mesh do not count; what its stages take is split by frames.csv. The two take turns. The ratio counts.

    tests/benchmarks/against_splashsurf.py 10000 100000 1000000     # needs numpy; pysplashsurf for the right half
"""

import argparse
import csv
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

try:
    import pysplashsurf
except ImportError:
    pysplashsurf = None

ROOT = pathlib.Path(__file__).resolve().parents[2]
STAGES = ("source", "tracking", "topology", "statistics", "writing")


def start_positions(per_side, random):
    """A lattice of spacing 1, 2n x n x n, jittered."""
    grid = np.stack(np.meshgrid(np.arange(2 * per_side), np.arange(per_side), np.arange(per_side), indexing="ij"), -1)
    points = grid.reshape(-1, 3).astype(float)
    return points + random.uniform(-0.2, 0.2, points.shape)


def velocity(x, size, t):
    """A standing wave in the long direction and two vortices: free of divergence, in spacings a frame."""
    k, l = np.pi / size[0], np.pi / size[1]
    swing = 0.25 * np.cos(0.3 * t)
    u = swing * np.sin(k * x[:, 0]) * np.cos(l * x[:, 1])
    v = -swing * (k / l) * np.cos(k * x[:, 0]) * np.sin(l * x[:, 1])
    a = 2 * np.pi / size[0]
    u += 0.1 * np.sin(a * x[:, 0]) * np.cos(np.pi * x[:, 2] / size[2])
    w = -0.1 * (a * size[2] / np.pi) * np.cos(a * x[:, 0]) * np.sin(np.pi * x[:, 2] / size[2])
    return np.stack([u, v, w], 1)


def write_sequence(folder, per_side, frames):
    """frame_0000.npz ... with positions and velocities; times are whole frames."""
    random = np.random.default_rng(7)
    x = start_positions(per_side, random)
    size = np.array([2 * per_side - 1, per_side - 1, per_side - 1], float)
    ids = np.arange(len(x))
    for frame in range(frames):
        np.savez(folder / f"frame_{frame:04}.npz", positions=x, velocities=velocity(x, size, frame), ids=ids)
        for step in range(4):  # classical Runge-Kutta, four steps a frame
            t, h = frame + step / 4, 0.25
            k1 = velocity(x, size, t)
            k2 = velocity(x + h / 2 * k1, size, t + h / 2)
            k3 = velocity(x + h / 2 * k2, size, t + h / 2)
            k4 = velocity(x + h * k3, size, t + h)
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return len(x)


def run_flowskin(program, folder, frames, threads, options):
    """CPU seconds, wall seconds, seconds by stage of the last half of the frames (wall), peak memory (B), vertices."""
    out = folder / "run"
    files = [str(folder / f"frame_{frame:04}.npz") for frame in range(frames)]
    command = [str(program), "track", *files, "--spacing", "1", "--frame-rate", "1", "--no-pictures", "--overwrite",
               "--threads", str(threads), "--out", str(out), *options]
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - begin
    if status != 0:
        sys.exit(f"{' '.join(command[:3])} ... failed:\n{said.decode()}")
    with open(out / "frames.csv", newline="") as file:
        rows = list(csv.DictReader(file))[frames // 2:]
    stages = {stage: sum(float(row["seconds_" + stage]) for row in rows) / len(rows) for stage in STAGES}
    return (usage.ru_utime + usage.ru_stime, wall, stages, usage.ru_maxrss * 1024, int(rows[-1]["vertices"]))


def run_splashsurf(folder, frames):
    """CPU seconds a frame."""
    total = 0.0
    for frame in range(frames):
        data = np.load(folder / f"frame_{frame:04}.npz")
        x, v = data["positions"], data["velocities"]
        rest = np.load(folder / "frame_0000.npz")["positions"]
        begin = resource.getrusage(resource.RUSAGE_SELF)
        pysplashsurf.reconstruction_pipeline(
            x, attributes_to_interpolate={"velocity": v, "rest": rest}, particle_radius=0.5, smoothing_length=2.0,
            cube_size=1.5, iso_surface_threshold=0.6, multi_threading=False, mesh_cleanup=True, compute_normals=True,
            mesh_smoothing_iters=25, mesh_smoothing_weights=True)
        end = resource.getrusage(resource.RUSAGE_SELF)
        total += end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime
    return total / frames


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("particles", nargs="*", type=int, default=[10_000, 100_000], help="numbers of particles")
    parser.add_argument("--flowskin", type=pathlib.Path, default=ROOT / "build/flowskin", metavar="FILE")
    parser.add_argument("--frames", type=int, default=6, help="of the long sequence (default: 6)")
    parser.add_argument("--threads", type=int, default=1, help="of FlowSkin (default: 1)")
    parser.add_argument("--option", action="append", default=[], help="handed on to flowskin track")
    options = parser.parse_args()
    print("| particles | vertices | FlowSkin, CPU s a frame | without writing | tracking and statistics, us a vertex "
          "| memory, B a particle | splashsurf | ratio | ratio without writing |")
    print("|---|---|---|---|---|---|---|---|---|")
    for wanted in options.particles:
        per_side = max(4, round((wanted / 2) ** (1 / 3)))
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            count = write_sequence(folder, per_side, options.frames)
            short = run_flowskin(options.flowskin, folder, 2, options.threads, options.option)
            other = run_splashsurf(folder, 2) if pysplashsurf else float("nan")
            long = run_flowskin(options.flowskin, folder, options.frames, options.threads, options.option)
            if pysplashsurf:
                other = (other + run_splashsurf(folder, 2)) / 2
        cpu = (long[0] - short[0]) / (options.frames - 2)
        stages = long[2]
        outside = sum(stages[stage] for stage in STAGES)
        share = {stage: stages[stage] / outside for stage in STAGES}
        inner = cpu * (1 - share["writing"])
        pure = cpu * (share["tracking"] + share["topology"] + share["statistics"])
        print(f"| {count:,} | {long[4]:,} | {cpu:.2f} | {inner:.2f} | {1e6 * pure / long[4]:.1f} | {long[3] / count:,.0f} "
              f"| {other:.2f} | {cpu / other:.2f} | {inner / other:.2f} |", flush=True)
        print("  stages: " + ", ".join(f"{stage} {100 * share[stage]:.0f} %" for stage in STAGES), file=sys.stderr)


if __name__ == "__main__":
    main()
