#!/usr/bin/env python3
"""Golden tests of the command. tests/cli/cases/NAME.case holds a shell-like command line a line (no shell runs it); what it must print and
how it must end stand in tests/golden/cli/NAME.txt.

    tests/cli/run.py [--etendue PATH] [--update] [NAME ...]

In a case: `$T` is a fresh folder, `$D` is tests/cli/data; `< FILE` at the end of a line is its stdin. In the output, both and times are replaced by their names. Numbers in full precision
(15 digits and more) may differ by 64 units in the last place of a double: exp, log and pow round differently with and without fused multiply-add.
"""
import argparse
import itertools
import math
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
GOLDEN = HERE.parent / "golden" / "cli"


def run_case(case, etendue):
    report = []
    with tempfile.TemporaryDirectory() as folder:
        names = {"$T": folder, "$D": str(HERE / "data")}
        for line in case.read_text().splitlines():
            if not line.strip() or line.startswith("#"):
                continue
            words = shlex.split(line)
            for name, value in names.items():
                words = [word.replace(name, value) for word in words]
            stdin = subprocess.DEVNULL
            if len(words) > 2 and words[-2] == "<":
                stdin, words = open(words[-1]), words[:-2]
            run = subprocess.run([etendue] + words, capture_output=True, text=True, timeout=120, stdin=stdin)
            report.append("$ etendue %s\n%s%s[exit %d]\n" % (line, run.stdout, "".join("! " + e + "\n" for e in run.stderr.splitlines()), run.returncode))
        text = "\n".join(report)
        for name, value in names.items():
            text = text.replace(value, name)
    return re.sub(r"\d+\.\d+ s\b|(?<=\"seconds\": )[-+.e\d]+", "TIME", text)


FULL_PRECISION = re.compile(r"-?\d*\.?\d+(?:e[-+]?\d+)?")


def same(expected, found):
    """Whether two lines differ at most in the last places of numbers in full precision."""
    if expected == found:
        return True
    if FULL_PRECISION.sub("#", expected) != FULL_PRECISION.sub("#", found):
        return False
    for e, f in zip(FULL_PRECISION.findall(expected), FULL_PRECISION.findall(found)):
        if e == f:
            continue
        # The shortest text of a neighbouring double may be shorter.
        if max(sum(c.isdigit() for c in n.split("e")[0].lstrip("-0.")) for n in (e, f)) < 15:
            return False
        if abs(float(e) - float(f)) > 64 * math.ulp(float(e)):
            return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=str(HERE.parents[1] / "build/release/etendue"))
    parser.add_argument("--update", action="store_true", help="write the golden files anew")
    parser.add_argument("names", nargs="*")
    arguments = parser.parse_args()
    cases = sorted(c for c in (HERE / "cases").glob("*.case") if not arguments.names or c.stem in arguments.names)
    failed = 0
    for case in cases:
        text, golden = run_case(case, arguments.etendue), GOLDEN / (case.stem + ".txt")
        if arguments.update:
            GOLDEN.mkdir(parents=True, exist_ok=True)
            golden.write_text(text)
            continue
        expected, found = golden.read_text().splitlines() if golden.exists() else ["(no golden file)"], text.splitlines()
        for i, (e, f) in enumerate(itertools.zip_longest(expected, found, fillvalue="(nothing)")):
            if not same(e, f):
                failed += 1
                print("%s differs from %s:" % (case.name, golden.relative_to(HERE.parents[1])))
                print("  line %d\n    expected %s\n    found    %s" % (i + 1, e, f))
                break
    print("%d cases, %d failed" % (len(cases), failed))
    sys.exit(1 if failed or not cases else 0)


if __name__ == "__main__":
    main()
