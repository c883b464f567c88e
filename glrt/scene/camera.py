"""The camera of a scene."""

from collections.abc import Generator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Self, overload

from pydantic import (
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)

from glrt.scene.files.named_cameras import CameraFile, NamedCamera, OneCamera
from glrt.scene.values import (
    LARGEST,
    SMALLEST,
    Direction,
    Length,
    Name,
    Number,
    Triple,
    Value,
    Vector,
    are_parallel,
    length_of,
)
from glrt.settings import Cost, Editable

OF_FILE = ("position", "look_at", "up", "fov")  # fields that a glTF file gives
_OF_NODE = ("node", "time", "animation")
_UNREAD = {"position": (0.0, 0.0, 0.0), "look_at": (0.0, 0.0, -1.0)}  # before the file is read


def _is_given_or_of_file(schema: dict[str, Any]) -> None:
    """Require position and look_at in a schema unless there is a file."""
    schema["anyOf"] = [{"required": schema.pop("required")}, {"required": ["file"]}]


class Camera(Value):
    """A camera with a pinhole or a thin lens, at a given place or that of a glTF file.

    With `file`, fields that are not given are those of the file's camera, one unit in front of
    which is `look_at`. Iteration and scene files then leave these fields out.
    """

    model_config = ConfigDict(json_schema_extra=_is_given_or_of_file)

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
    shutter: Annotated[float, Editable(unit="of a frame", slider=(0, 1))] = Field(
        0.0,
        ge=0,
        le=1,
        description="share of a frame's time for which the shutter is open, from the moment of the "
        "frame on: what [animation] moves is blurred by `glrt render` and `glrt film`; the window "
        "shows the moment; 0: always the moment",
    )
    file: NamedCamera | None = Field(
        None,
        description="path of a model, glTF or USD, whose camera gives position, look_at, up and "
        "fov where they are not given, and the shape of the picture; default: none",
    )
    node: Name | None = Field(
        None,
        description="name of the node with that camera, or its number from 0 where other nodes "
        "share the name; default: the only one of the file",
    )
    time: Annotated[float | None, Editable(Cost.RESTART, "seconds")] = Field(
        None,
        ge=0,
        le=LARGEST,
        description="moment of an animation of that file; default: the camera moves in `glrt film` "
        "where the file moves it",
    )
    animation: Name | None = Field(
        None,
        description="name of that animation, or its number from 0; default: the first that moves "
        "the camera",
    )

    if TYPE_CHECKING:

        @overload
        def __init__(
            self,
            *,
            position: Triple,
            look_at: Triple,
            up: Triple = (0.0, 1.0, 0.0),
            fov: Number = 45.0,
            focus_distance: Number | None = None,
            defocus_angle: Number = 0.0,
            shutter: Number = 0.0,
        ) -> None: ...

        @overload
        def __init__(
            self,
            *,
            file: CameraFile | str,
            node: str | None = None,
            time: Number | None = None,
            animation: str | None = None,
            **others: Any,
        ) -> None: ...

        def __init__(self, **fields: Any) -> None: ...

    def __iter__(self) -> Generator[tuple[str, Any], None, None]:
        """Yield names and values of the fields that the file does not give."""
        names = self.model_fields_set
        for name, value in super().__iter__():
            if self.file is None or name not in OF_FILE or name in names:
                yield name, value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Camera) and dict(self) == dict(other)

    def __hash__(self) -> int:
        return hash(tuple(self))

    @property
    def in_file(self) -> OneCamera | None:
        """The camera of the file; None without a file, and before it is read."""
        cameras = self.file.cameras if self.file else None
        return cameras.find(self.node) if cameras else None

    @property
    def view(self) -> Vector:
        """Vector from the position to the point looked at, in scene units."""
        eye, target = self.position, self.look_at
        return (target[0] - eye[0], target[1] - eye[1], target[2] - eye[2])

    @property
    def resolved_focus_distance(self) -> float:
        """Distance of the plane in focus along the view axis, in scene units."""
        return length_of(self.view) if self.focus_distance is None else self.focus_distance

    @model_validator(mode="wrap")
    @classmethod
    def _follows_its_file(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Fill fields that are not given with those of the file, which stay unset."""
        if not isinstance(data, Mapping) or data.get("file") is None:
            return handler(data)
        given = data.keys()
        made = handler({**_of_file(data), **data})
        made.__pydantic_fields_set__.difference_update(set(OF_FILE) - given)
        return made

    @model_serializer(mode="wrap")
    def _without_fields_of_file(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        table: dict[str, Any] = handler(self)
        if self.file is not None:
            for name in set(OF_FILE) - self.model_fields_set:
                table.pop(name, None)
        return table

    @model_validator(mode="after")
    def _has_a_frame(self) -> Self:
        if self.file is None:
            if stray := [name for name in _OF_NODE if getattr(self, name) is not None]:
                raise ValueError(f"{stray[0]} belongs to a `file` with a camera, which is missing")
        elif self.file.cameras is None:
            return self
        if length_of(self.view) < SMALLEST:
            raise ValueError("position and look_at are the same point; move one of them")
        if are_parallel(self.view, self.up):
            raise ValueError("up is parallel to the view; choose another direction for up")
        return self


def _of_file(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that a file gives at a moment, as Python's own numbers."""
    file = data["file"]
    if not isinstance(file, CameraFile) or file.cameras is None:
        return dict(_UNREAD)
    try:
        found = file.cameras.find(data.get("node"))
        view = found.view(data.get("animation"), data.get("time"))
    except ValueError as error:
        raise ValueError(f"{file.file}: {error}") from None
    triples = {name: tuple(map(float, getattr(view, name))) for name in OF_FILE[:-1]}
    return {**triples, "fov": view.fov}
