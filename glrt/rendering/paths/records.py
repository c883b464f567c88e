"""Convert records of a replay to values, with the object numbers and names of the scene."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from glrt.gpu.glsl import read
from glrt.gpu.structs import read_structs
from glrt.packing.media import medium_row
from glrt.packing.shapes import order_of_kernel
from glrt.plan.facts import SceneFacts
from glrt.rendering.paths.values import (
    ENDS,
    NUMBERS,
    Contribution,
    Event,
    Path,
    PathVertex,
    Source,
    Strategy,
    Triple,
)
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene

Array = np.ndarray[Any, Any]

RECORDS = read_structs(read("structs/path_records.glsl"))
CAMERA = "camera"
_PASSING: dict[int, Event] = {
    NUMBERS["EVENT_ENDED"]: "ends",
    NUMBERS["EVENT_SENT"]: "camera",
    NUMBERS["EVENT_PASSED_HOLE"]: "passes a hole",
    NUMBERS["EVENT_PASSED_GLASS"]: "passes inside glass",
}
_GOING_STRAIGHT = ("passes a hole", "passes inside glass")
_SKIES: dict[int, Source] = {
    NUMBERS["FROM_BACKGROUND"]: "background",
    NUMBERS["FROM_SUN"]: "sun",
}


def paths_of(
    scene: Scene, first: int, samples: Array, vertices: Array, lights: Array
) -> tuple[Path, ...]:
    """Paths of the samples from number `first` on, from their records in any order."""
    reader = _Reader(scene)
    vertices = vertices[np.lexsort((vertices["vertex"], vertices["sample_index"]))]
    lights = lights[np.lexsort((lights["number"], lights["sample_index"]))]
    numbers = range(first, first + len(samples))
    by_vertex = _divided(vertices, numbers)
    by_light = _divided(lights, numbers)
    parts = zip(numbers, samples, by_vertex, by_light, strict=True)
    return tuple(reader.path(*part) for part in parts)


def particle_of(scene: Scene, sample: int, number: int, vertices: Array, lights: Array) -> Path:
    """The path of one particle up to its last link to the camera, from its records in any order."""
    vertices = vertices[np.argsort(vertices["vertex"])]
    lights = lights[np.argsort(lights["number"])]
    end = int(lights["vertex"][-1]) + 1
    result = np.zeros((), RECORDS["SampleRecord"])
    for light in lights:
        result["radiance"] += light["added"]
    result["end"] = NUMBERS["END_LINKED"]
    path = _Reader(scene).path(sample, result, vertices[:end], lights)
    return path.model_copy(update={"particle": number})


def object_name(scene: Scene, number: int) -> str:
    """The name of an object, or its place in the scene file, such as `objects[2] (sphere)`."""
    thing = scene.objects[number]
    return thing.name or f"objects[{number}] ({thing.shape})"


def _divided(records: Array, numbers: Sequence[int]) -> list[Array]:
    """Sorted records, split by the number of their sample."""
    ends = np.searchsorted(records["sample_index"], [*numbers, numbers[-1] + 1])
    return [records[start:end] for start, end in pairwise(ends)]


class _Reader:
    """Converts the records of paths through one scene."""

    def __init__(self, scene: Scene) -> None:
        self._scene, self._order = scene, order_of_kernel(scene)
        self._eye = np.array(scene.camera.position, np.float64)
        facts = SceneFacts(scene)
        self._media = {medium_row(facts, it): it.medium for it in facts.media.rows}

    def path(self, number: int, sample: Any, vertices: Array, lights: Array) -> Path:
        """The path of one sample."""
        found: list[PathVertex] = []
        for record in vertices:
            found.append(self._vertex(record, found[-1].direction if found else None))
        return Path(
            sample=number,
            radiance=_triple(sample["radiance"]),
            end=ENDS[int(sample["end"])],
            vertices=tuple(found),
            contributions=tuple(self._light(record, found) for record in lights),
        )

    def _vertex(self, record: Any, arriving: Triple | None) -> PathVertex:
        number = self._object(int(record["object"]))
        event = self._event(int(record["event"]), number, float(record["pdf"]))
        direction = _triple(record["direction"])
        shading = record["shading_normal"]
        if np.dot(shading, record["normal"]) < 0:  # shown on the side that the path came from
            shading = -shading
        return PathVertex(
            event=event,
            position=_triple(self._eye + record["position"]),
            normal=_triple(record["normal"]),
            shading_normal=_triple(shading),
            object=number,
            name=self._name(int(record["object"]), CAMERA),
            material=None if number is None else self._scene.objects[number].material,
            distance=float(record["way"]),
            throughput=_triple(record["throughput"]),
            direction=arriving
            if event in _GOING_STRAIGHT
            else direction
            if any(direction)
            else None,
            pdf=float(record["pdf"]),
            survival=float(record["survival"]),
        )

    def _event(self, event: int, number: int | None, pdf: float) -> Event:
        if event == NUMBERS["EVENT_SENT"] and number is not None:
            return "lamp"
        if event in _PASSING:
            return _PASSING[event]
        if number is None:
            return "scattering in a medium"
        if event == NUMBERS["EVENT_CROSSED"]:
            return "rough transmission" if pdf else "specular transmission"
        if not pdf:
            return "specular reflection"
        material = self._scene.materials[self._scene.objects[number].material]
        if isinstance(material, Principled):
            return "reflection"
        return "matte" if isinstance(material, Lambertian | Light) else "rough reflection"

    def _light(self, record: Any, vertices: Sequence[PathVertex]) -> Contribution:
        kernel, at = int(record["object"]), int(record["vertex"])
        source = "medium" if kernel <= NUMBERS["FROM_MEDIUM"] else _SKIES.get(kernel, "object")
        number = self._object(kernel)
        return Contribution(
            vertex=at,
            strategy=_strategy(int(record["strategy"]), vertices[: at + 1], source),
            source=source,
            object=number,
            name=self._name(kernel, source),
            radiance=_triple(record["radiance"]),
            direction=_triple(record["direction"]) if record["distance"] else None,
            distance=float(record["distance"]) or None if source == "object" else None,
            pdf=float(record["pdf"]),
            other_pdf=float(record["other_pdf"]),
            weight=float(record["weight"]),
            added=_triple(record["added"]),
            hidden=bool(record["is_hidden"]),
        )

    def _name(self, kernel: int, other: str) -> str:
        """The name of an object or a medium by the kernel's number, `other` for neither."""
        if kernel <= NUMBERS["FROM_MEDIUM"]:
            return self._media[NUMBERS["FROM_MEDIUM"] - kernel]
        return object_name(self._scene, self._order[kernel]) if kernel >= 0 else other

    def _object(self, kernel: int) -> int | None:
        return self._order[kernel] if kernel >= 0 else None


def _strategy(number: int, vertices: Sequence[PathVertex], source: Source) -> Strategy:
    """How a light was found; `vertices` end at it, and an object that shines is the last one."""
    if number == NUMBERS["BY_PARTICLE"]:
        return "particle"
    if number == NUMBERS["BY_SAMPLING"]:
        return "light sampling"
    before = vertices[:-1] if source == "object" else vertices
    straight = all(vertex.event in (CAMERA, *_GOING_STRAIGHT) for vertex in before)
    return "camera" if straight else "scattering"


def _triple(values: Any) -> Triple:
    x, y, z = (float(value) for value in values)
    return (x, y, z)
