"""Mean reflected radiosity of every face and side by Mitsuba 3: run as a program of its own, so that its processor time
is that of the whole, start-up included.

    python mitsuba_faces.py SCENE.obj WANTED.json SAMPLES SEED OUT.json

A sample is a path from a uniformly distributed point of a face: a ray that starts a hair above the point and looks straight at
it, so that the path integrator's emitter sampling and multiple importance sampling work from the face itself. The
whole wavefront is one kernel."""

import sys
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

import obj_scene

mi.set_variant("llvm_ad_rgb")
# Paths of one wavefront: a few hundred bytes each.
WAVEFRONT = 1 << 21
# Height of a ray's start over its face, as a share of the scene's diagonal: far above rounding, far below any gap of the scenes.
LIFT = 1.0e-5


def build(scene: obj_scene.Scene) -> mi.Scene:
    """One mesh a material, two-sided diffuse; the front emits."""
    parts = {"type": "scene"}
    for m, (kd, ke) in enumerate(zip(scene.reflectance, scene.emission)):
        triangles = scene.triangles[scene.material == m]
        if len(triangles) == 0:
            continue
        used, index = np.unique(triangles, return_inverse=True)
        props = mi.Properties()
        diffuse = {"type": "diffuse", "reflectance": {"type": "rgb", "value": kd.tolist()}}
        props["bsdf"] = mi.load_dict({"type": "twosided", "nested": diffuse})
        if ke.any():
            radiance = {"type": "rgb", "value": ke.tolist()}
            props["emitter"] = mi.load_dict({"type": "area", "radiance": radiance})
        mesh = mi.Mesh(f"m{m}", len(used), len(triangles), props=props)
        params = mi.traverse(mesh)
        params["vertex_positions"] = scene.vertices[used].astype(np.float32).ravel()
        params["faces"] = index.reshape(-1).astype(np.uint32)
        params.update()
        parts[f"m{m}"] = mesh
    return mi.load_dict(parts)


def main(path: str, wanted: str, samples: str, seed: str, out: str) -> None:
    scene = obj_scene.read(Path(path))
    want = obj_scene.read_wanted(scene, Path(wanted), int(samples))
    piece, counts = want.piece, want.counts

    corners = scene.corners()[piece].astype(np.float32)
    up = want.normal.astype(np.float32)
    place = [mi.Point3f(*(mi.Float(corners[:, k, x]) for x in range(3))) for k in range(3)]
    normal = mi.Vector3f(*(mi.Float(up[:, x]) for x in range(3)))
    lift = LIFT * float(np.linalg.norm(np.ptp(scene.vertices, axis=0)))
    world = build(scene)
    integrator = mi.load_dict({"type": "path"})

    sums = [dr.zeros(mi.Float, len(piece)) for _ in range(3)]
    owner = np.repeat(np.arange(len(piece), dtype=np.uint32), counts)
    parts = np.array_split(owner, -(-len(owner) // WAVEFRONT))
    for number, part in enumerate(parts):
        # Whole vectors are read, past the end of an array that fills its last page: a padded copy has no such end.
        padded = np.zeros(len(part) + 64, dtype=np.uint32)
        padded[: len(part)] = part
        index = mi.UInt32(padded[: len(part)])
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(int(seed) * 100_003 + number, len(part))
        u = sampler.next_2d()
        root = dr.sqrt(u.x)
        a, b, c = (dr.gather(mi.Point3f, p, index) for p in place)
        n = dr.gather(mi.Vector3f, normal, index)
        point = (1 - root) * a + root * (1 - u.y) * b + root * u.y * c
        ray = mi.RayDifferential3f(mi.Ray3f(point + lift * n, -n))
        radiance, _, _ = integrator.sample(world, sampler, ray)
        for k in range(3):
            dr.scatter_add(sums[k], radiance[k], index)
        dr.eval(sums)
    radiosity = np.pi * np.stack([np.array(s) for s in sums], axis=1) / counts[:, None]
    # What a front emits by itself is no reflected light.
    front = want.sign > 0
    radiosity[front] -= np.pi * scene.emission[scene.material[piece]][front]
    obj_scene.write_faces(Path(out), want, radiosity)


if __name__ == "__main__":
    main(*sys.argv[1:])
