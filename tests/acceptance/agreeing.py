"""What agreement with Mitsuba means, for the acceptance scripts: every region that is judged (visible emitters are not) is within .2 % (or what
a script asks) and three standard errors, these are a quarter of that at most, `etendue validate` finds no difference, chi-squared is in [.92, 1.08]."""
import json
import math
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
    parser.add_argument("--cache", help="folder for Mitsuba's pictures, for a second run with the same scenes")
    parser.add_argument("--resume", metavar="FILE", help="append what was measured to FILE, and measure only what is not in it yet")


def validate(arguments, asset, samples, folder, max_difference="0.2%", more=()):
    """The result of `etendue validate`, or None and what went wrong. The report is left in folder/out."""
    command = [arguments.etendue, "validate", str(asset), "--json", "--quiet", "--max-diff", max_difference, "--size", arguments.size, "--spp",
               str(samples), "--seeds", "16", "--out", str(pathlib.Path(folder) / "out"), *more]
    command += ["--cache", arguments.cache] if arguments.cache else ["--no-cache"]
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


def measure(arguments, asset, folder, limit, more):
    """The figures of one configuration, with as many samples as it takes until every region's standard error is small enough, as the
    definition of an agreement asks."""
    samples = arguments.spp
    start = time.time()
    while True:
        result, problem = validate(arguments, asset, samples, folder, repr(limit), more)
        if result is None:
            return {"problem": problem}
        # Steps of sqrt(2), so that a second run asks --cache for the same pictures.
        steps = math.ceil(2 * math.log2(1.1 * max(result.get("samples_needed", 0), 1.8 * samples) / arguments.spp))
        wanted = round(arguments.spp * 2 ** (steps / 2))
        regions = judged(result)
        if result["verdict"] != "undecided" or max(r["standard_error"] for r in regions) <= limit / 4 or wanted > arguments.most:
            break
        samples = wanted
    worst = max(regions, key=lambda r: abs(r["difference"]) - 3 * r["standard_error"])
    # Chi-squared has its window over 1e4 pixels or more. Its lower end moves where Mitsuba's float32 sums or our own variance are more than
    # Mitsuba's noise, and is as wide as the pixels that hold noise, about that part of all, allow: the window's width goes as N^-1/2.
    expected, pixels = result["chi2_expected"], result["chi2_pixels"]
    width = (1 - CHI2[0]) * math.sqrt(10000 / min(10000, max(1, expected * pixels)))
    limits = [expected * max(0, 1 - width), CHI2[1]] if pixels >= 10000 else None
    return {"d": worst["difference"], "d_se": worst["standard_error"], "se": max(r["standard_error"] for r in regions),
            "chi2": result["chi2_per_pixel"], "chi2_pixels": result["chi2_pixels"], "chi2_limits": limits, "verdict": result["verdict"],
            "samples": samples, "seconds": time.time() - start}


def recorded(arguments, label):
    """What an earlier run left about `label` in the file of --resume; the last line counts."""
    found = None
    if arguments.resume and pathlib.Path(arguments.resume).exists():
        for line in pathlib.Path(arguments.resume).read_text().splitlines():
            entry = json.loads(line)
            found = entry["figures"] if entry["label"] == label else found
    return found


def agrees(arguments, label, asset, folder, limit=LIMIT, more=()):
    """Measures one configuration, or takes its figures from --resume. Prints one line."""
    figures = recorded(arguments, label)
    if figures is None:
        figures = measure(arguments, asset, folder, limit, more)
        if arguments.resume and "problem" not in figures:
            with open(arguments.resume, "a") as file:
                file.write(json.dumps({"label": label, "figures": figures}) + "\n")
    if "problem" in figures:
        print("%-34s FAILED: %s" % (label, figures["problem"]), flush=True)
        return False
    limits, chi2 = figures["chi2_limits"], figures["chi2"]
    # What is undecided with these standard errors is so for the visible emitters, which are not judged.
    shown = figures["se"] <= limit / 4 and abs(figures["d"]) <= limit + 3 * figures["d_se"]
    ok = figures["verdict"] != "differs" and shown and (limits is None or limits[0] <= chi2 <= limits[1])
    print("%-34s d %+.4f %% (SE %.4f %%; limit %.2f %% + 3 SE)  SE <= %.4f %% (limit %.3f %%)  chi2 %.3f (%s)  %-9s %6d spp %5.1f s  %s" %
          (label, 100 * figures["d"], 100 * figures["d_se"], 100 * limit, 100 * figures["se"], 25 * limit, chi2,
           "limits %.2f, %.2f" % tuple(limits) if limits else "%d pixels, too few for limits" % figures["chi2_pixels"],
           figures["verdict"], figures["samples"], figures["seconds"], "ok" if ok else "FAILED"), flush=True)
    return ok
