"""Where a scene is seen from."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from glrt.scene.values import SMALLEST, Direction, Length, Vector, are_parallel, length_of
from glrt.settings import Cost, Editable, Frozen


class Camera(Frozen):
    """A pinhole or a thin lens."""

    position: Vector = Field(description="where the camera stands, x y z in scene units")
    look_at: Vector = Field(description="the point in the middle of the frame, in scene units")
    up: Direction = Field(
        (0.0, 1.0, 0.0), description="the direction that is up in the frame, of any length"
    )
    fov: Annotated[float, Editable(unit="degrees", slider=(1, 150))] = Field(
        45.0,
        gt=0,
        lt=180,
        description="vertical angle of view in degrees, between 0 and 180",
    )
    focus_distance: Length | None = Field(
        None,
        description="distance of the plane in focus along the view axis, in scene units, above 0; "
        "default: the distance to look_at",
    )
    defocus_angle: Annotated[float, Editable(Cost.RECOMPILE, "degrees", (0, 20))] = Field(
        0.0,
        ge=0,
        lt=180,
        description="full angle of the lens seen from the point in focus, in degrees, "
        "from 0 (a pinhole) to below 180",
    )

    @property
    def view(self) -> Vector:
        """From the position to the point looked at, in scene units."""
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
