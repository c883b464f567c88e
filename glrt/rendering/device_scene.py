"""A scene in the driver's memory: its arrays, and the source of the kernels that read them."""

import time
from collections.abc import Iterator, Mapping
from typing import Any, Protocol

import moderngl
import numpy as np

from glrt.core.errors import RenderError, SceneError
from glrt.core.same_rows import same_rows
from glrt.gpu.context import Context
from glrt.gpu.glsl import Source
from glrt.gpu.program import Images, Resource
from glrt.gpu.programs import AnyKernel
from glrt.gpu.shared_resources import Shared
from glrt.gpu.struct_arrays import FILE, Arrays, block_of, write_rows
from glrt.packing.drawn_triangles import drawn_triangles
from glrt.packing.image_texture import ImageTexture
from glrt.packing.kernel_structs import STRUCTS
from glrt.packing.particles import with_particles
from glrt.packing.ready_tree import ready_or_new
from glrt.packing.scene_arrays import Dispatch, pack_frame, pack_scene
from glrt.packing.scene_tree import SceneTree
from glrt.packing.shapes import NUMBERED
from glrt.packing.sky_table import SkyTable
from glrt.packing.texel_texture import TexelTexture
from glrt.packing.texture_maps import images_of, textures_of
from glrt.packing.voxel_texture import VoxelTexture, grids_of
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import Plan
from glrt.rendering.passes import LISTED, RADIANCE, RenderPass, Resolved
from glrt.rendering.pipelines import (
    ENVIRONMENT,
    SKY_TREE,
    TEXELS,
    TIERS,
    VOXELS,
    Fast,
    KernelOptions,
    Tier,
    places,
    scene_text,
    sources,
    tier_for,
    upload,
)
from glrt.rendering.plan_shaders import constants_of
from glrt.rendering.schedule import DispatchRange, stride_of

SLOTS = block_of("Slot")
STILL = ("Slot", "Corner", "Triangle")  # may be large; a moved camera leaves them unchanged


class Exposed(Protocol):
    """A film or another target that a kernel adds samples to."""

    samples: int  # per pixel so far

    @property
    def next_sample(self) -> int:
        """The number of the sample that comes next."""

    def images(self) -> Images:
        """The textures by the names of the kernel's image uniforms."""


class DeviceScene:
    """A scene in driver memory, with the constants and the generated text of its kernels."""

    def __init__(
        self,
        context: Context,
        plan: Plan,
        options: KernelOptions,
        before: "DeviceScene | None" = None,
    ) -> None:
        """Upload the scene of a plan.

        The tier is "generic" if the scene has too many shapes to bake. Data equal to that of
        `before` is shared. The files of the scene were read. Raises RenderError if the driver has
        no room, and SceneError if an image exceeds the driver's limit.
        """
        self._gl, self._options, self._scene = context.gl, options, plan.scene
        start = time.perf_counter()
        self._tree = _tree(plan.facts, before)
        built = time.perf_counter()
        self._arrays = with_particles(_packed(plan.facts, self._tree, before), plan)
        self._counts = {name: len(rows) for name, rows in self._arrays.items()}
        self.grid = plan.grid
        self._constants = constants_of(plan, self._tree, options.variant)
        # Rounds of loops through trees, passed surfaces and grids are a guess: samples may be lost.
        facts = plan.facts
        self._may_lose = bool(
            facts.has_trees or facts.lobes.passed or facts.media.grids or facts.media.is_ranked
        )
        self.tier = tier_for(self._arrays, options.tier)
        self._texts = self._texts_of(self.tier)
        self._resources: dict[str, Resource] = {}
        self._kept: dict[str, Shared] = {}  # arrays that the scenes before and after an edit share
        self._textures: dict[str, Shared] = {}  # of images and grids, by sampler
        try:
            with context.checked("the scene"):
                self._upload(before)
                for name, texture in _textures(context, plan, before._textures if before else {}):
                    self._textures[name] = texture
        except (RenderError, SceneError):
            self.release()
            raise
        self.seconds = {"build": built - start, "pack": time.perf_counter() - built}

    @property
    def pipeline(self) -> Resolved:
        """The pipeline of its kernels."""
        return self._options.pipeline

    @property
    def keeps_reservoirs(self) -> bool:
        """Whether samples reuse light points that earlier samples kept in reservoirs."""
        return bool(self._constants["REUSES_OWN"] or self._constants["REUSES_NEAR"])

    @property
    def tree(self) -> SceneTree | None:
        """The BVH of the scene."""
        return self._tree

    @property
    def shaders(self) -> list[Source]:
        """The shader sources of the scene's kernel."""
        return self._shaders(self._texts)

    def faster(self, tier: Fast) -> list[Source] | None:
        """The shader sources of a faster kernel.

        None if the scene's kernel is as fast, or if the scene has too many shapes to bake.
        """
        is_slower = TIERS.index(self.tier) < TIERS.index(tier_for(self._arrays, tier))
        return self._shaders(self._texts_of(tier)) if is_slower else None

    def shaders_of(self, render_pass: RenderPass) -> list[Source]:
        """The shader sources of another pass over the scene."""
        return sources(self._options.pipeline, self._constants, self._texts, render_pass)

    @property
    def drawn_triangles(self) -> np.ndarray[Any, Any]:
        """Where each triangle lies, in the order of drawing: see packing/drawn_triangles.py."""
        slots = self._arrays["Slot"]
        return drawn_triangles(slots, self._tree.own.bases.slots if self._tree else len(slots))

    @property
    def proxies(self) -> int:
        """Number of shapes; meshes among them have no proxy."""
        return sum(self._counts[struct] for struct in NUMBERED)

    def raster_sources(self) -> list[Source]:
        """The shader sources that draw its first surfaces."""
        names, version = ("raster.vert", "raster.frag"), "410 core"
        return [Source(name, self._constants, version, self._texts) for name in names]

    def has_kernel_of(self, other: "DeviceScene") -> bool:
        """Whether both scenes can use the same kernel: equal constants and equal texts."""
        return (self._constants, self._texts) == (other._constants, other._texts)

    def dispatch(
        self,
        kernel: AnyKernel,
        film: Exposed,
        plan: Plan,
        part: DispatchRange,
        tiles: int,
        own: Mapping[str, Resource] = {},
    ) -> None:
        """Run a kernel that adds the samples of `part` to a film; the picture has `tiles` tiles.

        `own` are resources of the kernel in addition to those of the scene.
        """
        now = Dispatch(
            film.next_sample, part.samples, part.first, stride_of(tiles), not film.samples
        )
        table = self._textures.get(SKY_TREE)
        density = table.density if isinstance(table, SkyTable) else 0.0
        self._frame.write(pack_frame(plan, self._counts, now, self._tree, density))
        self._write_tree()
        images = {name: texture.resource for name, texture in self._textures.items()}
        kernel.bind({**self._resources, **own, **images}, film.images())
        kernel.run_tiles(part.tiles)

    def lost_any(self) -> bool:
        """Whether kernels lost samples to the driver's loop limit since the last call."""
        if not self._may_lose or not any(self._lost.read()):
            return False
        self._lost.clear()
        return True

    def release(self) -> None:
        """Release all OpenGL resources that are not shared."""
        own = {name: some for name, some in self._resources.items() if name not in self._kept}
        for resource in (*own.values(), *self._kept.values(), *self._textures.values()):
            resource.release()

    def _upload(self, before: "DeviceScene | None") -> None:
        self._frame = self._resources["FrameBlock"] = self._gl.buffer(
            reserve=STRUCTS["Frame"].itemsize
        )
        self._lost = self._resources["Lost"] = self._gl.buffer(bytes(4))
        known = before._kept_for(self._arrays, self._tree) if before else {}
        rest = {name: rows for name, rows in self._arrays.items() if block_of(name) not in known}
        self._resources |= upload(self._gl, rest, self.tier) | places(self._gl, self._arrays)
        fresh = {block_of(name) for name in STILL} & self._resources.keys()
        self._kept = known | {name: Shared(self._resources[name]) for name in fresh}
        self._resources |= {name: some.resource for name, some in self._kept.items()}
        if SLOTS in fresh:
            self._kept[SLOTS].content = self._arrays["Slot"]

    def _kept_for(self, arrays: Arrays, tree: SceneTree | None) -> dict[str, Shared]:
        """Shared resources with equal arrays, by block; slots may differ in the scene's tree."""
        same = {
            name for name in STILL if name != "Slot" and same_rows(arrays[name], self._arrays[name])
        }
        if self._has_own_trees_of(tree, len(arrays["Slot"])):
            same.add("Slot")
        elif same_rows(arrays["Slot"], self._arrays["Slot"]):
            same.add("Slot")
            if SLOTS in self._kept:
                self._kept[SLOTS].content = arrays["Slot"]
        kept = {block_of(name) for name in same} & self._kept.keys()
        return {name: self._kept[name].shared() for name in kept}

    def _has_own_trees_of(self, tree: SceneTree | None, slots: int) -> bool:
        """Whether the slots of another scene differ from these only in the tree of the scene."""
        return (
            tree is not None
            and self._tree is not None
            and tree.own is self._tree.own
            and len(tree.own.slots) > 0
            and slots == self._counts["Slot"]
            and isinstance(self._resources.get(SLOTS), moderngl.Texture)
        )

    def _write_tree(self) -> None:
        """Write the tree of this scene into the shared slots, before the trees of meshes."""
        slots, kept = self._arrays["Slot"], self._kept.get(SLOTS)
        if kept and self._tree and kept.content is not slots:
            assert isinstance(kept.resource, moderngl.Texture)
            write_rows(kept.resource, slots, self._tree.own.bases.slots)
            kept.content = slots

    def _texts_of(self, tier: Tier) -> dict[str, str]:
        """The generated shader file, and the files that the variant replaces, by name."""
        text = scene_text(self._gl, self._arrays, tier)
        return {FILE: text, **self._options.variant.texts}

    def _shaders(self, texts: Mapping[str, str]) -> list[Source]:
        own = LISTED if self._constants["ADAPTIVE"] else RADIANCE
        return sources(self._options.pipeline, self._constants, texts, own)


def _textures(
    context: Context, plan: Plan, known: Mapping[str, Shared]
) -> Iterator[tuple[str, Shared]]:
    """Yield samplers and textures of a scene; equal ones among `known` are shared."""
    if picture := plan.scene.sky:
        image = known.get(ENVIRONMENT)
        is_known = isinstance(image, ImageTexture) and image.shows(picture)
        yield ENVIRONMENT, image.shared() if image and is_known else ImageTexture(context, picture)
    if images := images_of(textures_of(plan.facts)):
        texels = known.get(TEXELS)
        is_known = isinstance(texels, TexelTexture) and texels.holds(images)
        yield TEXELS, texels.shared() if texels and is_known else TexelTexture(context, images)
    if grids := grids_of(plan.facts):
        voxels = known.get(VOXELS)
        is_known = isinstance(voxels, VoxelTexture) and voxels.holds(grids)
        yield VOXELS, voxels.shared() if voxels and is_known else VoxelTexture(context, grids)
    if picture and plan.needs.sample_sky:
        table = known.get(SKY_TREE)
        is_known = isinstance(table, SkyTable) and table.samples(picture)
        yield SKY_TREE, table.shared() if table and is_known else SkyTable(context.gl, picture)


def _tree(facts: SceneFacts, before: DeviceScene | None) -> SceneTree | None:
    """The tree of a scene: that of `before` if the objects are equal, else a new one."""
    if before and before._scene.objects == facts.scene.objects:
        return before._tree
    return ready_or_new(facts, before._tree if before else None)


def _packed(facts: SceneFacts, tree: SceneTree | None, before: DeviceScene | None) -> Arrays:
    """The arrays of a scene; equal scenes share all, equal objects share nodes of spheres."""
    if before and before._scene == facts.scene:
        return before._arrays
    is_same = before and before._scene.objects == facts.scene.objects
    return pack_scene(facts, tree, before._arrays["Node"] if before and is_same else None)
