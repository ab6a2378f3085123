"""What agreement with Mitsuba means, for the acceptance scripts: `etendue validate` says `same` at .2 %, with a standard error of at most
.05 % in every region that is judged and chi-squared in [.92, 1.08]."""
import json
import pathlib
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIMIT, CHI2 = 0.002, (0.92, 1.08)


def add_options(parser, spp=4096):
    parser.add_argument("--etendue", default=str(ROOT / "build/release/etendue"))
    parser.add_argument("--size", default="128x128")
    parser.add_argument("--spp", type=int, default=spp, help="samples per pixel to begin with")
    parser.add_argument("--most", type=int, default=65536, help="samples per pixel that are not exceeded; an undecided comparison fails")


def validate(arguments, asset, samples, folder, max_difference="0.2%", more=()):
    """The result of `etendue validate`, or None and what went wrong. The report is left in folder/out."""
    command = [arguments.etendue, "validate", str(asset), "--json", "--quiet", "--max-diff", max_difference, "--size", arguments.size, "--spp",
               str(samples), "--seeds", "16", "--out", str(pathlib.Path(folder) / "out"), "--no-cache", *more]
    run = subprocess.run(command, capture_output=True, text=True)
    try:
        document = json.loads(run.stdout)
    except ValueError:
        return None, run.stderr.strip()[-300:]
    if "result" not in document or document["result"] is None:
        return None, "; ".join(d["text"] for d in document["diagnostics"])[-300:]
    return document["result"], ""


def judged(result):
    """The regions that the verdict stands on: not too dark, and not judged as part of a larger one; emitters are listed, not judged here."""
    return [r for r in result["regions"] if not r.get("left_out") and not r["merged"] and r["region"] != "visible emitters"]


def agrees(arguments, label, asset, folder):
    """Takes more samples until every region's standard error is small enough, as the definition of an agreement asks. Prints one line."""
    samples = arguments.spp
    start = time.time()
    while True:
        result, problem = validate(arguments, asset, samples, folder)
        if result is None:
            print("%-34s FAILED: %s" % (label, problem), flush=True)
            return False
        if result["verdict"] != "undecided" or 4 * samples > arguments.most:
            break
        samples *= 4
    regions = judged(result)
    worst = max(regions, key=lambda r: abs(r["difference"]) - 3 * r["standard_error"])
    widest = max(r["standard_error"] for r in regions)
    # Chi-squared has its window over 1e4 pixels or more; the lower end moves where Mitsuba's float32 sums are more than its noise.
    counted = result["chi2_pixels"] >= 10000
    low, high = CHI2[0] * result["chi2_expected"], CHI2[1]
    ok = result["verdict"] == "same" and (not counted or low <= result["chi2_per_pixel"] <= high)
    print("%-34s d %+.4f %% (SE %.4f %%; limit %.2f %% + 3 SE)  SE <= %.4f %% (limit .05 %%)  chi2 %.3f (%s)  %-9s %6d spp %5.1f s  %s" %
          (label, 100 * worst["difference"], 100 * worst["standard_error"], 100 * LIMIT, 100 * widest, result["chi2_per_pixel"],
           "limits %.2f, %.2f" % (low, high) if counted else "%d pixels, too few for limits" % result["chi2_pixels"],
           result["verdict"], samples, time.time() - start, "ok" if ok else "FAILED"), flush=True)
    return ok
