#!/usr/bin/env python3
"""`etendue bench`: one row a method with its errors and its time, for every shape; errors that do not depend on the machine; a picture that names each method.

    tests/cli/bench.py [--etendue PATH]
"""
import argparse
import json
import pathlib
import subprocess
import tempfile
import xml.etree.ElementTree

HERE = pathlib.Path(__file__).resolve().parent
FIGURES = ["%s_%s" % (f, side) if f == "ns" else "error_%s_%s" % (side, f) for side in ("above", "across") for f in ("ns", "agg", "mean_rel", "p99_rel", "max_abs")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=str(HERE.parents[1] / "build/release/etendue"))
    etendue = parser.parse_args().etendue
    published = {"rect": "frostbite-12", "sphere": "karis-sphere", "disk": "frostbite-8", "tube": "frostbite-13", "line": None, "point": None}
    with tempfile.TemporaryDirectory() as folder:
        for shape, one in published.items():
            svg = pathlib.Path(folder) / (shape + ".svg")
            run = subprocess.run([etendue, "bench", shape, "--samples", "4096", "--rounds", "1", "--json", "-q", "--svg", str(svg)], capture_output=True, text=True, check=True)
            document = json.loads(run.stdout)
            assert document["schema"] == "etendue.bench/1" and document["stats"]["peak_gflops"] > 0, document
            sets = document["stats"]["peak_gflops_by_set"]
            assert all(peak > 0 for peak in sets.values()) and document["stats"]["instruction_set"] in sets, document["stats"]
            rows = {r["method"]: r for r in document["result"]}
            assert set(rows) == {"exact"} if one is None else len(rows) == len(document["result"]) > 4 and {"exact", "nodes-1", one} <= set(rows), sorted(rows)
            for row in rows.values():
                assert row["ns"] > 0 and all(row[key] >= 0 for key in FIGURES), row
                assert set(row["ns_by_set"]) == set(sets) and all(ns > 0 for by in row["ns_by_set"].values() for ns in (by["above"], by["across"])), row
                assert row["ns_by_set"][document["stats"]["instruction_set"]]["above"] == row["ns_above"], row
                assert row["kind"] in ("ours", "published") and row["shape"] == shape
            # The closed form errs by roundings, a published approximation by far more than those.
            for side in ("above", "across"):
                assert rows["exact"]["error_%s_agg" % side] < 1e-6 and rows["exact"]["error_%s_p99_rel" % side] < 1e-4, rows["exact"]
            assert one is None or rows[one]["error_across_agg"] > 0.05, rows[one]
            texts = {t.text for t in xml.etree.ElementTree.parse(svg).getroot().iter("{http://www.w3.org/2000/svg}text")}
            assert {"exact", one or "exact"} <= texts, texts
        # Lobes: in vectors ours, one by one the others; the forms with vectors err as their doubles do.
        svg = pathlib.Path(folder) / "ggx.svg"
        run = subprocess.run([etendue, "bench", "rect", "--brdf", "ggx", "--f0", ".04", "--alpha", ".1,.5", "--samples", "4096", "--rounds", "1", "--json", "-q", "--svg", str(svg)], capture_output=True, text=True, check=True)
        rows = {r["method"]: r for r in json.loads(run.stdout)["result"]}
        assert {m for m, r in rows.items() if r["in_vectors"]} == {"ltc", "ltc-one-cosine", "ltc-two-lobes", "ltc-two-cosines", "moments", "punctual", "covered-lobe", "covered-strip", "covered-footprint", "drobot-1-20-mended", "drobot-1-20-fitted", "frostbite-point", "frostbite-16", "eden-rect", "karis-billboard"} and "drobot-1-20" in rows and "adaptive 1e-3" in rows, sorted(rows)
        assert rows["ltc"]["over_ltc_rect_above"] > 0 and "over_ltc_rect_above" not in rows["drobot-1-20"], rows["ltc"]
        for side in ("above", "across"):
            assert rows["moments"]["error_%s_agg" % side] < 0.06 < rows["ltc"]["error_%s_agg" % side] < 0.4, side
            assert rows["adaptive 1e-3"]["error_%s_agg" % side] < 1e-3, side
        texts = {t.text for t in xml.etree.ElementTree.parse(svg).getroot().iter("{http://www.w3.org/2000/svg}text")}
        assert {"moments", "ltc", "drobot-1-20"} <= texts, texts
        for wrong in (["line", "--brdf", "ggx"], ["rect", "--f0", ".04"]):
            assert subprocess.run([etendue, "bench", *wrong], capture_output=True).returncode == 2, wrong


if __name__ == "__main__":
    main()
