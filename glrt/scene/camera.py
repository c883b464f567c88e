"""The camera of a scene."""

from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from glrt.scene.values import (
    SMALLEST,
    Direction,
    Length,
    Number,
    Triple,
    Value,
    Vector,
    are_parallel,
    length_of,
)
from glrt.settings import Cost, Editable


class Camera(Value):
    """A camera with a pinhole or a thin lens."""

    position: Vector = Field(description="position of the camera, x y z in scene units")
    look_at: Vector = Field(description="the point in the middle of the picture, in scene units")
    up: Direction = Field(
        (0.0, 1.0, 0.0),
        description="the direction that is up in the picture, of any length",
    )
    fov: Annotated[float, Editable(unit="degrees", slider=(1, 150))] = Field(
        45.0,
        gt=0,
        lt=180,
        description="vertical field of view",
    )
    focus_distance: Length | None = Field(
        None,
        description="distance of the plane in focus along the view axis, in scene units; "
        "default: the distance to look_at",
    )
    defocus_angle: Annotated[float, Editable(Cost.RECOMPILE, "degrees", (0, 20))] = Field(
        0.0,
        ge=0,
        lt=180,
        description="full angle under which the point in focus sees the lens; 0: a pinhole",
    )

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            position: Triple,
            look_at: Triple,
            up: Triple = (0.0, 1.0, 0.0),
            fov: Number = 45.0,
            focus_distance: Number | None = None,
            defocus_angle: Number = 0.0,
        ) -> None: ...

    @property
    def view(self) -> Vector:
        """Vector from the position to the point looked at, in scene units."""
        eye, target = self.position, self.look_at
        return (target[0] - eye[0], target[1] - eye[1], target[2] - eye[2])

    @property
    def resolved_focus_distance(self) -> float:
        """Distance of the plane in focus along the view axis, in scene units."""
        return length_of(self.view) if self.focus_distance is None else self.focus_distance

    @model_validator(mode="after")
    def _has_a_frame(self) -> Self:
        if length_of(self.view) < SMALLEST:
            raise ValueError("position and look_at are the same point; move one of them")
        if are_parallel(self.view, self.up):
            raise ValueError("up is parallel to the view; choose another direction for up")
        return self
