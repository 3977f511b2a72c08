#!/usr/bin/env python3
"""Reads everything that `certilux solve` writes with other projects' readers.

    tests/readers/check.py target/release/certilux [SCENE...]

The readers (plyfile, trimesh, meshio, pyvista, OpenEXR from PyPI, the glTF validator from npm) are installed into
target/readers the first time.
"""

import json
import shutil
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
SCRATCH = HERE.parents[1] / "target" / "readers"
SCENES = ["builtin:cornell", "builtin:two-rooms", "builtin:cie171-5.4"]
# What is up in each, so that every way of turning a GLB is read.
UP = ["y", "x", "z"]
# Where +y of a turned GLB, and its other axes, come from: axis and sign.
TURNED = {"x": ([1, 0, 2], [-1, 1, 1]), "y": ([0, 1, 2], [1, 1, 1]), "z": ([0, 2, 1], [1, 1, -1])}


def run(*words, **options):
    return subprocess.run([str(w) for w in words], check=True, **options)


def install():
    """The scratch environment; its interpreter."""
    python = SCRATCH / "venv" / "bin" / "python"
    wanted = (HERE / "requirements.txt").read_text() + (HERE / "package.json").read_text()
    stamp = SCRATCH / "installed"
    if not (stamp.exists() and stamp.read_text() == wanted):
        shutil.rmtree(SCRATCH, ignore_errors=True)
        venv.create(SCRATCH / "venv", with_pip=True)
        run(python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt")
        for name in ["package.json", "validate.js"]:
            shutil.copy(HERE / name, SCRATCH)
        run("npm", "install", "--silent", "--no-audit", "--no-fund", cwd=SCRATCH)
        stamp.write_text(wanted)
    return python


def check(folder, up):
    """Compares what the readers find with each other and with stats.json."""
    import meshio
    import numpy
    import OpenEXR
    import plyfile
    import pyvista
    import trimesh

    folder = Path(folder)
    stats = json.loads((folder / "stats.json").read_text())
    leaves = stats["hierarchy"]["leaves"]

    ply = plyfile.PlyData.read(folder / "solution.ply")
    faces, vertices = ply["face"], ply["vertex"]
    points = numpy.stack([vertices[axis] for axis in "xyz"], axis=1)
    triangles = numpy.stack(faces["vertex_indices"])
    assert len(triangles) == leaves, (len(triangles), leaves)

    # VTK's own reader, and one that shares no code with it.
    grid = pyvista.read(folder / "solution.vtu")
    other = meshio.read(folder / "solution.vtu")
    assert grid.n_cells == leaves and set(grid.celltypes) == {5}
    assert numpy.array_equal(other.cells_dict["triangle"], triangles)
    assert numpy.array_equal(other.points, points)
    assert numpy.array_equal(numpy.asarray(grid.points), points)
    for name in ["radiosity", "irradiance"]:
        columns = numpy.stack([faces[f"{name}_{c}"] for c in "rgb"], axis=1)
        assert numpy.array_equal(grid.cell_data[name], columns), name
        assert numpy.array_equal(other.cell_data[name][0], columns), name
    for name in ["source_face", "side"]:
        assert numpy.array_equal(grid.cell_data[name], faces[name]), name

    report = json.loads(
        run("node", "validate.js", folder / "solution.glb", cwd=SCRATCH, capture_output=True).stdout
    )
    issues = report["issues"]
    assert issues["numErrors"] == 0 and issues["numWarnings"] == 0, issues
    assert report["info"]["totalTriangleCount"] == leaves, report["info"]
    scene = trimesh.load(folder / "solution.glb", process=False)
    [mesh] = scene.geometry.values()
    transform, _ = scene.graph.get("solution")
    assert len(mesh.faces) == leaves
    corners, expected = (mesh.vertices + transform[:3, 3])[mesh.faces], points[triangles]
    axes, signs = TURNED[up]
    expected = expected[..., axes] * signs
    size = numpy.ptp(points, axis=0).max()
    assert numpy.abs(corners - expected).max() < 1e-6 * size
    # With a material trimesh takes colours for an attribute.
    colours = mesh.visual.vertex_attributes["color"]
    assert colours.shape == (len(mesh.vertices), 4) and numpy.ptp(colours[:, :3]) > 20

    with OpenEXR.File(str(folder / "view.exr")) as picture:
        channels = picture.channels()
        names = set(channels)
        # The reader joins R, G, B and A of a layer into one array.
        assert {"RGBA", "irradiance", "normal.X", "depth.Z", "face.ID"} <= names, names
        for name, channel in channels.items():
            assert numpy.isfinite(channel.pixels).all(), name
            assert channel.pixels.shape[:2] == (720, 960), name
        seen = channels["face.ID"].pixels
        assert -1 <= seen.min() and seen.max() < stats["scene"]["faces"]
    print(f"{stats['scene']['path']}: {leaves} patches agree in PLY, VTU and GLB; the EXR has {len(names)} channels")


def main():
    if sys.argv[1] == "--check":
        check(*sys.argv[2:])
        return
    program = Path(sys.argv[1]).resolve()
    python = install()
    for number, scene in enumerate(sys.argv[2:] or SCENES):
        up = UP[number % len(UP)]
        folder = SCRATCH / "solved" / scene.replace(":", "-").replace("/", "-")
        run(program, "--quiet", "--no-config", "solve", scene, "--out", folder, "--format", "glb,vtu", "--up", up, "--epsilon", "1e-4")
        run(python, __file__, "--check", folder, up)


if __name__ == "__main__":
    main()
