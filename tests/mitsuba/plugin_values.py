#!/usr/bin/env python3
"""What our plugins' BSDFs evaluate to inside Mitsuba, BRDF times cosine and density, at random configurations, as CSV.

    DRJIT_LIBLLVM_PATH=... .venv/bin/python tests/mitsuba/plugin_values.py PLUGINS MODEL MATERIALS DIRECTIONS SEED

PLUGINS is exporters/mitsuba/surface_bsdfs.py. A line: the model's parameters (colours as three numbers); the view and the light,
float32 written out in full; the three channels; the density. Half of the light directions are uniform over the hemisphere, half are
chosen by the BSDF.
"""
import runpy
import sys

import drjit as dr
import mitsuba as mi
import numpy as np

MODELS = {"etendue_standard": ("base_colour", "metal", "roughness", "reflectance"),
          "etendue_metal_rough": ("base_colour", "metallic", "roughness", "ior"),
          "etendue_specular_glossiness": ("diffuse", "specular", "glossiness")}
COLOURS = ("base_colour", "diffuse", "specular")


def random_parameter(rng, name):
    if name in COLOURS:
        return [float(np.float32(x)) for x in rng.random(3)]
    if name in ("metal", "metallic"):
        return float(np.float32(rng.choice([0, 1, rng.random()])))
    if name == "ior":
        return float(np.float32(rng.uniform(1.1, 2.4)))
    return float(np.float32(rng.choice([0, 1, rng.random(), rng.random(), rng.random()])))


def hemisphere(rng, count):
    z, phi = rng.uniform(0.02, 1, count), rng.uniform(0, 2 * np.pi, count)
    r = np.sqrt(1 - z * z)
    return np.array([r * np.cos(phi), r * np.sin(phi), z], dtype=np.float32)


def main():
    plugins, model, materials, directions, seed = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:6])
    mi.set_variant("llvm_ad_rgb")
    runpy.run_path(plugins)["register_surface_bsdfs"](mi)
    rng, context = np.random.default_rng(seed), mi.BSDFContext()
    for _ in range(materials):
        parameters = {name: random_parameter(rng, name) for name in MODELS[model]}
        bsdf = mi.load_dict({"type": model, **{n: {"type": "rgb", "value": p} if n in COLOURS else p for n, p in parameters.items()}})
        told = [x for p in parameters.values() for x in (p if isinstance(p, list) else [p])]
        si = dr.zeros(mi.SurfaceInteraction3f, directions)
        si.wi = mi.Vector3f(hemisphere(rng, directions))
        chosen, _ = bsdf.sample(context, si, mi.Float(rng.random(directions)), mi.Point2f(rng.random((2, directions))))
        uniform = mi.Vector3f(hemisphere(rng, directions))
        light = dr.select((dr.arange(mi.UInt32, directions) % 2 == 0) & (chosen.wo.z > 0.01), chosen.wo, uniform)
        value, pdf = bsdf.eval_pdf(context, si, light)
        for row in zip(*(np.array(a, dtype=np.float64) for a in (*si.wi, *light, *value, pdf))):
            print(",".join(repr(float(x)) for x in (*told, *row)))


main()
