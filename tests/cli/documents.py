#!/usr/bin/env python3
"""The console blocks of sdk/docs: each `$ etendue ...` line is run from the project's folder, and must print what follows it there.

    tests/cli/documents.py [--etendue PATH]
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys

import run

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def examples(document):
    """(command, the lines it prints) of every console block."""
    for block in BLOCK.findall(document.read_text()):
        for example in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, *output = example.splitlines()
            yield command, output


def printed(command, etendue):
    words = shlex.split(command)
    assert words[0] == "etendue", command
    stdin = subprocess.DEVNULL
    if words[-2] == "<":
        stdin, words = open(ROOT / words[-1]), words[:-2]
    done = subprocess.run([etendue, *words[1:]], capture_output=True, text=True, timeout=120, stdin=stdin, cwd=ROOT)
    return (done.stdout + done.stderr).splitlines()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=str(ROOT / "build/release/etendue"))
    etendue = parser.parse_args().etendue
    done = failed = 0
    for document in sorted((ROOT / "sdk/docs").glob("*.md")):
        for command, expected in examples(document):
            done += 1
            found = printed(command, etendue)
            if len(expected) != len(found) or not all(map(run.same, expected, found)):
                failed += 1
                print("%s: $ %s\n  expected:\n    %s\n  found:\n    %s" % (document.name, command, "\n    ".join(expected), "\n    ".join(found)))
    print("%d examples, %d failed" % (done, failed))
    sys.exit(1 if failed or not done else 0)


if __name__ == "__main__":
    main()
