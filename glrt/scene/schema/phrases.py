"""Words for mistakes in a scene, by pydantic's name of the mistake or by its place."""

PLAIN = {
    "int_type": "must be a whole number",
    "float_type": "must be a number",
    "finite_number": "must be a finite number",
    "string_type": "must be text in quotes",
    "string_unicode": "must be text that UTF-8 can hold",
    "invalid_key": "must have keys that are text",
    "string_too_short": "must not be empty",
    "string_pattern_mismatch": "must be one line, without control characters",
    "greater_than": "must be greater than {gt}",
    "greater_than_equal": "must be at least {ge}",
    "less_than": "must be less than {lt}",
    "less_than_equal": "must be at most {le}",
    "tuple_type": "must be a list of three numbers",
}
HEADINGS: dict[tuple[int | str, ...], str] = {
    (): "a scene must be a table",
    ("camera",): "must be a table headed [camera]",
    ("render",): "must be a table headed [render]",
    ("render", "phong"): "must be a table headed [render.phong]",
    ("background",): "must be a table headed [background]",
    ("sun",): "must be a table headed [sun]",
    ("probes",): "must be a table headed [probes]",
    ("animation",): "must be a table headed [animation]",
    ("animation", "tracks"): "must be a list of tables, each headed [[animation.tracks]]",
    ("lights",): "must be a table headed [lights]",
    ("materials",): "must be a table of tables, each headed [materials.NAME]",
    ("media",): "must be a table of tables, each headed [media.NAME]",
    ("objects",): "must be a list of tables, each headed [[objects]]",
}
COUNTED: dict[tuple[int | str, ...], str] = {("objects",): "shapes", ("media",): "media"}
