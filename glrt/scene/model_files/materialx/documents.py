"""A MaterialX document with its included documents, from its folder alone."""

import os

import MaterialX

from glrt.scene.model_files.conversion.folder import Folder
from glrt.scene.model_files.conversion.reports import UnshownError

_MOST_INCLUDED = 1_000  # documents
_PROBLEMS = (
    MaterialX.Exception,
    MaterialX.ExceptionFileMissing,
    MaterialX.ExceptionFoundCycle,
    MaterialX.ExceptionOrphanedElement,
    MaterialX.ExceptionParseError,
    OSError,
    ValueError,
)


def opened_document(folder: Folder) -> MaterialX.Document:
    """Return a document; included ones that may not or cannot be read are left out by name.

    Raises `UnshownError`.
    """
    document, known = MaterialX.createDocument(), set[str]()
    try:
        _read(document, str(folder.root), folder, known)
    except _PROBLEMS:
        raise UnshownError("is damaged, or no MaterialX file") from None
    return document


def _read(document: MaterialX.Document, path: str, folder: Folder, known: set[str]) -> None:
    known.add(os.path.realpath(path))
    options = MaterialX.XmlReadOptions()

    def include(inner: MaterialX.Document, name: MaterialX.FilePath, *_: object) -> None:
        given = name.asString()
        found = os.path.join(os.path.dirname(path), given)
        if not folder.may_read(found):
            folder.left.name("documents outside of the folder (--allow-outside)", given)
        elif os.path.realpath(found) not in known and len(known) < _MOST_INCLUDED:
            try:
                _read(inner, found, folder, known)
            except _PROBLEMS:
                folder.left.name("documents that cannot be read", given)
            else:
                folder.layers.append(folder.relative(found))

    options.readXIncludeFunction = include
    MaterialX.readFromXmlFile(document, path, MaterialX.FileSearchPath(), options)
