"""How the density of a medium varies: a grid of voxels in a box."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import Field, model_validator

from glrt.scene.files.named_grids import GridFile, NamedGrid, grid_of_array
from glrt.scene.values import Intensity, Name, Number, Triple, Value, Vector
from glrt.settings import Cost, Editable


class Density(Value):
    """A grid of densities, (z, y, x), from an .npy, OpenVDB or NanoVDB file, or an array.

    Its voxels fill the box from `min` to `max`, which lies in the frame of the object that holds
    the medium. Between the middles of voxels the density is interpolated, and outside of the box it
    is 0.
    """

    file: NamedGrid = Field(
        description="path of an .npy file: densities of float16 or float32, (z, y, x), at least 0; "
        "or of a NanoVDB file, .nvdb; or, with the extra `volumes`, of an OpenVDB file, .vdb"
    )
    grid: Name | None = Field(
        None, description="name of the grid of an OpenVDB or NanoVDB file that holds several"
    )
    min: Vector | None = Field(
        None, description="lowest corner of the box, in the object's frame; default: the object's"
    )
    max: Vector | None = Field(None, description="highest corner")
    scale: Annotated[Intensity, Editable(Cost.RESTART, "", (0, 10))] = Field(
        1.0, description="factor of all densities"
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            values: Any = None,
            *,
            file: GridFile | str | None = None,
            grid: str | None = None,
            min: Triple | None = None,
            max: Triple | None = None,
            scale: Number = 1.0,
        ) -> None: ...

    else:

        def __init__(self, values=None, **fields):
            """Take an array, (z, y, x), or a file; raises ValueError if densities are wrong."""
            if values is not None:
                if "file" in fields:
                    raise ValueError("a density is given by an array or by a file, not by both")
                fields["file"] = grid_of_array(values)
            super().__init__(**fields)

    @model_validator(mode="before")
    @classmethod
    def _of_its_grid(cls, given: Any) -> Any:
        """Give the file the name of its grid, so that two grids of one file differ."""
        if not isinstance(given, Mapping):
            return given
        file, grid = given.get("file"), given.get("grid")
        if not (isinstance(grid, str) and grid and isinstance(file, str) and file):
            return given
        return {**given, "file": GridFile.model_construct(file=file, sha256=None, grid=grid)}

    @model_validator(mode="after")
    def _is_a_box(self) -> Self:
        if (self.min is None) != (self.max is None):
            raise ValueError("must have both min and max, or neither")
        if self.min and self.max and any(a >= b for a, b in zip(self.min, self.max, strict=True)):
            raise ValueError("must have min below max, in each coordinate")
        return self
