#!/usr/bin/env python3
"""The benchmarks' report computes what it says, and their scenes can be read.

usage: bench_report_test.py ISOPHOTE
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bench"))
import growth_scenes  # noqa: E402
from plot import log_log_svg  # noqa: E402

ISOPHOTE = sys.argv.pop(1)


def equal_error(scene, renderer, seconds, error):
    return {"measured": "equal_error", "scene": scene, "renderer": renderer, "pixels": 1000, "spp": 100,
            "seconds": seconds, "relMSE": error}


def rays(scene, generation, ratio):
    entry = {"embree8": {"median": ratio, "low": ratio, "high": ratio}}
    return {"scene": scene, "rays_of": generation, "driver": "a driver", "mrays_per_s": {"isophote": 1},
            "speed_relative_to": entry}


class Report(unittest.TestCase):
    def test_ratios_and_means(self):
        lines = [
            equal_error("cornell-box", "isophote", 2, 0.1), equal_error("cornell-box", "cycles", 1, 0.8),  # 4 times
            equal_error("demo", "isophote", 1, 0.2), equal_error("demo", "cycles", 2, 0.1),  # once
            equal_error("cornell-box", "isophote-joint", 2, 0.2), equal_error("demo", "isophote-joint", 1, 0.4),  # half
            rays("room-1", "bounce1", 0.25), rays("room-2", "bounce2", 1.0), rays("helmet", "bounce1", 9.0),
            {"measured": "specialization", "scene": "cornell-box", "seconds": {"specialized": 2, "all_features": 3}},
            {"measured": "bvh_build", "build": "fast-trace", "triangles": 3000000, "seconds": 2.5},
            {"measured": "bvh_build", "build": "fast-build", "triangles": 3000000, "seconds": 0.5},
            {"measured": "whole_image", "scene": "demo", "pipeline": "wavefront", "in_use": "wavefront", "busy": 0.8,
             "outside_kernels": 0.1, "seconds": 4},
            {"measured": "whole_image", "scene": "demo", "pipeline": "auto", "in_use": "fused", "busy": 0.9,
             "outside_kernels": None, "seconds": 3},
        ]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "lines.jsonl"
            file.write_text("\n".join(map(json.dumps, lines)), encoding="utf-8")
            text = subprocess.run([ROOT / "bench" / "report", file], check=True, capture_output=True, text=True).stdout
        for end in ("geometric mean | 0.5 [1] | 0.50 |", "of 2 scenes, sampler=sobol | 0.7 [2] | 2.00 |",
                    "of 2 scenes, sampler=sobol-joint | 0.7 [2] | 1.00 |", "| demo | sampler=sobol-joint | 1 | 0.4 | 0.10 | 0.50 |",
                    "Cycles | 0.8 [1.75] | 0.50 |",
                    "cornell-box | 1.3 | 1.50 (1.50 to 1.50) |", "BVH of 3,000,000 triangles | 3 s | 2.50 s |",
                    "fast build of 3,000,000 triangles | 0.6 s | 0.50 s |",
                    "least of the scenes | 95% | 90% |", "most of the scenes, wavefront | 15% [8%] | 10% |",
                    "| auto: fused | 3.00 | 90% | all in one kernel |"):
            self.assertIn(end, text)

    def test_plots_are_xml_with_a_mark_for_each_point(self):
        svg = log_log_svg({"a": [(1, 0.5), (1000, 20)], "none": [(1, 0)]}, "x & y", "seconds")
        marks = xml.dom.minidom.parseString(svg).getElementsByTagName("circle")
        self.assertEqual([round(float(mark.getAttribute("cx"))) for mark in marks], [64, 430])


class Scenes(unittest.TestCase):
    def test_each_can_be_read(self):
        for name in ("triangles", "lights", "instances", "nodes", "textures"):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder) / "scene.glb"
                getattr(growth_scenes, name)(9).write_glb(file)
                info = subprocess.run([ISOPHOTE, "info", file], capture_output=True, text=True, check=False)
                self.assertEqual((info.returncode, info.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
