"""Tracing: Python functions become the functions that they compute, or are refused where they cannot."""

import decimal
import fractions
import math
import operator
import pickle

import certa
import numpy
import pytest
from hypothesis import given, settings, strategies

X, Y, Z = certa.variables()


def close(traced, plain, places):
    for x, y, z in places:
        expected = plain(x, y, z)
        assert math.isclose(traced(x, y, z), expected, rel_tol=1e-9, abs_tol=1e-9)


PLACES = [(0.3, -0.7, 1.1), (1.5, 0.25, -0.5), (-2.0, 1.0, 0.125)]


def test_functions_are_what_they_compute():
    def torus(x, y, z):
        ring = x**2 + y**2
        return (ring + z**2 + 0.84) ** 2 - 4 * ring

    close(certa.trace(torus), torus, PLACES)


@pytest.mark.parametrize(
    "function",
    [
        lambda m, x, y, z: m.sin(x) + m.cos(y) - m.exp(-z) * m.tanh(x),
        lambda m, x, y, z: m.sqrt(x * x + y * y + 1) / (2 + m.sinh(z) ** 2),
        lambda m, x, y, z: m.log(x * x + 1) - m.cosh(y) + m.tan(z / 10),
    ],
)
def test_functions_of_certa_and_numpy_mean_those_of_math(function):
    for module in (certa, numpy):
        close(certa.trace(lambda x, y, z: function(module, x, y, z)), lambda x, y, z: function(math, x, y, z), PLACES)


leaves = strategies.one_of(
    strategies.sampled_from(["x", "y", "z"]), strategies.integers(-50, 50), strategies.floats(-50, 50, width=32)
)
trees = strategies.recursive(
    leaves,
    lambda inner: strategies.tuples(strategies.sampled_from(["add", "sub", "mul", "truediv"]), inner, inner),
    max_leaves=12,
)


def build(tree, names):
    if isinstance(tree, tuple):
        return getattr(operator, tree[0])(build(tree[1], names), build(tree[2], names))
    return names.get(tree, tree) if isinstance(tree, str) else tree


@settings(max_examples=60)
@given(trees)
def test_random_formulas_have_the_values_of_exact_arithmetic(tree):
    place = {"x": fractions.Fraction(3, 8), "y": fractions.Fraction(-5, 4), "z": fractions.Fraction(7, 2)}

    def exact(node):
        if isinstance(node, tuple):
            return getattr(operator, node[0])(exact(node[1]), exact(node[2]))
        return place[node] if isinstance(node, str) else fractions.Fraction(node)

    try:
        expected = exact(tree)
        traced = certa.trace(lambda x, y, z: build(tree, {"x": x, "y": y, "z": z}))
    except ZeroDivisionError:
        return
    again = pickle.loads(pickle.dumps(traced))
    values = [float(place[name]) for name in "xyz"]
    for function in (traced, again):
        value = function(*values)
        if math.isfinite(value) and abs(expected) < 1e6:
            scale = max(1.0, abs(float(expected)))
            assert abs(value - float(expected)) < 1e-6 * scale or abs(expected) < 1e-3


def test_constants_are_exact():
    assert certa.Expression("0.1").text != certa.Expression(0.1).text
    assert certa.Expression(decimal.Decimal("0.1")).text == certa.Expression("0.1").text
    assert (X * fractions.Fraction(1, 3))(3, 0, 0) == 1
    assert str(10**40).rstrip("0") in (X + 10**40).text.replace("0.", "").replace("e41", "")
    assert (X + numpy.float32(0.1)).text == (X + float(numpy.float32(0.1))).text
    assert (X + numpy.int64(3)).text == (X + 3).text


def test_numpy_objects():
    close(certa.trace(lambda *p: (numpy.array(p) ** 2).sum() - 1), lambda x, y, z: x * x + y * y + z * z - 1, PLACES)
    close(certa.trace(lambda *p: numpy.linalg.norm(p) - 1), lambda x, y, z: math.hypot(x, y, z) - 1, PLACES)
    close(certa.trace(lambda x, y, z: numpy.float64(2) * x), lambda x, y, z: 2 * x, PLACES)


def test_values_and_gradients_of_arrays():
    function = X**2 + 3 * Y
    x = numpy.linspace(-1, 1, 7)
    assert numpy.allclose(function(x[:, None], x, 0), x[:, None] ** 2 + 3 * x)
    assert numpy.allclose(function.gradient(x, 0, 0), numpy.stack([2 * x, 3 + 0 * x, 0 * x], 1))


@pytest.mark.parametrize(
    "function, words",
    [
        (lambda x, y, z: x if x > 0 else y, "comparison"),
        (lambda x, y, z: x if x else y, "truth"),
        (lambda x, y, z: y if x == 0 else x, "comparison"),
        (lambda x, y, z: x and y, "truth"),
        (lambda x, y, z: max(x, y), "smooth_intersection"),
        (lambda x, y, z: numpy.maximum(x, y), "smooth_intersection"),
        (lambda x, y, z: numpy.where(x < y, x, y), "comparison"),
        (lambda x, y, z: abs(x), "kink"),
        (lambda x, y, z: numpy.abs(x), "kink"),
        (lambda x, y, z: math.sin(x), "certa.sin"),
        (lambda x, y, z: float(x), "certa.sin"),
        (lambda x, y, z: int(x), "value"),
        (lambda x, y, z: round(x), "jumps"),
        (lambda x, y, z: math.floor(x), "jumps"),
        (lambda x, y, z: x % 1, "jumps"),
        (lambda x, y, z: x // 2, "jumps"),
        (lambda x, y, z: x ^ 2, r"x\*\*2"),
        (lambda x, y, z: 2 ^ x, r"x\*\*2"),
        (lambda x, y, z: None, "return"),
        (lambda x, y, z: [x, y], "list"),
        (lambda x, y, z: x + math.nan, "nan"),
        (lambda x, y, z: x * math.inf, "inf"),
        (lambda x, y: x + y, "x, y, z"),
        (lambda p: p, "x, y, z"),
    ],
)
def test_what_cannot_be_traced_is_refused(function, words):
    with pytest.raises(certa.TraceError, match=words):
        certa.trace(function)


def test_exponents_are_constants():
    with pytest.raises(certa.InputError, match="exponent"):
        certa.trace(lambda x, y, z: 2**x)


def test_errors_of_the_function_come_through():
    def broken(x, y, z):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        certa.implicit(broken)


def test_texts_say_where_they_are_wrong():
    with pytest.raises(certa.ExpressionError) as caught:
        certa.implicit("x^2 + min(y, z)")
    assert caught.value.line == 1 and caught.value.column == 7 and "smooth_union" in str(caught.value)
    copy = pickle.loads(pickle.dumps(caught.value))
    assert (str(copy), copy.column) == (str(caught.value), 7)


def test_long_sums_are_fine():
    def many(x, y, z):
        total = x
        for i in range(5000):
            total = total + y * i
        return total

    assert certa.trace(many)(1, 0, 0) == 1


def test_a_traced_function_is_meshed():
    a, b = certa.trace(lambda x, y, z: (x - 0.5) ** 2 + y**2 + z**2 - 0.3), certa.Expression("(x+1/2)^2+y^2+z^2-0.3")
    one = certa.implicit(certa.smooth_union(a, b, 0.1))
    assert [component.genus for component in one.components] == [0] and one.proved == ["isotopic"]
