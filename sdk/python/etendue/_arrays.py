"""Numbers and arrays on their way into the compiled half."""

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import Error

Array = TypeVar("Array", NDArray[np.float64], NDArray[np.float32])
FloatArray = NDArray[np.float64] | NDArray[np.float32]
# A number gives a number, an array an array of the same precision.
Number = TypeVar("Number", float, NDArray[np.float64], NDArray[np.float32])


def as_array(value: ArrayLike, name: str) -> FloatArray:
    """As float32 where it is float32, else as float64; no copy of either."""
    array = np.asarray(value)
    if array.dtype == np.float32:
        return array
    if array.dtype.kind not in "fiu":
        raise Error("NUMBER_INVALID", f"expected numbers for {name}, found {array.dtype.name}: {value!r}", field=name)
    return array.astype(np.float64, copy=False)


def elementwise(kernel: Callable[..., Any], *extra: object, **arguments: ArrayLike) -> Any:
    """kernel(arguments..., extra...): of numbers, or of arrays that broadcast with each other as NumPy's do."""
    try:
        return _elementwise(kernel, extra, arguments)
    except Error as error:
        error.field = error.field or (next(iter(arguments)) if len(arguments) == 1 else "")
        raise


def _elementwise(kernel: Callable[..., Any], extra: tuple[object, ...], arguments: dict[str, ArrayLike]) -> Any:
    numbers = arguments.values()
    if all(type(x) is float for x in numbers):
        return kernel(*numbers, *extra)
    arrays = [as_array(x, name) for name, x in arguments.items()]
    if all(a.ndim == 0 for a in arrays):
        return kernel(*(float(a) for a in arrays), *extra)
    single = all(a.dtype == np.float32 for a in arrays if a.ndim > 0)
    dtype = np.float32 if single else np.float64
    if len(arrays) > 1:
        try:
            arrays = list(np.broadcast_arrays(*arrays))
        except ValueError:
            shapes = ", ".join(f"{name} {np.shape(x)}" for name, x in arguments.items())
            raise Error("SHAPE_MISMATCH", f"expected shapes that broadcast, found {shapes}", field=next(iter(arguments))) from None
    return kernel(*(np.ascontiguousarray(a, dtype) for a in arrays), *extra)


def rowwise(kernel: Callable[..., Any], width: int, name: str, rows: ArrayLike, wrap: Callable[..., Any] = lambda x: x) -> Any:
    """kernel(rows): of arrays whose last extent is `width`. One row gives a number, or wrap(numbers...)."""
    array = as_array(rows, name)
    if array.ndim == 0 or array.shape[-1] != width:
        raise Error("SHAPE_MISMATCH", f"expected {name} of {width} numbers in its last extent, found shape {array.shape}", field=name)
    try:
        result = kernel(np.ascontiguousarray(array))
    except Error as error:
        error.field = error.field or name
        raise
    if array.ndim > 1:
        return result
    return wrap(*result.tolist()) if result.ndim else float(result)
