"""Exceptions and warnings, and the small tuples that say where something is wrong."""

from __future__ import annotations

import functools
import re
from typing import List, NamedTuple, Optional, Tuple

from . import _certa


@functools.lru_cache(maxsize=None)
def _arguments():
    """The command's flags as arguments are written here."""
    names = {"input-format": "format=", "output-format": "format=", "against": "against=", "level": "level="}
    for rows in _certa.option_tables.values():
        for row in rows:
            names.setdefault(row["flag"], row["name"] + ("=" if row["kind"] else "=True"))
    return names


def spelled(message: str) -> str:
    """A message of the library in Python's words: "use --repair" becomes "use repair=True"."""
    return re.sub(
        r"--([a-z]+(?:-[a-z]+)*)", lambda flag: _arguments().get(flag[1], flag[1].replace("-", "_")), message
    )


class ElementRef(NamedTuple):
    """One element of a mesh: "vertex", "segment", "facet", ... and its index from 0."""

    kind: str
    index: int


class Defect(NamedTuple):
    """What is wrong with the data: a stable name, the elements, a place, and a sentence with the way out.

    Messages count elements from 1, as files do; `elements` holds indices from 0.
    """

    kind: str
    elements: List[ElementRef]
    place: Tuple[float, float, float]
    message: str


class Violation(NamedTuple):
    """A broken promise that a check found."""

    promise: str
    elements: List[ElementRef]
    place: Tuple[float, float, float]
    message: str


class InputError(ValueError):
    """The data or an option cannot be worked with; nothing was computed.

    `defects` holds all that was found; `kind`, `elements` and `place` are those of the first.
    """

    message: str
    defects: List[Defect]

    def __init__(self, message: str, defects: Optional[List[Defect]] = None) -> None:
        super().__init__(message, defects)
        self.message = message
        self.defects = defects or []

    def __str__(self) -> str:
        return self.message

    @property
    def kind(self) -> Optional[str]:
        return self.defects[0].kind if self.defects else None

    @property
    def elements(self) -> List[ElementRef]:
        return self.defects[0].elements if self.defects else []

    @property
    def place(self) -> Optional[Tuple[float, float, float]]:
        return self.defects[0].place if self.defects else None


class IoError(OSError):
    """A file that cannot be read or written; `line` counts from 1 and is 0 where there is none."""

    message: str
    path: str
    line: int
    reason: str

    def __init__(self, message: str, path: str = "", line: int = 0, reason: str = "") -> None:
        super().__init__(message, path, line, reason)
        self.message = message
        self.path = path
        self.line = line
        self.reason = reason

    def __str__(self) -> str:
        return self.message

    def __reduce__(self):
        return type(self), (self.message, self.path, self.line, self.reason)


class ExpressionError(IoError):
    """A text that is no expression; `column` counts bytes from 1."""

    column: int

    def __init__(self, message: str, path: str = "", line: int = 0, reason: str = "", column: int = 0) -> None:
        super().__init__(message, path, line, reason)
        self.column = column

    def __reduce__(self):
        return type(self), (self.message, self.path, self.line, self.reason, self.column)


class InternalError(RuntimeError):
    """A broken promise inside the library: please report it with the input."""


class CertaWarning(UserWarning):
    """Something to know about an input or a result that is otherwise fine."""


class UnfinishedWarning(CertaWarning):
    """The result is not what was asked for: its `outcome` says why."""
