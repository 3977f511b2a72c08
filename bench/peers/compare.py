#!/usr/bin/env python3
"""Processor seconds against error: Mitsuba 3, Radiance and certilux on the same built-in scenes, in one run.

    bench/peers/compare.py --certilux target/release/certilux --scratch SCRATCH --out bench/runs/DATE-HOST/peers

The error is the relative RMS error of `certilux error` (reflected radiosity a face, mean of the channels, weighted by area), with
the reference's noise taken off as a root of the difference of squares. Seconds are processor seconds of a whole program,
start-up included: reading the OBJ, the solve, writing what it found. Mitsuba's kernels are compiled and in its cache before the first run that
counts. Each point is the median of the seeds; the seconds that an error costs are interpolated on straight lines in logarithms.
"""

import argparse
import json
import math
import os
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

import environment

HERE = Path(__file__).resolve().parent
# By scene: the error at which the tools are compared; seconds of our own reference, or 0 where the reference is Mitsuba's (ours
# asks for the same relative error of dark faces, and takes too long in these); samples of each of Mitsuba's reference runs.
SCENES = {
    "cornell": (0.02, 60, 1 << 21),
    "two-rooms": (0.02, 150, 1 << 21),
    "corridor": (0.02, 0, 1 << 21),
    "offices": (0.05, 0, 1 << 25),
}
# Runs of Mitsuba that make a reference, where it is not ours, or are held against ours.
REFERENCE_SEEDS = 16
# Ladders, from cheap to dear; each is climbed until the error is below the target.
SAMPLES = [1 << k for k in range(14, 30)]
EPSILONS = ["1e-2", "1e-3", "3e-4", "1e-4", "3e-5", "1e-5", "3e-6", "1e-6"]
# Points and ambient settings of rtrace.
RADIANCE = [
    (1000, "-ab 4 -ad 128 -as 0 -aa 0.3 -ar 16"),
    (2000, "-ab 5 -ad 256 -as 0 -aa 0.2 -ar 32"),
    (4000, "-ab 6 -ad 512 -as 0 -aa 0.15 -ar 64"),
    (8000, "-ab 7 -ad 1024 -as 0 -aa 0.1 -ar 128"),
]


def processor_seconds(command: list, **options) -> float:
    """Runs a program; user and system seconds of it and of what it started."""
    process = subprocess.Popen([str(word) for word in command], **options)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{' '.join(str(w) for w in command)} failed")
    return usage.ru_utime + usage.ru_stime


def reflecting_faces(path: Path) -> list:
    """The records of a reference that the error looks at."""
    return [face for face in json.loads(path.read_text())["faces"] if any(face["Kd_rgb"])]


def emitted(face: dict) -> float:
    return math.pi * sum(face["Ke_rgb"]) / 3


class Truth:
    """Faces of a reference that reflect."""

    def __init__(self, path: Path):
        self.faces = {}
        for face in reflecting_faces(path):
            key = (face["face_index"], face.get("side", 0))
            radiosity, noise = sum(face["B_rgb"]) / 3 - emitted(face), sum(face["stderr_rgb"]) / 3
            self.faces[key] = (face["area"], radiosity, noise)
        self.area = sum(a for a, _, _ in self.faces.values())
        self.light = sum(a * y for a, y, _ in self.faces.values())

    def rms(self, difference) -> float:
        """Area-weighted RMS over the mean radiosity."""
        squares = sum(a * difference(key) ** 2 for key, (a, _, _) in self.faces.items())
        return math.sqrt(squares / self.area) * self.area / self.light

    def noise(self) -> float:
        return self.rms(lambda key: self.faces[key][2])

    def error(self, found: dict) -> float:
        return self.rms(lambda key: found.get(key, 0.0) - self.faces[key][1])

    def bias(self, found: dict) -> float:
        wrong = sum(a * (found.get(k, 0.0) - y) for k, (a, y, _) in self.faces.items())
        return wrong / self.light

    def without_noise(self, error: float) -> float:
        return math.sqrt(max(error**2 - self.noise() ** 2, 0.0))


class Bench:
    """One scene and the tools."""

    def __init__(self, options, python: Path, llvm: Path | None, name: str):
        self.options, self.python, self.name = options, python, name
        self.target, seconds, samples = SCENES[name]
        self.folder = options.scratch / name
        self.folder.mkdir(parents=True, exist_ok=True)
        self.environment = {**os.environ}
        if llvm:
            self.environment["DRJIT_LIBLLVM_PATH"] = str(llvm)
        self.obj = self.folder / f"{name}.obj"
        self.wanted, self.found = self.folder / "wanted.json", self.folder / "found.json"
        self.reference, self.sides = self.folder / "reference.json", self.folder / "sides.json"
        processor_seconds([options.certilux, "generate", name, "--out", self.folder, "--quiet"])
        # One round measures little and names every side that takes part.
        self.trace(self.sides, ["--max-seconds", "0.001"])
        keys = [[f["face_index"], f.get("side", 0)] for f in reflecting_faces(self.sides)]
        self.wanted.write_text(json.dumps(keys))
        if not self.reference.exists() and seconds:
            self.trace(self.reference, ["--error", "0.001", "--max-seconds", str(seconds)])
        elif not self.reference.exists():
            self.write_reference(*self.many(samples))
        self.truth = Truth(self.reference)

    def trace(self, out: Path, flags: list) -> None:
        """A reference of our own."""
        command = [self.options.certilux, "reference", self.obj, "--out", out, "--seed", "2"]
        processor_seconds([*command, *flags, "--quiet"])

    def many(self, samples: int) -> tuple[dict, dict]:
        """Mean of many of Mitsuba's runs, and its standard error."""
        runs = []
        for seed in range(100, 100 + REFERENCE_SEEDS):
            self.mitsuba(samples, seed)
            runs.append(self.read())
        mean = {k: statistics.fmean(r[k] for r in runs) for k in runs[0]}
        error = {k: statistics.stdev(r[k] for r in runs) / math.sqrt(len(runs)) for k in runs[0]}
        return mean, error

    def write_reference(self, mean: dict, error: dict) -> None:
        """In the format of `certilux reference`, with the mean of the channels in each."""
        faces = reflecting_faces(self.sides)
        for face in faces:
            key = (face["face_index"], face.get("side", 0))
            face["B_rgb"] = 3 * [max(mean[key], 0.0) + emitted(face)]
            face["stderr_rgb"] = 3 * [error[key]]
        text = json.dumps({"meta": {"program": "Mitsuba"}, "faces": faces})
        self.reference.write_text(text)

    def read(self) -> dict:
        return {(f, s): b for f, s, b in json.loads(self.found.read_text())}

    def mitsuba(self, samples: int, seed: int) -> float:
        command = [self.python, HERE / "mitsuba_faces.py", self.obj, self.wanted]
        return processor_seconds([*command, samples, seed, self.found], env=self.environment)

    def radiance(self, points: int, settings: str) -> float:
        command = [self.python, HERE / "radiance_faces.py", self.obj, self.wanted]
        return processor_seconds([*command, points, settings, self.found], env=self.environment)

    def certilux(self, epsilon: str, rays: int, seed: int) -> float:
        solved = self.folder / "solved"
        flags = ["--epsilon", epsilon, "--rays", rays, "--seed", seed, "--no-view", "--quiet"]
        program = self.options.certilux
        seconds = processor_seconds([program, "solve", self.obj, "--out", solved, *flags])
        report = self.folder / "error.json"
        command = [program, "error", solved, self.reference, "--json", report]
        subprocess.run([str(w) for w in command], check=True, capture_output=True)
        faces = json.loads(report.read_text())["faces"]
        found = [[f["face_index"], f["side"], f["solution"]] for f in faces]
        self.found.write_text(json.dumps(found))
        return seconds

    def point(self, tool: str, settings: str, run, seeds) -> dict:
        """Median of the seeds."""
        seconds, errors, biases = [], [], []
        for seed in seeds:
            seconds.append(run(seed))
            found = self.read()
            errors.append(self.truth.without_noise(self.truth.error(found)))
            biases.append(self.truth.bias(found))
        row = {
            "scene": self.name,
            "tool": tool,
            "settings": settings,
            "seeds": len(seconds),
            "seconds": statistics.median(seconds),
            "error": statistics.median(errors),
            "bias": statistics.median(biases),
        }
        print("{scene} {tool} {settings}: {seconds:.2f} s, {error:.4f}".format(**row), flush=True)
        return row

    def ladder(self, tool: str, steps: list, run, seeds) -> list:
        """Rows from cheap to dear until the error is below the target and one step further, or time is up."""
        rows = []
        for settings in steps:
            rows.append(self.point(tool, str(settings), lambda seed: run(settings, seed), seeds))
            below = [r for r in rows if r["error"] < self.target]
            if len(below) > 1 or rows[-1]["seconds"] > self.options.max_seconds:
                break
        return rows

    def rows(self) -> list:
        seeds = range(1, self.options.seeds + 1)
        # Once without the clock: kernels are compiled and kept.
        self.mitsuba(SAMPLES[0], 1)
        rows = self.ladder("mitsuba", SAMPLES, self.mitsuba, seeds)
        for rays in self.options.rays:
            run = lambda epsilon, seed: self.certilux(epsilon, rays, seed)
            rows += self.ladder(f"certilux --rays {rays}", EPSILONS, run, seeds)
        if not self.options.without_radiance:
            run = lambda step, _: self.radiance(*step)
            rows += self.ladder("radiance", RADIANCE, run, [1])
        return rows

    def agreement(self) -> dict:
        """Our reference against Mitsuba's mean over many seeds."""
        mean, error = self.many(SCENES[self.name][2])
        keys = list(self.truth.faces)
        both = {k: math.hypot(error[k], self.truth.faces[k][2]) for k in keys}
        scores = [abs(mean[k] - self.truth.faces[k][1]) / both[k] for k in keys if both[k] > 0]
        return {
            "scene": self.name,
            "difference": self.truth.error(mean),
            "expected": self.truth.rms(lambda k: both[k]),
            "bias": self.truth.bias(mean),
            "greatest_score": max(scores),
            "scores_above_3": sum(s > 3 for s in scores) / len(scores),
            "faces": len(keys),
        }


def cost(rows: list, target: float):
    """Seconds that `target` costs, on straight lines in logarithms; None where the ladder does not reach it."""
    best = None
    for before, after in zip([None, *rows], rows):
        if after["error"] > target:
            continue
        seconds = after["seconds"]
        if before and before["error"] > target and after["error"] > 0:
            share = math.log(before["error"] / target) / math.log(before["error"] / after["error"])
            seconds = before["seconds"] * (after["seconds"] / before["seconds"]) ** share
        best = seconds if best is None else min(best, seconds)
    return best


def table(scenes: list, rows: list) -> str:
    """Seconds at the target by tool, and how many times ours."""
    lines = ["| scene | error | Mitsuba | Radiance | certilux | Mitsuba / certilux |", "|---|---|---|---|---|---|"]
    for name in scenes:
        target = SCENES[name][0]
        at = {}
        for tool in dict.fromkeys(r["tool"] for r in rows if r["scene"] == name):
            found = cost([r for r in rows if (r["scene"], r["tool"]) == (name, tool)], target)
            kind = tool.split()[0]
            if found is not None:
                at[kind] = min(found, at.get(kind, math.inf))
        cell = lambda tool: f"{at[tool]:.2f} s" if tool in at else "not reached"
        ratio = f"{at['mitsuba'] / at['certilux']:.2f}" if {"mitsuba", "certilux"} <= at.keys() else ""
        cells = [name, f"{100 * target:g} %", cell("mitsuba"), cell("radiance"), cell("certilux"), ratio]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--certilux", type=Path, default=HERE.parent.parent / "target/release/certilux")
    parser.add_argument("--scratch", type=Path, required=True, help="environment, scenes and references; kept")
    parser.add_argument("--out", type=Path, required=True, help="folder for peers.csv, table.md and agreement.json")
    parser.add_argument("--scenes", nargs="+", default=["cornell", "two-rooms", "corridor"], choices=SCENES)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--rays", type=int, nargs="+", default=[8], help="certilux is tried with each")
    parser.add_argument("--max-seconds", type=float, default=120.0, help="a ladder ends after a run of so many seconds")
    parser.add_argument("--without-radiance", action="store_true")
    parser.add_argument("--without-agreement", action="store_true")
    options = parser.parse_args()
    options.scratch = options.scratch.resolve()
    options.scratch.mkdir(parents=True, exist_ok=True)
    options.certilux = options.certilux.resolve()
    python = environment.python_of(options.scratch)
    if Path(sys.prefix) != python.parent.parent:
        os.execv(python, [str(python), *sys.argv])
    llvm = environment.find_llvm(options.scratch)
    options.out.mkdir(parents=True, exist_ok=True)
    rows, agreement = [], []
    columns = ["scene", "tool", "settings", "seeds", "seconds", "error", "bias"]
    for name in options.scenes:
        bench = Bench(options, python, llvm, name)
        rows += bench.rows()
        lines = [",".join(columns)] + [",".join(f'"{r[c]}"' if c == "settings" else str(r[c]) for c in columns) for r in rows]
        (options.out / "peers.csv").write_text("\n".join(lines) + "\n")
        if SCENES[name][1] and not options.without_agreement:
            agreement.append(bench.agreement())
            print(json.dumps(agreement[-1]), flush=True)
    (options.out / "agreement.json").write_text(json.dumps(agreement, indent=1) + "\n")
    text = table(options.scenes, rows)
    (options.out / "table.md").write_text(text)
    print(f"{platform.machine()}, {os.cpu_count()} processors, {time.strftime('%Y-%m-%d')}\n\n{text}")


if __name__ == "__main__":
    main()
