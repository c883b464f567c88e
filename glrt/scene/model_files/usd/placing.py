"""Where the parts of a USD file stand: nodes of a glTF file, instances among them."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom, UsdLux

from glrt.scene.model_files.conversion.reports import LeftOut, UnshownError
from glrt.scene.model_files.gltf_file import GltfFile, Table
from glrt.scene.model_files.usd.cameras import camera_table, lens_table
from glrt.scene.model_files.usd.lamps import Lamps
from glrt.scene.model_files.usd.motion import Motion
from glrt.scene.model_files.usd.polygons_of_prims import polygons_of
from glrt.scene.model_files.usd.primitives import Primitives, bound_material

Matrix = NDArray[np.float64]

_DAMAGE = (TypeError, LookupError, ArithmeticError, RuntimeError)  # of values that do not fit
_MOST_NODES = 500_000
_MOST_NESTED = 8  # point instancers
# Without a picture of their own. Materials are read where something has them.
_UNSEEN = {
    *("", "Xform", "Scope", "Material", "Shader", "NodeGraph", "GeomSubset", "SkelRoot"),
    *("LightFilter", "RenderSettings", "RenderProduct", "RenderVar", "PhysicsScene"),
    *("Preliminary_ReferenceImage", "Backdrop"),
}
_BELOW = Usd.TraverseInstanceProxies(
    Usd.PrimIsActive & Usd.PrimIsLoaded & ~Usd.PrimIsAbstract
)  # prototypes may stand below an `over`


class Placing:
    """Walks through a file, and adds what it shows to a glTF file."""

    def __init__(
        self,
        glb: GltfFile,
        primitives: Primitives,
        lamps: Lamps,
        motion: Motion,
        left: LeftOut,
        time: Usd.TimeCode,
    ) -> None:
        self._glb, self._primitives, self._lamps = glb, primitives, lamps
        self._motion, self._left, self._time = motion, left, time
        self._places = UsdGeom.XformCache(time)
        self._meshes: dict[object, int | None] = {}
        self.nodes: list[Table] = []
        self.lenses: dict[str, Table] = {}  # by number of the node

    def place(self, stage: Usd.Stage, frame: Matrix, unit: float) -> None:
        """Add all that a file shows; `frame` leads to the scene, of `unit` in one of the file."""
        root = stage.GetPseudoRoot()
        for prim, matrix in self._shown(root, Usd.TraverseInstanceProxies(), None):
            try:
                self._place(prim, frame @ matrix, unit)
            except _DAMAGE:
                self._left.name("damaged parts", str(prim.GetPath()))

    def _place(self, prim: Usd.Prim, placed: Matrix, unit: float) -> None:
        if prim.IsA(UsdGeom.PointInstancer):
            self._instances(UsdGeom.PointInstancer(prim), placed, 1)
        elif prim.IsA(UsdGeom.Camera):
            self._camera(prim, placed, unit)
        elif prim.HasAPI(UsdLux.LightAPI):
            self._lamps.add(prim, placed, 1 / unit)
            if self._motion.keys(prim) is not None:
                self._left.add("motion of lights")
            self._mesh(prim, placed)
        else:
            self._mesh(prim, placed, self._motion.keys(prim))

    def _shown(
        self, root: Usd.Prim, kinds: Any, above: Usd.Prim | None
    ) -> Iterator[tuple[Usd.Prim, Matrix]]:
        """Yield what is seen at and below a prim, with its matrix to `above`, or the world."""
        walk = iter(Usd.PrimRange(root, kinds))
        for prim in walk:
            if prim.IsPseudoRoot():
                continue
            self._left.add_broken(len(prim.GetPrimIndex().localErrors))
            if prim.IsA(UsdGeom.PointInstancer):
                walk.PruneChildren()
            seen = UsdGeom.Imageable(prim)
            if seen:
                if seen.GetVisibilityAttr().Get(self._time) == "invisible":
                    walk.PruneChildren()
                    continue
                if seen.ComputePurpose() in ("guide", "proxy"):
                    continue
            if above is None:
                matrix = self._places.GetLocalToWorldTransform(prim)
            else:
                matrix = self._places.ComputeRelativeTransform(prim, above)[0]
            yield prim, np.array(matrix, np.float64).T

    def _node(
        self, prim: Usd.Prim, matrix: Matrix, keys: Matrix | None = None, **more: Any
    ) -> None:
        if len(self.nodes) >= _MOST_NODES:
            raise UnshownError(f"shows more than {_MOST_NODES:,} things")
        table: Table = {"name": prim.GetName(), **more}
        if not np.isfinite(matrix).all():
            self._left.add("things placed beyond all numbers")
            return
        if keys is not None:
            self._motion.start(table, len(self.nodes), keys)
        elif not np.array_equal(matrix, np.eye(4)):
            table["matrix"] = matrix.T.ravel().tolist()
        self.nodes.append(table)

    def _camera(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        table = camera_table(prim, self._time, self._left)
        if table is None:
            return
        count, lens = len(self.nodes), lens_table(prim, self._time, unit)
        self._node(prim, matrix, self._motion.keys(prim), camera=self._glb.add("cameras", table))
        if len(self.nodes) > count:
            self.lenses[str(count)] = lens

    def _mesh(self, prim: Usd.Prim, matrix: Matrix, keys: Matrix | None = None) -> None:
        number = self._number(prim)
        if number is not None:
            self._node(prim, matrix, keys, mesh=number)

    def _number(self, prim: Usd.Prim) -> int | None:
        """Return the number of a prim's mesh, which instances share; None if it has none."""
        polygons = None
        own = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        key: Any = own.GetPath()
        if prim.IsInstanceProxy():  # material and color may come from outside of the prototype
            material = bound_material(prim)
            key = key, material.GetPath() if material else prim.GetPath()
        if key not in self._meshes:
            polygons = polygons_of(prim, self._time, self._left)
            if polygons is None:
                self._name(prim)
                self._meshes[key] = None
                return None
            groups = self._primitives.groups(prim, polygons)
            self._meshes[key] = self._primitives.added(prim, polygons, groups)
        return self._meshes[key]

    def _name(self, prim: Usd.Prim) -> None:
        """Report a prim of a kind that is not shown."""
        kind = prim.GetTypeName()
        if kind in ("Skeleton", "SkelAnimation", "BlendShape"):
            self._left.add("skeletons and blend shapes, whose meshes stand in their pose at rest")
        elif not (kind in _UNSEEN or prim.IsA(UsdGeom.Mesh) or prim.HasAPI(UsdLux.LightAPI)):
            self._left.add(kind)

    def _instances(self, instancer: UsdGeom.PointInstancer, matrix: Matrix, depth: int) -> None:
        """Add the instances of prototypes at points."""
        if depth > _MOST_NESTED:
            self._left.add("instancers deep in each other")
            return
        stage, kinds = instancer.GetPrim().GetStage(), instancer.GetProtoIndicesAttr()
        numbers = np.array(kinds.Get(self._time) or [], np.int64)
        prototypes = [
            stage.GetPrimAtPath(path) for path in instancer.GetPrototypesRel().GetForwardedTargets()
        ]
        mask = instancer.ComputeMaskAtTime(self._time)
        if len(mask):
            numbers = numbers[np.array(mask, bool)]
        moved = instancer.ComputeInstanceTransformsAtTime(self._time, self._time)
        if len(moved) != len(numbers):
            self._left.add("instancers whose arrays do not fit")
            return
        parts = [self._parts(it) if it else [] for it in prototypes]
        for number, place in zip(numbers, moved, strict=True):
            if not 0 <= number < len(parts):
                self._left.add("instances without a prototype")
                continue
            at = matrix @ np.array(place, np.float64).T
            for prim, inner in parts[number]:
                if prim.IsA(UsdGeom.PointInstancer):
                    self._instances(UsdGeom.PointInstancer(prim), at @ inner, depth + 1)
                elif prim.IsA(UsdGeom.Camera) or prim.HasAPI(UsdLux.LightAPI):
                    self._left.add("cameras and lights of instances")
                else:
                    self._mesh(prim, at @ inner)

    def _parts(self, prototype: Usd.Prim) -> list[tuple[Usd.Prim, Matrix]]:
        """Return what a prototype shows, with matrices to it."""
        return list(self._shown(prototype, _BELOW, prototype))
