#!/usr/bin/env python3
"""What Mitsuba's `principled` and `roughconductor` (ggx) evaluate to, BRDF times cosine, at random configurations, as CSV.

    .venv/bin/python tests/mitsuba/brdf_values.py principled|roughconductor COUNT SEED > FILE

Inputs are rounded to float32 first, so that a reader in double evaluates the same configuration. Half of the light directions are uniform
over the hemisphere, half follow the lobe.
"""
import math
import random
import struct
import sys

import mitsuba as mi


def f32(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def hemisphere(rng, least):
    while True:
        z = rng.uniform(least, 1)
        phi = rng.uniform(0, 2 * math.pi)
        r = math.sqrt(1 - z * z)
        return [r * math.cos(phi), r * math.sin(phi), z]


def around_mirror(rng, view, alpha, least):
    """A half vector from the GGX density, and the view mirrored in it."""
    while True:
        u, phi = rng.random(), rng.uniform(0, 2 * math.pi)
        tangent = alpha * math.sqrt(u / (1 - u))
        c = 1 / math.sqrt(1 + tangent * tangent)
        h = [c * tangent * math.cos(phi), c * tangent * math.sin(phi), c]
        vh = sum(a * b for a, b in zip(view, h))
        light = [2 * vh * b - a for a, b in zip(view, h)]
        if light[2] >= least and vh > 0:
            return light


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [f32(x / length) for x in v]


def main():
    model, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    mi.set_variant("scalar_rgb")
    rng = random.Random(seed)
    names = {"principled": "base_r,base_g,base_b,metallic,roughness,specular",
             "roughconductor": "eta_r,eta_g,eta_b,k_r,k_g,k_b,alpha"}[model]
    print("# Mitsuba %s scalar_rgb, %s, seed %d" % (mi.__version__, model, seed))
    print(names + ",view_x,view_y,view_z,light_x,light_y,light_z,r,g,b")
    for i in range(count):
        if model == "principled":
            base = [f32(rng.random()) for _ in range(3)]
            metallic = f32(rng.choice([0, 1, rng.random()]))
            roughness, specular = f32(rng.uniform(0.1, 1)), f32(rng.uniform(0.05, 1.5))
            alpha, parameters = max(0.001, roughness * roughness), base + [metallic, roughness, specular]
            plugin = {"type": "principled", "base_color": {"type": "rgb", "value": base}, "metallic": metallic, "roughness": roughness,
                      "specular": specular}
        else:
            eta, k = [f32(rng.uniform(0.1, 3)) for _ in range(3)], [f32(rng.uniform(0, 6)) for _ in range(3)]
            alpha = f32(math.exp(rng.uniform(math.log(0.01), 0)))
            parameters = eta + k + [alpha]
            plugin = {"type": "roughconductor", "distribution": "ggx", "alpha": alpha, "eta": {"type": "rgb", "value": eta},
                      "k": {"type": "rgb", "value": k}}
        view = unit(hemisphere(rng, 0.02))
        light = unit(hemisphere(rng, 0.02) if i % 2 else around_mirror(rng, view, alpha, 0.02))
        bsdf = mi.load_dict(plugin)
        si = mi.SurfaceInteraction3f()
        si.wi = mi.Vector3f(*view)
        value = bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(*light))
        print(",".join(repr(float(x)) for x in parameters + view + light + list(value)))


main()
