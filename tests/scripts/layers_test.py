"""scripts/check_layers.py accepts this tree and finds planted upward includes."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def check(root):
    done = subprocess.run([sys.executable, ROOT / "scripts" / "check_layers.py", root], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


class Layers(unittest.TestCase):
    def test_no_include_of_this_tree_points_up(self):
        self.assertEqual(check(ROOT), (0, ""))

    def test_planted_includes_that_point_up_are_found(self):
        planted = [
            ("engine/src/scene/a.cpp", '#include "upload/pack_scene.hpp"'),
            ("engine/src/scene/a.cpp", '#include "accel/bvh.hpp"'),
            ("engine/src/io/a.cpp", '#include "isophote/film.hpp"'),
            ("engine/src/accel/a.cpp", "#include <vulkan/vulkan.h>"),
            ("engine/src/upload/a.hpp", '#include "render/path_pool.hpp"'),
            ("engine/src/estimate/a.cpp", '#include "gpu/buffer.hpp"'),
            ("engine/src/render/a.cpp", "#include <stb_image.h>"),
            ("engine/src/render/a.cpp", "#include <OpenEXR/ImfChannelList.h>"),
            ("engine/src/misc/a.cpp", "#include <vector>"),
            ("engine/include/isophote/a.hpp", '#include "gpu/buffer.hpp"'),
            ("engine/include/isophote/a.hpp", "#include <vulkan/vulkan.h>"),
            ("cli/a.cpp", '#include "render/path_pool.hpp"'),
            ("viewer/a.cpp", '#include "isophote_kernels.hpp"'),
        ]
        for path, line in planted:
            with self.subTest(path=path, line=line), tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder, path)
                file.parent.mkdir(parents=True)
                file.write_text(f"#pragma once\n{line}\n")
                code, output = check(folder)
                self.assertEqual(code, 1)
                self.assertTrue(output.startswith(f"{path}:2: "), output)

    def test_includes_that_point_down_are_accepted(self):
        allowed = [
            ("engine/src/render/a.cpp", '#include "upload/gpu_scene.hpp"\n#include "gpu/kernel.hpp"\n#include "isophote/film.hpp"'),
            ("engine/src/scene/a.cpp", '#include <stb_image.h>\n#include "isophote/image.hpp"\n#include "scene/glb.hpp"'),
            ("engine/include/isophote/device.hpp", "#include <vulkan/vulkan.h>"),
            ("viewer/a.cpp", '#include <imgui.h>\n#include "isophote/film.hpp"'),
        ]
        for path, lines in allowed:
            with self.subTest(path=path), tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder, path)
                file.parent.mkdir(parents=True)
                file.write_text(lines + "\n")
                self.assertEqual(check(folder), (0, ""))


if __name__ == "__main__":
    unittest.main()
