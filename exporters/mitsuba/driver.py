"""Renders scenes in one Mitsuba process: driver.py REQUEST.json

Request: {"variant", "jobs": [{"scene", "samples", "seeds", "first_seed", "out"}]}. `out` becomes float32 numbers, row by row: mean and
variance of the mean over the seeds, six a pixel. Lines that begin with "@etendue " are for the caller.
"""

import json
import os
import sys
import threading


def tell(**message):
    print("@etendue " + json.dumps(message), flush=True)


def end_with_parent():
    """The caller holds the other end of standard input: end of file means that it is gone."""
    while os.read(0, 1):
        pass
    os._exit(1)


def probe(mi, dr, variant):
    mi.set_variant(variant)
    if variant.startswith("llvm"):
        dr.eval(mi.Float([1, 2]) + 1)
    tell(version=mi.__version__)


class Progress:
    def __init__(self, total):
        self.done, self.total = 0, total

    def add(self, samples, job):
        self.done += samples
        tell(done=self.done, total=self.total, job=job)


def passes_of(pixels, samples):
    """Samples of each pass, so that a wavefront (which holds every sample of a pass in memory) has at most 2^23 of them."""
    most = max(1, (1 << 23) // pixels)
    count = -(-samples // most)
    return [samples // count + (i < samples % count) for i in range(count)]


def integrator_for(mi, scene):
    """`direct` where the scene has `path` of depth 2: the same estimator (light and BSDF sampled once each, power heuristic), from the same
    random numbers in the same order, without path's loop and so a quarter faster."""
    own = scene.integrator()
    described = str(own)
    two_deep = described.startswith("PathIntegrator") and "max_depth = 2," in described
    return mi.load_dict({"type": "direct"}) if two_deep else own


def render(mi, np, job, progress, index):
    samples, seeds = job["samples"], job["seeds"]
    scene = mi.load_file(job["scene"], spp=str(samples), seed=str(job["first_seed"]))
    integrator = integrator_for(mi, scene)
    width, height = (int(n) for n in scene.sensors()[0].film().crop_size())
    passes = passes_of(width * height, samples)
    mean = np.zeros((height, width, 3))
    squares = np.zeros_like(mean)
    for k in range(seeds):
        picture = np.zeros_like(mean)
        for p, count in enumerate(passes):
            seed = (job["first_seed"] + (k << 12) + p) % 2**32
            picture += np.array(mi.render(scene, integrator=integrator, spp=count, seed=seed), dtype=np.float64)[:, :, :3] * (count / samples)
            progress.add(count, index)
        delta = picture - mean
        mean += delta / (k + 1)
        squares += delta * (picture - mean)
    variance = squares / max(seeds - 1, 1) / seeds
    np.concatenate([mean, variance], axis=2).astype("<f4").tofile(job["out"])
    tell(finished=index, width=width, height=height)


def main(request):
    import drjit as dr
    import mitsuba as mi

    if "probe" in request:
        probe(mi, dr, request["probe"])
        return
    import numpy as np

    mi.set_variant(request["variant"])
    mi.set_log_level(mi.LogLevel.Error)
    if not request["variant"].startswith("scalar"):
        # Their files stand before this one.
        register_surface_bsdfs(mi)  # noqa: F821
        register_emitters(mi)  # noqa: F821
    jobs = request["jobs"]
    progress = Progress(sum(job["samples"] * job["seeds"] for job in jobs))
    for index, job in enumerate(jobs):
        try:
            render(mi, np, job, progress, index)
        except Exception as error:  # whatever it is, the caller shows it
            tell(error=str(error), job=index)
            sys.exit(1)


threading.Thread(target=end_with_parent, daemon=True).start()
main(json.loads(sys.argv[1]) if sys.argv[1].startswith("{") else json.load(open(sys.argv[1], encoding="utf-8")))
