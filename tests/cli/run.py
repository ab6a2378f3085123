#!/usr/bin/env python3
"""Golden tests of the command. tests/cli/cases/NAME.case holds a shell-like command line a line (no shell runs it); what it must print and
how it must end stand in tests/golden/cli/NAME.txt.

    tests/cli/run.py [--etendue PATH] [--update] [NAME ...]

In a case: `$T` is a fresh folder, `$D` is tests/cli/data. In the output, both and times are replaced by their names.
"""
import argparse
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
            run = subprocess.run([etendue] + words, capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
            report.append("$ etendue %s\n%s%s[exit %d]\n" % (line, run.stdout, "".join("! " + e + "\n" for e in run.stderr.splitlines()), run.returncode))
        text = "\n".join(report)
        for name, value in names.items():
            text = text.replace(value, name)
    return re.sub(r"\d+\.\d+ s\b|(?<=\"seconds\": )[-+.e\d]+", "TIME", text)


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
        elif not golden.exists() or golden.read_text() != text:
            failed += 1
            expected = golden.read_text().splitlines() if golden.exists() else ["(no golden file)"]
            found = text.splitlines()
            print("%s differs from %s:" % (case.name, golden.relative_to(HERE.parents[1])))
            for i in range(max(len(expected), len(found))):
                e, f = (lines[i] if i < len(lines) else "(nothing)" for lines in (expected, found))
                if e != f:
                    print("  line %d\n    expected %s\n    found    %s" % (i + 1, e, f))
                    break
    print("%d cases, %d failed" % (len(cases), failed))
    sys.exit(1 if failed or not cases else 0)


if __name__ == "__main__":
    main()
