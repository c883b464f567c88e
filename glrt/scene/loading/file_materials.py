"""Read the materials of OBJ, glTF and USD files, with their images.

Properties that scenes do not have are left out, and the file of the mesh lists them.
"""

from glrt.core.errors import SceneError, of_content
from glrt.core.text import counted, quoted
from glrt.scene.files.assets import AssetReader, folder_of
from glrt.scene.files.named_images import TextureImage
from glrt.scene.files.named_meshes import MeshFile
from glrt.scene.loading.companions import Beside
from glrt.scene.loading.file_contents import with_content
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.principled import Principled
from glrt.scene.meshes.triangle_meshes import NO_MATERIAL
from glrt.scene.model_files.conversion.document import ConvertedDocument
from glrt.scene.model_files.gltf.materials import (
    Look,
    dye_unlit,
    looks_of,
    make_pane,
    without_image,
)
from glrt.scene.model_files.mtl import Entry, decode_mtl, material_of
from glrt.scene.model_files.obj import libraries
from glrt.scene.schema.validation import validated
from glrt.scene.shapes.mesh import Mesh

REMEDY = "give the object a `material`"
Found = tuple[MeshFile, dict[str, Material]]  # a file that lists what was left out, and materials


def of_mtl(shape: Mesh, reader: AssetReader, where: str, rest: Material | None) -> Found:
    """Read the materials of an OBJ file from its MTL files; the first of a name counts.

    `rest` is the material of triangles that have none there. Without `rest`, `SceneError` is raised
    for an MTL file that cannot be read, and the result may lack materials that the file uses.
    """
    asset = reader.read(shape.file.file, where)
    paths = libraries(asset.content)
    if not paths and rest is None:
        raise SceneError(
            f"{where}: {shape.file.file} names no MTL file by mtllib: {REMEDY}, or export it "
            "with its materials."
        )
    images = _Images(reader, shape, where)
    entries, folders, hashes, unread = dict[str, Entry](), dict[str, str](), dict[str, str](), []
    for path in paths:
        try:
            spelled = reader.spelled(path, folder_of(asset.path))
            library = reader.read(spelled, f"{where}: {asset.path}")
        except SceneError:
            if rest is None:
                raise
            unread.append(f"{quoted(path)}, which cannot be read")
            continue
        own = decode_mtl(library.content, f"{where}: {library.path}")
        entries = own | entries
        folders = dict.fromkeys(own, folder_of(library.path)) | folders
        hashes[library.path] = library.sha256
    found = dict[str, Material]()
    for name, part in shape.triangles_of_file.parts.items():
        if name in entries:
            material, keys = _of_entry(entries[name], folders[name], images)
            if rest is not None and isinstance(material, Dielectric) and part.opening:
                material = Dielectric(ior=material.ior, thin=True)
                keys.append("the volume of glass that is not closed")
            found[name] = material
            unread += keys
        elif rest is not None:
            found[name] = rest
            count = counted(len(part.faces), "triangle")
            unread.append(
                f"the material of {count} (no usemtl)"
                if name == NO_MATERIAL
                else f"the material {quoted(name)}, which is missing"
            )
    names = {name: found.get(name) or material_of(entry)[0] for name, entry in entries.items()}
    return shape.file.with_libraries(hashes, tuple(unread)), {**names, **found}


def _of_entry(entry: Entry, folder: str, images: "_Images") -> tuple[Material, list[str]]:
    if entry.image:
        entry.image = images.reader.spelled(entry.image, folder)
    material, keys = material_of(entry)
    if images.lost(material):
        reason = f" {quoted(entry.image)}, which cannot be read" if images.may_lie else ""
        entry.image = ""
        material, keys = material_of(entry)
        keys.append(f"map_Kd{reason}")
    return images.with_pixels(material), keys


def of_gltf(shape: Mesh, reader: AssetReader, where: str) -> Found:
    """Return the materials that the triangles of a file have; open glass becomes a thin pane."""
    asset = reader.read(shape.file.file, where)
    images = _Images(reader, shape, where)
    own, unread = dict[str, Material](), list[str]()
    try:
        document = Beside(asset, reader, where).document()
        if isinstance(document, ConvertedDocument):
            looks = document.looks(asset.path)
            unread += document.left_out
        else:
            looks = looks_of(document, asset.path)
        for name, part in shape.triangles_of_file.parts.items():
            look = looks[name]
            if look.table.get("transmission") and not look.table["thin"] and part.opening:
                look.unread.append("the volume of glass that is not closed")
                make_pane(look)
            if look.hides_backs and part.is_turned:
                look.unread.append(f"the backs of {quoted(name)}, a hull (black inside)")
            if look.hides_backs and not shape.hides_backs and part.opening:
                look.unread.append(f"the hidden backs of {quoted(name)} (backfaces = hidden)")
            if look.is_unlit and part.colors is not None:
                dye_unlit(look, part.colors)
            here = f"{where}: {shape.file.file}: material {quoted(name)}"
            own[name] = images.with_pixels(_of_look(look, images, here))
            unread += look.unread
    except ValueError as error:
        raise SceneError(f"{where}: {shape.file.file}: {of_content(error)}.") from None
    unread += document.unknown_extensions
    if document.items("animations") and shape.time is None:
        unread.append("animations, which glrt film shows")
    if shape.variant is None:
        names = shape.triangles_of_file.variants
        unread += [f"variant {quoted(name)} (--variant)" for name in names]
    return shape.file.with_libraries({}, tuple(unread)), own


def _of_look(look: Look, images: "_Images", here: str) -> Material:
    material = validated(Principled, look.table, here)
    while lost := images.lost(material):
        for key in lost:
            without_image(look, key)
        material = validated(Principled, look.table, here)
    return material


class _Images:
    """The images of the materials of a mesh, each read once."""

    def __init__(self, reader: AssetReader, shape: Mesh, where: str) -> None:
        self.reader = reader
        self.may_lie = shape.triangles_of_file.uv is not None
        self._where = where
        self._read: dict[TextureImage, TextureImage | None] = {}

    def lost(self, material: Material) -> list[str]:
        """Return the keys whose images cannot be read, or have no texture coordinates to lie by."""
        textures = material.textures if isinstance(material, Opaque) else {}
        images = {key: texture.image for key, texture in textures.items() if texture.image}
        return [key for key, image in images.items() if not self._is_had(image)]

    def with_pixels(self, material: Material) -> Material:
        """Return the material with its images as they were read."""
        had = {image: found for image, found in self._read.items() if found}
        return material.with_images(had) if isinstance(material, Opaque) else material

    def _is_had(self, image: TextureImage) -> bool:
        if image not in self._read:
            self._read[image] = self._found(image) if self.may_lie else None
        return self._read[image] is not None

    def _found(self, image: TextureImage) -> TextureImage | None:
        inside = image.path != image.file  # FILE.glb#NUMBER
        named = image if inside else type(image).named(self.reader.spelled(image.file))
        try:
            found = with_content(named, self.reader, self._where)
        except SceneError:
            return None
        assert isinstance(found, TextureImage)
        return found
