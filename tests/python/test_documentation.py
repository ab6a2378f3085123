"""The examples in docstrings give what they say, and each public function has one line at least."""

import doctest
import inspect
import pkgutil
from importlib import import_module

import numpy as np

import etendue

MODULES = [import_module(f"etendue.{m.name}") for m in pkgutil.iter_modules(etendue.__path__) if not m.name.startswith("_core")]


def test_examples() -> None:
    names = {"np": np} | {name: getattr(etendue, name) for name in etendue.__all__}
    attempted = 0
    for module in [etendue, *MODULES]:
        result = doctest.testmod(module, extraglobs=names, optionflags=doctest.NORMALIZE_WHITESPACE)
        assert result.failed == 0, module.__name__
        attempted += result.attempted
    assert attempted > 5


def test_everything_public_is_described() -> None:
    for module in MODULES:
        for name, thing in inspect.getmembers(module):
            public = not name.startswith("_") and not module.__name__.endswith("_arrays")
            if public and (inspect.isfunction(thing) or inspect.isclass(thing)) and thing.__module__ == module.__name__:
                assert thing.__doc__, f"{module.__name__}.{name}"
