#!/usr/bin/env python3
"""`etendue eval`: its methods agree within the bounds that they print, whatever the processor's rounding.

    tests/cli/evaluation.py [--etendue PATH]
"""
import argparse
import csv
import io
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
RIG, PUNCTUAL, POINTS = (str(HERE / "data" / name) for name in ("two_lights.rig.json", "punctual.rig.json", "points.csv"))


def rows(etendue, *more, rig=RIG):
    run = subprocess.run([etendue, "eval", rig, "--points", POINTS, "-q", *more], capture_output=True, text=True, check=True)
    return list(csv.DictReader(io.StringIO(run.stdout)))


def apart(a, b):
    return max(abs(float(a[c]) - float(b[c])) for c in "rgb")


def agree(name, a, b):
    assert len(a) == len(b) > 0
    failed = [(x, y) for x, y in zip(a, b) if x["light"] != y["light"] or apart(x, y) > float(x["bound"]) + float(y["bound"])]
    for pair in failed:
        print("%s: %s and %s" % ((name,) + pair))
    return not failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=str(HERE.parents[1] / "build/release/etendue"))
    etendue = parser.parse_args().etendue
    exact = rows(etendue)
    good = [agree("fast", exact, rows(etendue, "--method", "fast")), agree("reference", exact, rows(etendue, "--method", "reference"))]
    good.append(max(float(r["bound"]) for r in exact) < 1e-6 < max(float(r["r"]) for r in exact))
    for brdf in ("disney", "frostbite", "gltf-diffuse", "oren-nayar", "gotanda", "ggx", "standard", "principled"):
        loose, tight = (rows(etendue, "--brdf", brdf, "--roughness", "0.3", "--tolerance", t) for t in ("1e-2", "1e-7"))
        good.append(agree(brdf, loose, tight))
        good.append(any(float(r["g"]) > 0 for r in tight))
    for brdf in ("disney", "frostbite", "gltf-diffuse", "oren-nayar", "gotanda"):
        tight, fast = (rows(etendue, "--brdf", brdf, "--roughness", "0.8", *more) for more in (("--tolerance", "1e-7"), ("--method", "fast")))
        good.append(agree(brdf + " fast", tight, fast))
        good.append(all(apart(a, b) <= 1e-3 * float(a["r"]) for a, b in zip(tight, fast)) and fast[0]["method"] == "ratio")
        key = [r for r in tight if r["light"] == "key"]
        good.append(agree(brdf + " frostbite-45", key, rows(etendue, "--brdf", brdf, "--roughness", "0.8", "--lights", "key", "--method", "frostbite-45")))
    # An exact published form, and one that is off and says so.
    edges, structured = (rows(etendue, "--lights", "key", "--method", m) for m in ("hill-heitz-acos", "frostbite-12"))
    key = [r for r in exact if r["light"] == "key"]
    good += [agree("hill-heitz-acos", key, edges), agree("frostbite-12", key, structured), edges[0]["method"] == "hill-heitz-acos"]
    good.append(float(edges[0]["bound"]) < 1e-6 < float(structured[0]["bound"]))
    # A matt surface of albedo .5 under Disney's model at roughness .5 and normal view is near E / (2 pi).
    lux, disney = rows(etendue, "--sum")[0], rows(etendue, "--brdf", "disney", "--sum")[0]
    good.append(0.7 < float(disney["g"]) / (0.5 * float(lux["g"]) / 3.14159265) < 1.2)
    # A sum of floats within a tolerance: of the value, by its bound; every pair of a light and a point is accounted for.
    for tolerance in ("1e-2", "1e-3", "1e-4"):
        options = ["--sum", "--method", "fast", "--tolerance", tolerance]
        loose = rows(etendue, *options)
        good.append(agree("sum " + tolerance, loose, rows(etendue, "--sum")))
        good.append(all(float(x["bound"]) <= 1.01 * float(tolerance) * max(float(x[c]) for c in "rgb") for x in loose))
        stats = json.loads(subprocess.run([etendue, "eval", RIG, "--points", POINTS, "--json", "--stats", *options], capture_output=True, text=True,
                                          check=True).stdout)["stats"]
        good.append(stats["evaluations"] + stats["skipped_unseen"] + stats["skipped_small"] == 2 * stats["points"] > 0)
    # Lights without an area, in floats one by one and as a sum.
    punctual, quick = (rows(etendue, *more, rig=PUNCTUAL) for more in ([], ["--method", "fast"]))
    good.append(agree("punctual fast", punctual, quick))
    good.append(all(any(float(r["r"]) > 0 for r in quick if r["light"] == name) for name in ("point", "near", "spot", "line", "moon")))
    good.append(agree("punctual sum", rows(etendue, "--sum", rig=PUNCTUAL), rows(etendue, "--sum", "--method", "fast", rig=PUNCTUAL)))
    document = json.loads(subprocess.run([etendue, "eval", RIG, "--points", POINTS, "--json"], capture_output=True, text=True, check=True).stdout)
    good.append([str(r["index"]) for r in document["result"]] == [r["index"] for r in exact])
    good.append(all(apart(r, e) == 0 for r, e in zip(document["result"], exact)))
    print("%d of %d checks hold" % (sum(good), len(good)))
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main()
