"""For every path on standard input: imports it into an empty Blender and prints what came of it as a line of JSON. Needs Blender's own module
(`python3 -m venv DIR && DIR/bin/pip install bpy`), whose Python is then the one to run this with.
"""
import contextlib
import json
import os
import sys

import bpy


@contextlib.contextmanager
def silent():
    """Blender's own messages go to the file descriptor of standard output."""
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


for line in sys.stdin:
    file = line.strip()
    row = {"file": file}
    try:
        with silent():
            bpy.ops.wm.read_factory_settings(use_empty=True)
            bpy.ops.import_scene.gltf(filepath=file)
        row["triangles"] = sum(len(p.vertices) - 2 for mesh in bpy.data.meshes for p in mesh.polygons)
        row["materials"] = [m.name for m in bpy.data.materials]
        row["pictures"] = [list(i.size) for i in bpy.data.images if i.source == "FILE"]
        row["lights"] = [{"name": light.name, "type": light.type, "energy": light.energy} for light in bpy.data.lights]
        row["cameras"] = len(bpy.data.cameras)
    except Exception as problem:
        row["failed"] = str(problem)[:300]
    print(json.dumps(row), flush=True)
