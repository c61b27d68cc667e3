#!/usr/bin/env python3
"""Writes the typed stub of the package, from the package: generate_stubs.py FOLDER_OF_PACKAGE OUTPUT.

Signatures come from the functions, whose options come from the command's table; so nothing is written down twice.
"""

import dataclasses
import enum
import inspect
import sys
import textwrap

HEAD = '''"""Types of the package certa. Generated with the module: changes are lost."""

import decimal
import enum
import numbers
import os
import typing
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple, Union

import numpy
from numpy.typing import ArrayLike

Array = numpy.ndarray[Any, Any]
# Objects with .vertices and .faces or .points and .faces are meshes, too; functions are texts, expressions, callables.
MeshLike = Any
Faces = Any
FunctionLike = Any
Path = Union[str, "os.PathLike[str]"]
Progress = Optional[Callable[[str, float], object]]
Number = Union[float, numbers.Rational, decimal.Decimal]

__version__: str
'''
# Functions whose result depends on one argument: its name, then its type and that of the result.
OVERLOADS = {"curvature": ("region", [("None", "CurvatureResult"), ("Union[str, ArrayLike]", "RegionResult")])}


def type_text(annotation):
    if annotation is inspect.Parameter.empty:
        return "Any"
    annotation = getattr(annotation, "__forward_arg__", annotation)
    text = annotation if isinstance(annotation, str) else inspect.formatannotation(annotation)
    return text.replace("typing.", "").replace("NoneType", "None").replace("numpy.ndarray", "Array")


def parameter_text(parameter):
    text = parameter.name
    if parameter.kind == parameter.VAR_POSITIONAL:
        text = "*" + text
    elif parameter.kind == parameter.VAR_KEYWORD:
        text = "**" + text
    if parameter.name == "self":
        return text
    text += ": " + type_text(parameter.annotation)
    if parameter.default is not parameter.empty:
        text += " = " + (repr(parameter.default) if isinstance(parameter.default, (int, float, str, type(None))) else "...")
    return text


def signature_text(function, returns=None, narrowed=None):
    parts, starred = [], False
    parameters = list(inspect.signature(function).parameters.values())
    for i, parameter in enumerate(parameters):
        if parameter.kind == parameter.VAR_POSITIONAL:
            starred = True
        if parameter.kind == parameter.KEYWORD_ONLY and not starred:
            parts.append("*")
            starred = True
        if narrowed and parameter.name == narrowed[0]:
            parts.append(f"{parameter.name}: {narrowed[1]}" + (" = None" if narrowed[1] == "None" else ""))
        else:
            parts.append(parameter_text(parameter))
        last = i + 1 == len(parameters) or parameters[i + 1].kind != parameter.POSITIONAL_ONLY
        if parameter.kind == parameter.POSITIONAL_ONLY and last and parameter.name != "self":
            parts.append("/")
    result = returns or type_text(inspect.signature(function).return_annotation)
    return f"({', '.join(parts)}) -> {result}"


def function_stub(name, function):
    lines = []
    if name in OVERLOADS:
        argument, cases = OVERLOADS[name]
        for kind, result in cases:
            lines += ["@typing.overload", f"def {name}{signature_text(function, result, (argument, kind))}: ..."]
    else:
        text = f"def {name}{signature_text(function)}:"
        if not function.__doc__:
            return [text + " ..."]
        lines += [text, textwrap.indent('"""' + function.__doc__ + '\n"""', "    ")]
    return lines


def method_stubs(kind):
    lines = []
    for name, member in vars(kind).items():
        if isinstance(member, property):
            lines += ["    @property", f"    def {name}(self) -> {type_text(inspect.signature(member.fget).return_annotation)}: ..."]
        elif inspect.isfunction(member) and (not name.startswith("_") or name in KEPT):
            lines.append(f"    def {name}{signature_text(member)}: ...")
    return lines


KEPT = {"__init__", "__call__", "__neg__", "__pos__", "_repr_html_"} | {
    f"__{side}{name}__" for side in ("", "r") for name in ("add", "sub", "mul", "truediv", "pow")
}


def class_stub(name, kind):
    if issubclass(kind, enum.Enum):
        return [f"class {name}(enum.IntFlag):"] + [f"    {member.name} = {member.value}" for member in kind]
    if issubclass(kind, tuple):
        return [f"class {name}(NamedTuple):"] + [
            f"    {field}: {type_text(hint)}" + ("  # type: ignore[assignment]" if hasattr(tuple, field) else "")
            for field, hint in kind.__annotations__.items()
        ]
    base = kind.__bases__[0].__name__
    lines = [f"class {name}({base}):" if base != "object" else f"class {name}:"]
    if dataclasses.is_dataclass(kind):
        lines += [f"    {field.name}: {type_text(field.type)}" for field in dataclasses.fields(kind)]
        lines += [line for line in method_stubs(kind) if "def __init__" not in line]
    else:
        lines += [f"    {field}: {type_text(hint)}" for field, hint in vars(kind).get("__annotations__", {}).items()]
        lines += method_stubs(kind)
    return lines if len(lines) > 1 else [lines[0] + " ..."]


def main():
    folder, output = sys.argv[1:]
    sys.dont_write_bytecode = True
    sys.path.insert(0, folder)
    import certa

    blocks = []
    for name in certa.__all__:
        value = getattr(certa, name)
        if inspect.isclass(value):
            blocks.append(class_stub(name, value))
        elif inspect.isfunction(value):
            blocks.append(function_stub(name, value))
        else:
            blocks.append([f"{name}: {type(value).__name__}"])
    with open(output, "w", encoding="utf-8") as file:
        file.write(HEAD + "\n" + "\n\n".join("\n".join(block) for block in blocks) + "\n")


if __name__ == "__main__":
    main()
