"""The library can be used from outside: installed, and as a subdirectory.

usage: consumer_test.py installed|subdirectory BUILD_FOLDER WORK_FOLDER [cmake options]

Builds the README's example with it and renders 8 x 8 pixels of a panel that fills the view with radiance 0.5.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts"))
from asset_maker.gltf import Gltf  # noqa: E402
from asset_maker.shapes import quad  # noqa: E402


def write_panel(file):
    gltf = Gltf("A panel of radiance 0.5 that fills the view")
    shape = gltf.shape(quad((-9.0, -9.0, 0.0), (9.0, -9.0, 0.0), (9.0, 9.0, 0.0), (-9.0, 9.0, 0.0)))
    gltf.node(gltf.mesh("panel", shape, gltf.emitter("panel", (0.5, 0.5, 0.5))))
    gltf.camera("camera", (0.0, 0.0, 2.0), (0.0, 0.0, 0.0), 1.0, 1.0)
    gltf.write_gltf(file)


def call(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{command} failed with {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return done.stdout


class Consumer(unittest.TestCase):
    def test_builds_and_renders_the_right_mean(self):
        options = list(OPTIONS)
        if HOW == "installed":
            prefix = WORK / "prefix"
            shutil.rmtree(prefix, ignore_errors=True)
            call("cmake", "--install", BUILD, "--prefix", prefix)
            options.append(f"-DCMAKE_PREFIX_PATH={prefix}")
        else:
            options.append(f"-DISOPHOTE_SOURCE={ROOT}")
        call("cmake", "-S", HERE, "-B", WORK / "build", "-G", "Ninja", *options)
        call("cmake", "--build", WORK / "build", "--parallel", "2")
        example = next(path for path in (WORK / "build" / "example", WORK / "build" / "bin" / "example") if path.exists())
        panel, image = WORK / "panel.gltf", WORK / "panel.exr"
        write_panel(panel)
        image.unlink(missing_ok=True)
        printed = call(example, panel, image, 8)
        self.assertAlmostEqual(float(re.fullmatch(r"mean red (\S+)\n", printed)[1]), 0.5, delta=1e-6)
        self.assertGreater(image.stat().st_size, 8 * 8 * 3 * 4)

    def test_readme_shows_this_example(self):
        self.assertIn("```cpp\n" + (HERE / "example.cpp").read_text(encoding="utf-8") + "```\n",
                      (ROOT / "README.md").read_text(encoding="utf-8"))


if __name__ == "__main__":
    HOW, BUILD, WORK, *OPTIONS = sys.argv[1:]
    WORK = pathlib.Path(WORK)
    WORK.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=sys.argv[:1])
