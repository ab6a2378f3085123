"""The committed stub of etendue._core is the one that nanobind writes now; --update writes it."""

import pathlib
import sys

from nanobind.stubgen import StubGen

import etendue._core

stub = pathlib.Path(__file__).parents[2] / "sdk/python/etendue/_core.pyi"
generator = StubGen(module=etendue._core)
generator.put(etendue._core)
current = generator.get()
if "--update" in sys.argv:
    stub.write_text(current)
elif stub.read_text() != current:
    sys.exit(f"{stub} is not what the module is now: tests/python/stubs.py --update")
