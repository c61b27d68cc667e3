"""Functions of x, y, z that the library can prove things about, and how Python functions become them.

Nothing is computed while a function is traced: it is called once with expressions for x, y and z, and what it does with
them is written down. What cannot be written down (branches, min, max, abs, conversions to numbers) is refused where it
happens, with what to use in its place.
"""

from __future__ import annotations

import decimal
import fractions
import inspect
import math
import numbers
from typing import Any, Callable, Tuple, Union

import numpy
from numpy.typing import ArrayLike

from . import _certa

Number = Union[float, numbers.Rational, decimal.Decimal]


class TraceError(TypeError):
    """A function does something with x, y or z that is no expression of them."""


_BLENDS = "smooth_union(a, b, k) in place of min, smooth_intersection(a, b, k) in place of max"


def _refuse(what, instead):
    def refusal(self, *_):
        raise TraceError(f"{what} of an expression cannot be traced: {instead}")

    return refusal


class Expression:
    """A function of x, y and z: use it with + - * / **, certa.sin and the like, or as numpy's functions' argument.

    Integers, fractions and decimals are exact; a float stands for the double that it is. Called with numbers or arrays
    for x, y, z it returns values in doubles, for drawing, not for proofs.
    """

    __slots__ = ("_function",)

    def __init__(self, value: Union[str, Number, "Expression"]) -> None:
        if isinstance(value, str):
            self._function = _certa.parse_expression(value, "expression")
        else:
            function = _function_of(value)
            if function is None:
                raise TypeError(f"expected an expression or a number, not {type(value).__name__}")
            self._function = function

    @property
    def text(self) -> str:
        """One definition per operation; reads back to the same function."""
        return _certa.format_expression(self._function)

    def gradient(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> numpy.ndarray:
        """Gradients in doubles: an array with one more axis, of length 3."""
        return self._evaluate(x, y, z)[1]

    def __call__(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Any:
        return self._evaluate(x, y, z)[0]

    def _evaluate(self, x, y, z):
        places = numpy.stack(numpy.broadcast_arrays(*(numpy.asarray(v, dtype=numpy.float64) for v in (x, y, z))), -1)
        values, gradients = _certa.values(self._function, places.reshape(-1, 3))
        values = values.reshape(places.shape[:-1])
        return (values if values.ndim else float(values)), gradients.reshape(places.shape)

    def __repr__(self):
        text = self.text.strip()
        return f"<certa.Expression: {text if len(text) <= 200 else text[:200] + ' ...'}>"

    def __reduce__(self):
        return Expression, (self.text,)

    def __neg__(self) -> "Expression":
        return _wrap(_certa.apply("negative", self._function))

    def __pos__(self) -> "Expression":
        return self

    __bool__ = _refuse("the truth", "a function has one formula everywhere; for solids use " + _BLENDS)
    __eq__ = _refuse("a comparison", "a function has one formula everywhere; for solids use " + _BLENDS)
    __ne__ = __lt__ = __le__ = __gt__ = __ge__ = __eq__
    __hash__ = object.__hash__
    __abs__ = _refuse("abs", "it has a kink; sqrt(a*a + k*k) is smooth")
    __float__ = _refuse(
        "the value", "it has none before it is meshed; use certa.sin, certa.sqrt, ... instead of math's, ** for powers"
    )
    __int__ = __index__ = __complex__ = __float__
    __round__ = __floor__ = __ceil__ = __trunc__ = _refuse("rounding", "it jumps; there is no smooth form")
    __xor__ = __rxor__ = _refuse("^", "in Python it is no power: write x**2 (in a text, x^2)")
    __mod__ = __rmod__ = __floordiv__ = __rfloordiv__ = __divmod__ = __rdivmod__ = _refuse(
        "a remainder or whole quotient", "it jumps; sin and cos repeat smoothly"
    )


def _wrap(function):
    expression = Expression.__new__(Expression)
    expression._function = function
    return expression


def _function_of(value):
    """The library's function of an expression or a number, None for anything else."""
    if isinstance(value, Expression):
        return value._function
    if isinstance(value, numpy.ndarray) and value.ndim == 0:
        value = value.item()
        return _function_of(value)
    if isinstance(value, (bool, numpy.bool_)):
        return None
    if isinstance(value, numbers.Integral):
        return _certa.parse_expression(str(int(value)), "number")
    if isinstance(value, fractions.Fraction):
        top, bottom = _function_of(value.numerator), _function_of(value.denominator)
        return _certa.apply("divide", top, bottom)
    if isinstance(value, decimal.Decimal):
        if not value.is_finite():
            raise TraceError(f"{value} is no number")
        return _certa.parse_expression(format(value, "f"), "number")
    if isinstance(value, (float, numpy.floating)):
        if not math.isfinite(value):
            raise TraceError(f"{value} is no number: a function's constants are finite")
        return _certa.constant(float(value))
    return None


def _operator(name, swapped=False):
    def operate(self, other: Union["Expression", Number]) -> "Expression":
        function = _function_of(other)
        if function is None:
            return NotImplemented
        a, b = (function, self._function) if swapped else (self._function, function)
        return _wrap(_certa.apply(name, a, b))

    return operate


for _name, _method in (("add", "add"), ("subtract", "sub"), ("multiply", "mul"), ("divide", "truediv"), ("pow", "pow")):
    setattr(Expression, f"__{_method}__", _operator(_name))
    setattr(Expression, f"__r{_method}__", _operator(_name, swapped=True))


def _method(function):
    def method(self) -> "Expression":
        return function(self)

    return method


def _unary(name):
    def function(a: Union[Expression, Number]) -> Expression:
        inner = _function_of(a)
        if inner is None:
            raise TypeError(f"{name}: expected an expression or a number, not {type(a).__name__}")
        return _wrap(_certa.apply(name, inner))

    function.__name__ = function.__qualname__ = name
    function.__module__ = "certa"
    function.__doc__ = f"{name} of an expression, as an expression."
    # numpy's functions call these methods of objects that they do not know.
    setattr(Expression, name, _method(function))
    return function


sqrt, exp, log, sin, cos = (_unary(name) for name in ("sqrt", "exp", "log", "sin", "cos"))
tan, atan, sinh, cosh, tanh = (_unary(name) for name in ("tan", "atan", "sinh", "cosh", "tanh"))
Expression.arctan = Expression.atan
Expression.square = _method(lambda a: a * a)
Expression.conjugate = _method(lambda a: a)


def _blend(name, meaning):
    def function(a: Union[Expression, Number], b: Union[Expression, Number], k: Number) -> Expression:
        inner = [_function_of(value) for value in (a, b, k)]
        if None in inner:
            raise TypeError(f"{name}: expected two expressions and a number")
        return _wrap(_certa.apply(name, *inner))

    function.__name__ = function.__qualname__ = name
    function.__module__ = "certa"
    function.__doc__ = f"{meaning} of solids that are negative inside, smooth over about the length k > 0."
    return function


smooth_union = _blend("smooth_union", "The union")
smooth_intersection = _blend("smooth_intersection", "The intersection")
smooth_difference = _blend("smooth_difference", "The first without the second")

pi = _wrap(_certa.variable("pi"))


def variables() -> Tuple[Expression, Expression, Expression]:
    """Expressions for x, y and z."""
    return tuple(_wrap(_certa.variable(name)) for name in "xyz")


def trace(function: Callable[[Expression, Expression, Expression], Any]) -> Expression:
    """The expression that a function of x, y, z computes. It is called once, with expressions.

    Raises
    ------
    TraceError where it does something that is no expression: branches, min, max, abs, conversions to numbers.
    """
    try:
        takes_three = bool(inspect.signature(function).bind(1, 2, 3))
    except ValueError:  # built-in functions need not tell
        takes_three = True
    except TypeError:
        takes_three = False
    if not takes_three:
        raise TraceError("the function must take three arguments, x, y, z")
    result = function(*variables())
    if isinstance(result, numpy.ndarray) and result.size == 1:
        result = result.item()
    if result is None:
        raise TraceError("the function returns nothing: is there a `return`?")
    inner = _function_of(result)
    if inner is None:
        raise TraceError(f"the function returns {type(result).__name__}, not an expression of x, y and z")
    return _wrap(inner)


def expression_of(function):
    """An expression from an expression, a text, a number or a Python function."""
    if isinstance(function, Expression):
        return function
    if callable(function):
        return trace(function)
    return Expression(function)
