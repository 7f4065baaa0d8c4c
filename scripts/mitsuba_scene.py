"""Renders a scene file of cyltrace with Mitsuba 3, to compare pictures and times.

    pip install mitsuba numpy
    python scripts/mitsuba_scene.py scenes/forest.toml -o forest.npy --size 320x180 --spp 16

It understands what scenes/forest.toml and scenes/lattice.toml use: cylinders and tables of them,
prototypes, placements with one rotation, a sun without an extent, a sky, and the materials diffuse
and glass. Anything else is an error. Mitsuba has open cylinders, so that each cylinder is one
with two disks.

The picture is an array of linear RGB, height x width x 3. A line of JSON on standard output says
how long loading and rendering took.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path

import mitsuba as mi
import numpy as np

Scene = dict


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--max-depth", type=int, default=16)
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--glass", help="render the solids of this material as glass")
    parser.add_argument("--threads", type=int)
    options = parser.parse_args()
    mi.set_variant(options.variant)
    if options.threads:
        mi.Thread.set_thread_count(options.threads)

    start = time.perf_counter()
    document = tomllib.loads(options.scene.read_text())
    width, height = map(int, options.size.split("x"))
    described = describe(document, options.scene.parent, options.glass)
    described["sensor"] = sensor(document["camera"], (width, height))
    described["integrator"] = {"type": "path", "max_depth": options.max_depth}
    scene = mi.load_dict(described)
    loaded = time.perf_counter()
    picture = mi.render(scene, spp=options.spp, seed=options.seed)
    pixels = np.array(picture)[..., :3]
    done = time.perf_counter()
    np.save(options.output, pixels)
    times = {"load_s": loaded - start, "render_s": done - loaded, "variant": options.variant}
    json.dump(times, sys.stdout)
    print()


def sensor(camera: Scene, size: tuple[int, int]) -> Scene:
    check(camera, {"position", "look_at", "up", "fov_degrees"}, "[camera]")
    return {
        "type": "perspective",
        "fov": camera.get("fov_degrees", 40),
        "fov_axis": "y",
        "to_world": mi.ScalarTransform4f().look_at(
            origin=camera["position"],
            target=camera["look_at"],
            up=camera.get("up", [0, 0, 1]),
        ),
        "film": {
            "type": "hdrfilm",
            "width": size[0],
            "height": size[1],
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "independent"},
    }


def describe(document: Scene, folder: Path, glass: str | None) -> Scene:
    keys = {"background", "camera", "render", "film", "sun", "sky", "material", "prototype"}
    check(document, keys | BODY, "the scene")
    materials = {"": diffuse([0.5, 0.5, 0.5])}
    for material in document.get("material", []):
        check(material, {"name", "kind", "color", "ior"}, "[[material]]")
        kind = material.get("kind", "diffuse")
        if kind == "glass" or material["name"] == glass:
            ior = material.get("ior", 1.5)
            materials[material["name"]] = {"type": "dielectric", "int_ior": ior, "ext_ior": 1.0}
        elif kind == "diffuse":
            materials[material["name"]] = diffuse(material["color"])
        else:
            raise SystemExit(f"material {material['name']}: the kind {kind} is not translated")
    scene: Scene = {"type": "scene"}
    for number, (name, material) in enumerate(materials.items()):
        scene[f"material{number}"] = material
        materials[name] = {"type": "ref", "id": f"material{number}"}
    lights(document, scene)
    prototypes = {prototype["name"]: prototype for prototype in document.get("prototype", [])}
    for name, prototype in prototypes.items():
        group = {"type": "shapegroup"}
        solids(prototype, folder, materials, group)
        if len(group) > 1:
            scene[f"group {name}"] = group
    solids(document, folder, materials, scene)
    everything = all_placements(document, prototypes, folder, np.identity(4))
    for number, (name, matrix) in enumerate(everything):
        scene[f"instance{number}"] = {
            "type": "instance",
            "group": {"type": "ref", "id": f"group {name}"},
            "to_world": mi.ScalarTransform4f(matrix),
        }
    return scene


BODY = {"cylinder", "cylinder_table", "instance", "instance_table"}


def diffuse(color: list[float]) -> Scene:
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": color}}


def lights(document: Scene, scene: Scene) -> None:
    if "sun" in document:
        sun = document["sun"]
        check(sun, {"direction", "color", "strength", "angle_degrees"}, "[sun]")
        irradiance = np.array(sun["color"]) * sun["strength"]
        scene["sun"] = {
            "type": "directional",
            "direction": [-x for x in sun["direction"]],
            "irradiance": {"type": "rgb", "value": irradiance.tolist()},
        }
    sky = document["sky"]
    check(sky, {"color", "strength"}, "[sky]")
    radiance = np.array(sky["color"]) * sky["strength"]
    scene["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": radiance.tolist()}}


def solids(body: Scene, folder: Path, materials: Scene, into: Scene) -> None:
    for table in body.get("cylinder_table", []):
        columns = table["columns"]
        check(columns, {"p0", "p1", "axis", "length", "radius"}, "columns")
        with (folder / table["file"]).open() as file:
            for row in csv.DictReader(file):
                p0 = numbers(row, columns["p0"])
                if "p1" in columns:
                    p1 = numbers(row, columns["p1"])
                else:
                    axis = numbers(row, columns["axis"])
                    p1 = p0 + axis / np.linalg.norm(axis) * float(row[columns["length"]])
                radius = float(row[columns["radius"]])
                add(into, p0, p1, radius, materials[table.get("material", "")])
    for solid in body.get("cylinder", []):
        check(solid, {"p0", "p1", "radius", "material"}, "[[cylinder]]")
        p0, p1 = np.array(solid["p0"], float), np.array(solid["p1"], float)
        add(into, p0, p1, solid["radius"], materials[solid.get("material", "")])


def add(into: Scene, p0: np.ndarray, p1: np.ndarray, radius: float, material: Scene) -> None:
    """A cylinder and its ends, whose normals point outward."""
    name = f"solid{len(into)}"
    into[name] = {"type": "cylinder", "p0": p0, "p1": p1, "radius": radius, "bsdf": material}
    axis = (p1 - p0) / np.linalg.norm(p1 - p0)
    for end, (point, normal) in enumerate([(p0, -axis), (p1, axis)]):
        into[f"{name} end {end}"] = {
            "type": "disk",
            "to_world": mi.ScalarTransform4f(frame(point, normal, radius)),
            "bsdf": material,
        }


def frame(point: np.ndarray, normal: np.ndarray, scale: float) -> np.ndarray:
    """Maps the unit disk about z to one about a normal."""
    other = np.array([1.0, 0, 0]) if abs(normal[0]) < 0.6 else np.array([0, 1.0, 0])
    x = np.cross(other, normal)
    x /= np.linalg.norm(x)
    matrix = np.identity(4)
    matrix[:3, 0] = x * scale
    matrix[:3, 1] = np.cross(normal, x) * scale
    matrix[:3, 2] = normal * scale
    matrix[:3, 3] = point
    return matrix


def all_placements(
    body: Scene, prototypes: Scene, folder: Path, world: np.ndarray
) -> Iterator[tuple[str, np.ndarray]]:
    """The placements of prototypes with solids in the world, at all levels."""
    for name, matrix in placements(body, folder):
        prototype = prototypes[name]
        if {"cylinder", "cylinder_table"} & prototype.keys():
            yield name, world @ matrix
        yield from all_placements(prototype, prototypes, folder, world @ matrix)


def placements(document: Scene, folder: Path) -> list[tuple[str, np.ndarray]]:
    placed = []
    for instance in document.get("instance", []):
        check(instance, {"of", "translate", "rotate_z", "scale"}, "[[instance]]")
        turned = rotation(np.array([0, 0, 1.0]), instance.get("rotate_z", 0))
        translation = np.array(instance.get("translate", [0, 0, 0]), float)
        placed.append((instance["of"], affine(turned * instance.get("scale", 1), translation)))
    for table in document.get("instance_table", []):
        columns = table["columns"]
        check(columns, {"position", "axis", "degrees", "scale"}, "columns")
        with (folder / table["file"]).open() as file:
            for row in csv.DictReader(file):
                axis = numbers(row, columns["axis"]) if "axis" in columns else np.array([0, 0, 1.0])
                degrees = float(row[columns["degrees"]]) if "degrees" in columns else 0.0
                scale = float(row[columns["scale"]]) if "scale" in columns else 1.0
                matrix = rotation(axis, degrees) * scale
                placed.append((table["of"], affine(matrix, numbers(row, columns["position"]))))
    return placed


def affine(linear: np.ndarray, translation: np.ndarray) -> np.ndarray:
    matrix = np.identity(4)
    matrix[:3, :3], matrix[:3, 3] = linear, translation
    return matrix


def rotation(axis: np.ndarray, degrees: float) -> np.ndarray:
    """Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.identity(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def numbers(row: dict[str, str], columns: list[str]) -> np.ndarray:
    return np.array([float(row[column]) for column in columns])


def check(table: Scene, known: set[str], what: str) -> None:
    unknown = table.keys() - known
    if unknown:
        raise SystemExit(f"{what}: {', '.join(sorted(unknown))} cannot be translated")


if __name__ == "__main__":
    main()
