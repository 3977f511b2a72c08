"""Mean reflected radiosity of every face and side by Radiance's rtrace (irradiance at points, ambient cache), as pyradiance
brings it: run as a program of its own, so that its processor time is that of the whole.

    python radiance_faces.py SCENE.obj WANTED.json POINTS SETTINGS OUT.json

Points are spread by area, at least one a triangle and side; SETTINGS are rtrace's ambient options."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyradiance

import obj_scene

# Height of a point over its face, as a share of the scene's diagonal.
LIFT = 1.0e-5


def describe(scene: obj_scene.Scene) -> str:
    """The scene in Radiance's language: fronts of lights emit, everything reflects diffusely."""
    lines = []
    for m, (kd, ke) in enumerate(zip(scene.reflectance, scene.emission)):
        numbers = " ".join(f"{x:.9g}" for x in (ke if ke.any() else kd))
        kind = f"light m{m} 0 0 3 {numbers}" if ke.any() else f"plastic m{m} 0 0 5 {numbers} 0 0"
        lines.append(f"void {kind}")
    for t, corners in enumerate(scene.corners()):
        numbers = " ".join(f"{x:.9g}" for x in corners.ravel())
        lines.append(f"m{scene.material[t]} polygon t{t} 0 0 9 {numbers}")
    return "\n".join(lines) + "\n"


def main(path: str, wanted: str, points: str, settings: str, out: str) -> None:
    scene = obj_scene.read(Path(path))
    want = obj_scene.read_wanted(scene, Path(wanted), int(points))
    piece, counts = want.piece, want.counts
    owner = np.repeat(np.arange(len(piece)), counts)
    u = np.random.default_rng(1).random((len(owner), 2))
    root = np.sqrt(u[:, :1])
    a, b, c = np.moveaxis(scene.corners()[piece][owner], 1, 0)
    up = want.normal[owner]
    lift = LIFT * np.linalg.norm(np.ptp(scene.vertices, axis=0))
    place = (1 - root) * a + root * (1 - u[:, 1:]) * b + root * u[:, 1:] * c + lift * up
    home = Path(pyradiance.__file__).parent
    environment = {**os.environ, "RAYPATH": f".:{home / 'lib'}"}
    with tempfile.TemporaryDirectory() as folder:
        text = Path(folder, "scene.rad")
        text.write_text(describe(scene))
        octree = Path(folder, "scene.oct")
        with octree.open("wb") as file:
            subprocess.run([home / "bin" / "oconv", text], stdout=file, check=True, env=environment)
        cache = ["-af", str(Path(folder, "cache.amb"))]
        command = [home / "bin" / "rtrace", "-I", "-h", "-faf", "-ov", *settings.split(), *cache, octree]
        rays = np.concatenate([place, up], axis=1)
        rows = "\n".join(" ".join(f"{x:.9g}" for x in row) for row in rays) + "\n"
        done = subprocess.run(command, input=rows.encode(), capture_output=True, check=True, env=environment)
    irradiance = np.frombuffer(done.stdout, dtype=np.float32).reshape(len(owner), 3)
    sums = np.zeros((len(piece), 3))
    np.add.at(sums, owner, irradiance)
    radiosity = scene.reflectance[scene.material[piece]] * sums / counts[:, None]
    obj_scene.write_faces(Path(out), want, radiosity)


if __name__ == "__main__":
    main(*sys.argv[1:])
