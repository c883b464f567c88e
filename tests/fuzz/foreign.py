"""Words by which a message betrays that a library, or Python itself, has written it."""

import re

FOREIGN = re.compile(
    "|".join(
        (
            r"No module named|has no attribute|NoneType|not subscriptable|not iterable|unhashable",
            r"out of (range|bounds) for|index out of|index \S+ is out|unsupported operand|codec",
            r"invalid literal|could not convert|cannot convert|too large to convert|math domain",
            r"positional argument|keyword argument|expected \d+ argument|object is not|truth value",
            r"struct\.error|unpack requires|buffer (size|is smaller|is too small)|bytes-like",
            r"need at least one|cannot reshape|broadcast|itemsize|ufunc|dtype|array is too big",
            r"zlib|decompress|Error -\d|cannot identify|broken PNG|bad header|enough image data",
            r"(Key|Value|Type|Index|Attribute|Overflow|Syntax|Zero\w+|Assertion|Recursion)Error",
            r"Expecting |Extra data|Invalid control character|maximum recursion|Traceback",
            r"image file is|Unable to allocate|pydantic|validation error|std::|OpenEXR::|libpng",
        )
    )
)


def is_foreign(message: str) -> bool:
    """Whether a message holds words of a library's exception."""
    return bool(FOREIGN.search(message))
