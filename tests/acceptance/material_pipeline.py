"""Parts of tests/acceptance/materials that run the command over files: the pipeline's time and memory, and how calm the metal mask is."""
import json
import os
import pathlib
import subprocess
import tempfile
import time

SECONDS_A_MEGATEXEL, BYTES = 0.15, 1e9
CORES = 2


def document(folder):
    """A glTF file of one material with diffuse.png and specular.png beside it."""
    extension = "KHR_materials_pbrSpecularGlossiness"
    material = {"extensions": {extension: {"diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 1}}}}
    images = [{"uri": "diffuse.png"}, {"uri": "specular.png"}]
    textures = [{"source": 0}, {"source": 1}]
    content = {"asset": {"version": "2.0"}, "extensionsUsed": [extension], "images": images, "textures": textures, "materials": [material]}
    file = pathlib.Path(folder) / "pair.gltf"
    file.write_text(json.dumps(content))
    return file


def measured(command):
    """Seconds on at most CORES cores, processor seconds and bytes of memory at the most."""
    cores = sorted(os.sched_getaffinity(0))[:CORES]
    begin = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.PIPE, preexec_fn=lambda: os.sched_setaffinity(0, cores))
    output = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    seconds = time.perf_counter() - begin
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise SystemExit("%s: exit status %d: %s" % (" ".join(map(str, command)), child.returncode, output.decode()))
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024.0


def pipeline(build, options, figure):
    """Avocado's pictures tiled with some noise, at equal and unequal sizes, and nothing but noise, which has no limit for its time."""
    avocado = sorted(options.corpus.rglob("glTF-pbrSpecularGlossiness/Avocado_diffuse.png"))
    cases = [("noise", 2048, 2048), ("noise", 4096, 1024)]
    if avocado:
        cases += [("tiles", 4096, 4096), ("tiles", 4096, 1024)] + [("tiles", 16384, 16384), ("tiles", 16384, 4096)] * options.large
    else:
        print("pipeline: no Avocado under %s: noise alone" % options.corpus)
    for kind, diffuse, specular in cases:
        with tempfile.TemporaryDirectory(dir=options.scratch) as folder:
            words = [kind]
            if kind == "tiles":
                words += [avocado[0], avocado[0].with_name("Avocado_specularGlossiness.png")]
            subprocess.run([build / "tests/acceptance/material_pictures", folder, str(diffuse), str(specular), *words], check=True)
            command = [build / "etendue", "convert", document(folder), pathlib.Path(folder) / "new/pair.gltf"]
            (pathlib.Path(folder) / "new").mkdir()
            seconds, processor, most = measured([*command, "--materials", "metal-rough"])
        name = "%s, %d and %d wide: " % (kind, diffuse, specular)
        megatexels = diffuse * diffuse / 1e6
        text = name + "seconds a megatexel, %d cores (%.3f of processor)" % (CORES, processor / megatexels)
        if kind == "tiles":
            figure(text, seconds / megatexels, SECONDS_A_MEGATEXEL)
        else:
            print("%-86s %10.3g" % (text, seconds / megatexels), flush=True)
        figure(name + "bytes of memory at the most", most, BYTES)


def calm(build, options, figure):
    """The mean difference of the metal mask between neighbouring texels, over that of each texel's own best mask; and below what no choice of
    masks within the texels' limits can bring it, by the gaps between neighbours' intervals."""
    files = sorted(path for path in options.corpus.rglob("*.gltf") if b"KHR_materials_pbrSpecularGlossiness" in path.read_bytes())
    if not files:
        print("calm: no specular-glossiness asset under %s, skipped" % options.corpus)
        return
    with tempfile.TemporaryDirectory(dir=options.scratch) as folder:
        words = [build / "tests/acceptance/material_mask_play", folder, *files]
        lines = subprocess.run(words, stdout=subprocess.PIPE, check=True, text=True).stdout.splitlines()
    for row in map(json.loads, lines):
        best = row["told_best"]
        name = "%s, %s: " % (pathlib.Path(row["file"]).stem, row["material"])
        figure(name + "the mask's variation, over %.2e" % best, row["stored"] / best, 1)
        print("  %-84s %10.3g" % ("what no masks within the limits can go below", row["least"] / best))
        print("  %-84s %10.3g" % ("share of texels with more than one such mask", row["with_play"]), flush=True)
