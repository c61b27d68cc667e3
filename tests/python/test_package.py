"""What the package says of itself: signatures, docstrings and types agree with the command's table of options."""

import ast
import inspect
import pathlib

import certa
import pytest
from certa import _certa

STUB = pathlib.Path(certa.__file__).with_name("__init__.pyi")
TABLES = {
    "conform": ["conform"],
    "curvature": ["curvature"],
    "remesh": ["remesh"],
    "implicit": ["implicit"],
    "check": ["conforming_check", "surface_check"],
    "view": ["view"],
}


@pytest.mark.parametrize("name", TABLES)
def test_every_option_of_the_command_is_an_argument_with_its_help(name):
    function = getattr(certa, name)
    parameters = inspect.signature(function).parameters
    words = " ".join(function.__doc__.split())
    for table in TABLES[name]:
        for row in _certa.option_tables[table]:
            assert row["name"] in parameters
            assert f"{row['name']} :" in words
            if TABLES[name][0] == table:
                assert " ".join(row["help"].split()) in words
    assert "{" not in words.replace("{function = level}", "")


def test_defaults_are_those_of_the_library():
    parameters = inspect.signature(certa.conform).parameters
    assert parameters["alpha"].default == 0.4 and parameters["gabriel"].default is False
    assert parameters["protection"].default == "needed" and parameters["max_points"].default is None
    assert inspect.signature(certa.remesh).parameters["feature_angle_radians"].default == 0.6981317007977318


def test_the_stub_has_every_name_and_argument():
    assert STUB.with_name("py.typed").exists()
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    functions, classes = {}, {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            functions[node.name] = node.args
        elif isinstance(node, ast.ClassDef):
            classes[node.name] = {
                part.target.id if isinstance(part, ast.AnnAssign) else getattr(part, "name", None) for part in node.body
            }
    others = {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
    for name in certa.__all__:
        value = getattr(certa, name)
        if inspect.isfunction(value):
            given = functions[name]
            names = {argument.arg for argument in given.posonlyargs + given.args + given.kwonlyargs}
            expected = {p.name for p in inspect.signature(value).parameters.values() if p.kind != p.VAR_POSITIONAL}
            assert names == expected
        elif inspect.isclass(value):
            assert set(getattr(value, "__dataclass_fields__", ())) <= classes[name]
        else:
            assert name in others


def test_names_are_where_users_find_them():
    for name in certa.__all__:
        assert getattr(getattr(certa, name), "__module__", "certa") in ("certa", "builtins"), name
    with pytest.raises(certa.InputError) as caught:
        certa.conform([], [])
    assert repr(type(caught.value)) == "<class 'certa.InputError'>"


def test_every_public_thing_is_documented():
    for name in certa.__all__:
        value = getattr(certa, name)
        if inspect.isclass(value) or inspect.isfunction(value):
            assert value.__doc__ and not value.__doc__.startswith(f"{name}("), name
