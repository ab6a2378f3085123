#!/usr/bin/env python3
"""The drawings of `etendue ies`: each is XML that a browser takes, and its lines lie where the light says.

    tests/cli/diagrams.py [--etendue PATH]
"""
import argparse
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
SVG = "{http://www.w3.org/2000/svg}"
failures = []


def expect(what, holds):
    if not holds:
        failures.append(what)


def isotropic(path, candela):
    path.write_text("IESNA:LM-63-2002\n[TEST] <isotropic> & \"all\"\n[LUMINAIRE] <isotropic> & \"all\"\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n%g %g %g\n" % ((candela,) * 3))


def points_of(d):
    return [tuple(map(float, pair.split())) for pair in re.findall(r"[ML]([-\d.]+ [-\d.]+)", d)]


def draw(etendue, source, out, *options):
    done = subprocess.run([etendue, "ies", str(source), "--svg", str(out), "-q", *options], capture_output=True, text=True, timeout=60)
    expect("%s %s: exit %d %s" % (source.name, " ".join(options), done.returncode, done.stderr[:200]), done.returncode == 0)
    text = out.read_text()
    expect("no number that is not one in %s" % out.name, not re.search(r"\b(nan|inf)\b", text))
    return xml.etree.ElementTree.fromstring(text)


def polar_is_a_circle(etendue, lamp, folder):
    """Isotropic light is a circle about the light, as large as its intensity of the outermost circle: 800 of 800 cd."""
    tree = draw(etendue, lamp, folder / "polar.svg")
    curves = [p for p in tree.iter(SVG + "path") if p.get("class") in ("a", "b dash")]
    expect("two curves", len(curves) == 2)
    for curve in curves:
        points = points_of(curve.get("d"))
        middle = (min(x for x, _ in points) + max(x for x, _ in points)) / 2, (min(y for _, y in points) + max(y for _, y in points)) / 2
        radii = [math.hypot(x - middle[0], y - middle[1]) for x, y in points]
        # Coordinates have one decimal: half of one each way, at the middle too.
        expect("polar circle of radius %g to %g" % (min(radii), max(radii)), max(radii) - min(radii) < 0.3 and abs(max(radii) - 250) < 0.3)


def isolux_lines_are_circles(etendue, lamp, folder):
    """E = I d / r^3: around isotropic light of 800 cd at 3 m each line of a level is a circle of that radius."""
    tree = draw(etendue, lamp, folder / "isolux.svg", "--diagram", "isolux", "--plane", "3 m")
    lines = [p for p in tree.iter(SVG + "path") if p.get("fill") == "none"]
    frame = [r for r in tree.iter(SVG + "rect") if r.get("class") == "axis"][0]
    left, top, side = (float(frame.get(k)) for k in ("x", "y", "width"))
    axis = [float(t.text) for t in tree.iter(SVG + "text") if t.get("text-anchor") == "middle" and t.get("class") == "soft"]
    positions = [float(t.get("x")) for t in tree.iter(SVG + "text") if t.get("text-anchor") == "middle" and t.get("class") == "soft"]
    metres_a_unit = (axis[-1] - axis[0]) / (positions[-1] - positions[0])
    largest = 800 / 9
    levels = sorted((step * 10 ** decade for decade in range(-8, 4) for step in (1, 2, 5) if step * 10 ** decade < 0.95 * largest), reverse=True)[:8][::-1]
    expect("eight lines", len(lines) == 8)
    checked = 0
    for level, line in zip(levels, lines):
        radius = math.sqrt((800 * 3 / level) ** (2 / 3) - 9)
        for x, y in points_of(line.get("d")):
            if not (left + 1 < x < left + side - 1 and top + 1 < y < top + side - 1):
                continue  # the frame cuts the line
            found = metres_a_unit * math.hypot(x - left - side / 2, y - top - side / 2)
            # The grid has 200 cells of 3 units; linear within them errs by an eighth of the bend, far below a tenth of a cell.
            expect("%g lx at %g m instead of %g" % (level, found, radius), abs(found - radius) < 0.35 * metres_a_unit)
            checked += 1
    expect("points on the lines", checked > 500)


def colours_follow_the_reader(etendue, lamp, folder):
    for name in ("polar", "cartesian", "web", "isolux"):
        tree = draw(etendue, lamp, folder / (name + ".svg"), "--diagram", name)
        style = tree.find(SVG + "style").text
        expect("%s has dark colours" % name, "prefers-color-scheme:dark" in style)
        titles = [t.text for t in tree.iter(SVG + "text")]
        expect("%s has its title" % name, '<isotropic> & "all"' in titles)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--etendue", default=str(ROOT / "build/release/etendue"))
    etendue = parser.parse_args().etendue
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        lamp = folder / "lamp.ies"
        isotropic(lamp, 800)
        polar_is_a_circle(etendue, lamp, folder)
        isolux_lines_are_circles(etendue, lamp, folder)
        colours_follow_the_reader(etendue, lamp, folder)
        for data in ("flood.ies", "panel.ldt"):
            for diagram in ("polar", "cartesian", "web", "isolux"):
                draw(etendue, ROOT / "tests/cli/data" / data, folder / "x.svg", "--diagram", diagram)
        isotropic(lamp, 0)
        for diagram in ("polar", "cartesian", "web", "isolux"):
            draw(etendue, lamp, folder / "dark.svg", "--diagram", diagram)
    print("\n".join(failures[:20]) or "all drawings as they should be")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
