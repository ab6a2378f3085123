"""Specular-glossiness assets as metallic-roughness: ours, glTF-Transform's `metalrough`, Khronos' closed form and the optimum in one run, in a
reader of the core alone and in one that knows KHR_materials_specular; and whether others read what we write. Part `gltf` of `materials`.
"""
import json
import pathlib
import subprocess
import tempfile

import numpy as np

import gltf_bounds
from gltf_assets import Asset, gloss, halved, metal, rms

HERE = pathlib.Path(__file__).resolve().parent
LIMITS = {8: 1e-3, 16: 1e-4}  # of a full reader
# Below this a core-only reader's rms is called exact: codes of 8 bits around a colour that the core can say leave more.
EXACT = 1e-5


def answers(folder, program, lines):
    """What a Node program says of each line; None where npm has not brought it."""
    if not (folder / "node_modules").exists():
        return None
    run = subprocess.run(["node", program], input="".join(line + "\n" for line in lines), capture_output=True, text=True, cwd=folder)
    if run.returncode != 0:
        return [{"failed": run.stderr[-500:]}] * len(lines)
    return [json.loads(line) for line in run.stdout.splitlines()]


class Part:
    def __init__(self, build, options, figure):
        self.etendue, self.corpus, self.figure = build / "etendue", options.corpus, figure
        self.blender, self.asset, self.written = options.blender, options.asset, []

    def run(self):
        files = sorted(f for f in self.corpus.rglob("*.gl*") if f.suffix in (".gltf", ".glb") and "Validator" not in str(f) and self.asset in str(f)
                       and b"KHR_materials_pbrSpecularGlossiness" in f.read_bytes())
        if not files:
            print("gltf: no specular-glossiness asset under %s, skipped" % self.corpus)
            return
        with tempfile.TemporaryDirectory() as folder:
            for file in files:
                self.measure(file, pathlib.Path(folder))
            self.read_by_others()

    def convert(self, file, out, *words):
        run = subprocess.run([self.etendue, "convert", file, out, "--materials", "metal-rough", "--json", *words], capture_output=True, text=True)
        self.figure("%s: etendue convert, exit status" % out.name, run.returncode, 0)
        if run.returncode != 0:
            print(run.stdout[-1500:], run.stderr[-500:])
            return None
        self.written.append(out)
        return json.loads(run.stdout)["result"][0].get("materials", [])

    def measure(self, file, folder):
        before = Asset(file)
        peer = folder / (file.stem + ".peer.glb")
        said = answers(HERE / "gltf_transform", "transform.js", [json.dumps({"file": str(file), "out": str(peer)})])
        theirs = Asset(peer) if said and "failed" not in said[0] else None
        if said and theirs is None:
            print("glTF-Transform: %s" % said[0]["failed"])
        ours = {}
        for bits in (8, 16):
            for readers in ("all", "core"):
                for extension in ("glb", "gltf") if (bits, readers) == (8, "all") else ("glb",):
                    out = folder / extension / ("%s-%d-%s.%s" % (file.stem, bits, readers, extension))
                    out.parent.mkdir(exist_ok=True)
                    reports = self.convert(file, out, "--bits", str(bits), "--readers", readers)
                    if reports is not None and extension == "glb":
                        ours[bits, readers] = Asset(out), reports
        for index, material in enumerate(before.document.get("materials", [])):
            if "KHR_materials_pbrSpecularGlossiness" in material.get("extensions", {}):
                self.rows(file, index, before, theirs, ours)
                if (8, "all") in ours:
                    self.mip_levels(file, folder / "glb" / ("%s-8-all.glb" % file.stem), index)

    def mip_levels(self, file, converted, index):
        """Readers filter what a file stores, products of which are the colours: beside the means of the colours, what the asset itself is off by
        and what the converted file is."""
        asset, material = Asset(file), Asset(file).document["materials"][index]
        e = material["extensions"]["KHR_materials_pbrSpecularGlossiness"]
        picture = e.get("diffuseTexture") or e.get("specularGlossinessTexture")
        if picture is None:
            return
        shape = asset.pixels(picture, True).shape[:2]
        colours = [c.reshape(*shape, -1) for c in gloss(asset, material)[:2] if len(c) == shape[0] * shape[1]]
        for level in (1, 2, 3) if len(colours) == 2 else ():
            colours = [halved(c) for c in colours]
            means = [c.reshape(-1, 3) for c in colours]
            after = Asset(converted, level)
            print("    mip level %d: full rms beside the means of the colours: the asset %.2e, converted %.2e" % (
                level, rms(gloss(Asset(file, level), material)[:2], means), rms(metal(after, after.document["materials"][index], True)[:2], means)))

    def rows(self, file, index, before, theirs, ours):
        material = before.document["materials"][index]
        d, f, roughness = gloss(before, material)
        name = "%s, %s" % (file.stem, material.get("name", "material %d" % index))
        distinct, f0, share = gltf_bounds.weighted((d, f))
        best = gltf_bounds.core_optimum(distinct, f0, share)
        print("\n%s: %d texels, %d distinct\n  %-66s %10s %10s" % (name, len(d), len(share), "rms over diffuse and f0, linear", "core-only", "full"))

        def row(title, core, full):
            print("  %-66s %10.3e %10.3e" % (title, core, full), flush=True)
            return core, full

        row("optimum with f0 = .04 for dielectrics, not rounded", best, best)
        rivals_of = {bits: {} for bits in LIMITS}
        for bits, rivals in rivals_of.items():
            lowest = min(gltf_bounds.rms_of(sum(((a - b) ** 2).sum(1) for a, b in zip(pair, (distinct, f0))), share)
                         for pair in gltf_bounds.closed_form(distinct, f0, bits))
            rivals["closed form"] = row("Khronos' closed form, %d bits" % bits, lowest, lowest)
        if theirs is not None:
            twin = theirs.document["materials"][index]
            of_8_bits = row("glTF-Transform metalrough", *(rms(metal(theirs, twin, full)[:2], (d, f)) for full in (False, True)))
            for rivals in rivals_of.values():
                rivals["glTF-Transform"] = of_8_bits
        found = {}
        for (bits, readers), (asset, _) in ours.items():
            new = asset.document["materials"][index]
            found[bits, readers] = row("etendue, %d bits, --readers %s" % (bits, readers),
                                       *(rms(metal(asset, new, full)[:2], (d, f)) for full in (False, True)))
        for (bits, readers), (core, full) in found.items():
            title, rivals = "  %d bits, --readers %s: " % (bits, readers), rivals_of[bits]
            if readers == "core":
                self.figure(title + "core-only rms over the optimum", core / best if best > EXACT else core / EXACT, 1.02)
                self.figure(title + "core-only rms over the lowest of the others", core / max(min(r[0] for r in rivals.values()), EXACT), 1)
            else:
                any_file, of_bits = gltf_bounds.bounds(distinct, f0, share, LIMITS[bits], bits)
                print("    core-only rms that is possible with a full rms <= %g: %.3e, %.3f x the optimum; with %d-bit textures %.3e, %.3f x" %
                      (LIMITS[bits], any_file, any_file / max(best, EXACT), bits, of_bits, of_bits / max(best, EXACT)))
                self.figure(title + "core-only rms over what is possible", core / max(of_bits, EXACT), 1.02)
                self.figure(title + "full rms", full, LIMITS[bits])
            for rival, (other_core, other_full) in rivals.items():
                lower = other_core < core - EXACT and other_full < full - EXACT
                self.figure(title + "%s lower in both readers" % rival, int(lower), 0)
            asset, reports = ours[bits, readers]
            read = metal(asset, asset.document["materials"][index], True)
            self.figure(title + "roughness, worst in steps of a code", np.abs(read[2] - roughness).max() * (2 ** bits - 1), 0.51)
            report = next((r for r in reports if r["name"] == material.get("name", "")), None)
            if report:
                told = np.sqrt((report["full"]["diffuse"]["rms"] ** 2 + report["full"]["f0"]["rms"] ** 2) / 2)
                self.figure(title + "what the report says of it is off by", abs(told - full), 1e-6)

    def read_by_others(self):
        """Every file that was written, by `etendue info`, Khronos' validator, glTF-Transform and Blender."""
        print("\n%d files that were written" % len(self.written))
        bad = [out for out in self.written if subprocess.run([self.etendue, "info", out], capture_output=True).returncode != 0]
        self.figure("etendue info: files with errors", len(bad), 0)
        lines = [str(out) for out in self.written]
        self.count("gltf-validator", answers(HERE / "gltf_validator", "validate.js", lines), lambda row: row.get("errors") or row.get("failed"))
        rows = answers(HERE / "gltf_transform", "transform.js", [json.dumps({"file": line}) for line in lines])
        self.count("glTF-Transform", rows, lambda row: row.get("failed") or None in row["pictures"])
        if not self.blender:
            print("Blender: no --blender PYTHON with bpy, skipped")
            return
        run = subprocess.run([self.blender, HERE / "gltf_blender.py"], input="".join(line + "\n" for line in lines), capture_output=True, text=True)
        rows = [json.loads(line) for line in run.stdout.splitlines()]
        self.figure("Blender: files that it answered for", len(rows), len(lines), at_least=True)
        self.count("Blender", rows, lambda row: row.get("failed") or row["triangles"] == 0 or not row["materials"] or [0, 0] in row["pictures"])

    def count(self, program, rows, is_bad):
        if rows is None:
            print("%s: npm has not brought it (npm install in tests/acceptance/gltf_*), skipped" % program)
            return
        bad = [row for row in rows if is_bad(row)]
        self.figure("%s: files with errors" % program, len(bad), 0)
        for row in bad[:5]:
            print(row)
