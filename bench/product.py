"""Runs the product's command line and returns what it says of its work."""
import json
import os
import pathlib
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
ISOPHOTE = ROOT / "build" / "release" / "bin" / "isophote"

_known_kernels = set()


def render(scene, *options, image=None):
    """The statistics of `isophote render`, and of its process: wall clock, processor time (both in seconds), memory.

    The first render with kernels of a kind is done twice: the first time, driver and product may have to compile them.
    """
    stats = _render(scene, options, image)
    settings = {**stats["settings"], "seed": None, "max-depth": stats["settings"]["max-depth"] == "unlimited"}
    kernels = json.dumps([stats["features"], settings, stats["execution"]["specialize"], stats["execution"]["pipeline"]])
    if kernels in _known_kernels:
        return stats
    _known_kernels.add(kernels)
    return _render(scene, options, image)


def _render(scene, options, image):
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder) / "stats.json"
        image = image or pathlib.Path(folder) / "image.exr"
        command = [ISOPHOTE, "render", scene, "-o", image, "--stats", stats, "--quiet", *options]
        start = time.monotonic()
        process = subprocess.Popen([str(part) for part in command], stderr=subprocess.PIPE, text=True)
        message = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise RuntimeError(message.strip() or f"isophote ended with {process.returncode}")
        result = json.loads(stats.read_text(encoding="utf-8"))
        result["process"] = {"wall": time.monotonic() - start, "processor": usage.ru_utime + usage.ru_stime,
                             "resident_bytes": usage.ru_maxrss * 1024}
        return result


def compare(image, reference):
    """Relative mean square error of one image against another, and the means of both by channel."""
    out = subprocess.run([ISOPHOTE, "compare", image, reference, "--json"], capture_output=True, text=True, check=False)
    return json.loads(out.stdout)
