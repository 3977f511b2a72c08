"""An OBJ with its MTL as arrays: what the peers are given. Reads what `certilux generate` writes."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass
class Scene:
    """Triangles; `face` is the 0-based index of the `f` line that each came from."""

    vertices: np.ndarray  # (n, 3), file units
    triangles: np.ndarray  # (t, 3)
    face: np.ndarray  # (t,)
    material: np.ndarray  # (t,)
    reflectance: np.ndarray  # (m, 3)
    emission: np.ndarray  # (m, 3), W/m2/sr

    def corners(self) -> np.ndarray:
        """(t, 3 corners, 3)"""
        return self.vertices[self.triangles]

    def normals_and_areas(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit normals of the fronts, and areas."""
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        cross = np.cross(b - a, c - a)
        length = np.linalg.norm(cross, axis=1)
        return cross / length[:, None], 0.5 * length


def read(path: Path) -> Scene:
    """Reads a file; polygons become fans."""
    names, reflectance, emission = {}, [], []
    vertices, triangles, face, material = [], [], [], []
    current, faces = 0, 0
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "mtllib":
            for name, kd, ke in read_materials(path.parent / rest[0]):
                names[name] = len(reflectance)
                reflectance.append(kd)
                emission.append(ke)
        elif word == "v":
            vertices.append([float(x) for x in rest[:3]])
        elif word == "usemtl":
            current = names[rest[0]]
        elif word == "f":
            corners = [int(corner.split("/")[0]) - 1 for corner in rest]
            for b, c in zip(corners[1:], corners[2:]):
                triangles.append([corners[0], b, c])
                face.append(faces)
                material.append(current)
            faces += 1
    return Scene(
        *(np.array(x) for x in (vertices, triangles, face, material, reflectance, emission))
    )


def read_materials(path: Path):
    """Name, Kd and Ke of each material."""
    name, kd, ke = None, [0.0] * 3, [0.0] * 3
    for line in path.read_text().splitlines() + ["newmtl"]:
        word, *rest = line.split() or [""]
        if word == "newmtl":
            if name is not None:
                yield name, kd, ke
            name, kd, ke = (rest or [None])[0], [0.0] * 3, [0.0] * 3
        elif word == "Kd":
            kd = [float(x) for x in rest]
        elif word == "Ke":
            ke = [float(x) for x in rest]


@dataclass
class Wanted:
    """Triangles and sides that are asked for: `pieces` in all, of which one face may have several."""

    keys: list  # (face, side) of each piece
    piece: np.ndarray  # (p,) triangle
    sign: np.ndarray  # (p,) 1 in front, -1 behind
    normal: np.ndarray  # (p, 3) on the side
    area: np.ndarray  # (p,)
    counts: np.ndarray  # (p,) samples


def read_wanted(scene: Scene, path: Path, samples: int) -> Wanted:
    """The [face, side] pairs of a JSON file, with about `samples` samples in all."""
    normals, areas = scene.normals_and_areas()
    sides = {tuple(pair) for pair in json.loads(path.read_text())}
    pieces = [(t, s) for t, f in enumerate(scene.face) for s in (0, 1) if (f, s) in sides]
    keys = [(int(scene.face[t]), s) for t, s in pieces]
    piece = np.array([t for t, _ in pieces])
    sign = np.array([1.0 - 2.0 * s for _, s in pieces])
    counts = spread_by_area(areas[piece], samples)
    return Wanted(keys, piece, sign, normals[piece] * sign[:, None], areas[piece], counts)


def write_faces(path: Path, wanted: Wanted, radiosity: np.ndarray) -> None:
    """Means of the pieces' radiosities, (p, 3), as a list of [face, side, mean of the channels]."""
    faces = per_face(wanted.keys, radiosity.mean(axis=1), wanted.area)
    path.write_text(json.dumps([[f, s, float(b)] for (f, s), b in faces.items()]))


def spread_by_area(areas: np.ndarray, samples: int) -> np.ndarray:
    """How many of about `samples` samples each piece gets: in proportion to area, at least one."""
    return np.maximum(1, np.rint(samples * areas / areas.sum())).astype(np.int64)


def per_face(keys, values, areas):
    """Area-weighted means of `values` over the pieces of each (face, side) in `keys`."""
    total, weight = {}, {}
    for key, value, area in zip(keys, values, areas):
        total[key] = total.get(key, 0.0) + area * value
        weight[key] = weight.get(key, 0.0) + area
    return {key: total[key] / weight[key] for key in total}
