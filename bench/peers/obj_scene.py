"""An OBJ with its MTL as arrays: what the peers are given. Reads what `certilux generate` writes."""

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
