#!/usr/bin/env python3
"""Writes the example rigs (.rig.json) and their geometry (.glb) beside this file.

python3 generate.py            writes all of them
python3 generate.py --check    writes nothing; fails if a file differs from what would be written
"""

import argparse
import pathlib
import sys

sys.dont_write_bytecode = True  # before the imports below, so that they leave nothing in the source tree

from scenes import kitchen, street, studio, table

HERE = pathlib.Path(__file__).resolve().parent
SCENES = {"kitchen": kitchen.build, "studio": studio.build, "street": street.build, "table": table.build}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare with the files that are there")
    parser.add_argument("scene", nargs="*", help=f"of {', '.join(SCENES)}; all without it")
    arguments = parser.parse_args()
    unknown = set(arguments.scene) - set(SCENES)
    if unknown:
        parser.error(f"no scene {', '.join(sorted(unknown))}")
    differing = []
    for scene in arguments.scene or SCENES:
        for name, data in SCENES[scene]().items():
            path = HERE / name
            if not arguments.check:
                path.write_bytes(data)
                print(f"{name}: {len(data)} bytes")
            elif not path.is_file() or path.read_bytes() != data:
                differing.append(name)
    if differing:
        sys.exit("differs from what generate.py writes: " + ", ".join(differing))


if __name__ == "__main__":
    main()
