"""Signatures and docstrings from the table of options that the command has too."""

from __future__ import annotations

import difflib
import functools
import inspect
import textwrap
from typing import Callable, Optional, Union

from . import _certa

_INTEGERS = {"COUNT", "N", "K", "D"}


def rows_of(*tables):
    """The options of several tables, each name once."""
    rows = {}
    for table in tables:
        for row in _certa.option_tables[table]:
            rows.setdefault(row["name"], row)
    return list(rows.values())


def type_of(row):
    """(annotation, default, words) of one option."""
    kind, text = row["kind"], row["default"]
    if kind == "":
        return bool, text == "on", "bool"
    if kind in ("NUMBER", "RADIANS"):
        default = float(text) if text else None
        return (float if text else Optional[float]), default, "float"
    if kind in _INTEGERS:
        return (int if text else Optional[int]), int(text) if text else None, "int"
    if kind.startswith("LENGTH"):
        words = "length or 'auto'" if "auto" in kind else "length"
        return (Union[float, str] if text else Optional[Union[float, str]]), text or None, words
    return str, text, " or ".join(f"'{name}'" for name in kind.split("|"))


def describe(row):
    """The entry of a docstring."""
    _, default, words = type_of(row)
    head = f"{row['name']} : {words}"
    if default is not None:
        head += f", default {default!r}"
    help_text = row["help"]
    if row["bounds"] and not row["kind"].startswith("LENGTH"):
        help_text += f" ({row['bounds']})"
    return head + "\n" + textwrap.fill(help_text, 92, initial_indent="    ", subsequent_indent="    ")


def documented(*tables, without=()):
    """Gives a function with **options the names, defaults and help of the tables' rows."""
    rows = [row for row in rows_of(*tables) if row["name"] not in without]
    names = [row["name"] for row in rows]

    def decorate(function):
        plain = inspect.signature(function)
        fixed = [p for p in plain.parameters.values() if p.kind != inspect.Parameter.VAR_KEYWORD]
        kept = {p.name for p in fixed}
        keywords = [
            inspect.Parameter(row["name"], inspect.Parameter.KEYWORD_ONLY, default=type_of(row)[1], annotation=type_of(row)[0])
            for row in rows
            if row["name"] not in kept
        ]
        allowed = [p.name for p in fixed] + [p.name for p in keywords]

        @functools.wraps(function)
        def checked(*arguments, **given):
            for name in given:
                if name not in allowed:
                    near = difflib.get_close_matches(name.replace("-", "_"), allowed, 1)
                    hint = f"; did you mean '{near[0]}'?" if near else ""
                    raise TypeError(f"{function.__name__}() has no option '{name}'{hint}")
            return function(*arguments, **given)

        checked.__signature__ = plain.replace(parameters=fixed + keywords)
        entries = "\n".join(describe(row) for row in rows if row["name"] in names)
        checked.__doc__ = inspect.cleandoc(function.__doc__).replace("{options}", entries).replace("{{", "{").replace("}}", "}")
        return checked

    return decorate


Progress = Optional[Callable[[str, float], object]]
