"""`pip install .` into a fresh environment, whose packages are those of this interpreter, and the module from there.

tests/python/pip_install.py FOLDER BUILD COMPILER
"""

import os
import pathlib
import shutil
import subprocess
import sys
import venv

root = pathlib.Path(__file__).parents[2]
folder, build, compiler = pathlib.Path(sys.argv[1]), *sys.argv[2:]
shutil.rmtree(folder, ignore_errors=True)
venv.create(folder, with_pip=True)
python = folder / "bin" / "python"
site = next(folder.glob("lib/python*/site-packages"))
(site / "parent.pth").write_text("\n".join(p for p in sys.path if p.endswith("site-packages")))


environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


def run(*command: object, cwd: pathlib.Path = folder) -> str:
    done = subprocess.run(
        list(map(str, command)),
        cwd=cwd,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if done.returncode:
        sys.exit(f"{command}:\n{done.stdout}")
    return done.stdout


# Where no image library can be found, as on a machine without them.
absent = ["OpenImageIO", "OpenEXR", "TinyGLTF", "embree", "OpenColorIO", "CLI11", "pugixml"]
defines = [f"CMAKE_DISABLE_FIND_PACKAGE_{package}=ON" for package in absent]
# With the compiler and the flags of this project's presets, beside them: ccache then has the objects already.
defines += ["ETENDUE_WERROR=ON", f"CMAKE_CXX_COMPILER={compiler}"]
settings = [f"--config-settings=build-dir={build}", *(f"--config-settings=cmake.define.{d}" for d in defines)]
run(python, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--disable-pip-version-check", *settings, root)
print(run(python, "-c", "import etendue; print(etendue.__file__); print(etendue.colour.planckian(2856.0))"))
assert (site / "etendue" / "py.typed").exists()
