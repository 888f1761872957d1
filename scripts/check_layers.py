#!/usr/bin/env python3
"""Fails where an include points up: the layers of docs/conventions.md, and who may use which library.

usage: scripts/check_layers.py [ROOT]   (this checkout)
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
SOURCES = ("*.cpp", "*.hpp", "*.h")

# Folders of engine/src that a folder of engine/src may include besides itself.
LOWER = {
    "scene": set(), "accel": set(), "io": set(), "gpu": set(), "denoise": set(),
    "upload": {"scene", "accel", "io", "gpu"},
    "render": {"upload", "scene", "accel", "io", "gpu"},
    "estimate": {"upload", "scene", "accel", "io"},
}
# Public headers that stand for a layer with a device; all others are plain values, free for everyone.
DEVICE_HEADERS = {
    "isophote/device.hpp": {"gpu", "upload", "render"},
    "isophote/gpu_scene.hpp": {"upload", "render"},
    "isophote/film.hpp": {"render"},
    "isophote/ray_bench.hpp": {"render"},
    "isophote/path_tracer.hpp": {"render"},
}
# Third parties that only these folders may include; tests and bench are free.
LIBRARIES = [
    (re.compile(r"OpenEXR/|Imf|Imath"), {"engine/src/io"}),
    (re.compile(r"stb_|stb/"), {"engine/src/scene", "engine/src/io"}),
    (re.compile(r"vulkan/"), {"engine/src/gpu", "engine/src/upload", "engine/src/render", "viewer"}),
    (re.compile(r"spirv-tools/"), {"engine/src/gpu"}),
    (re.compile(r"imgui|GLFW/"), {"viewer"}),
    (re.compile(r"CLI/"), {"cli", "viewer"}),
    (re.compile(r"embree"), set()),
]


def layer_error(folder, quote, target):
    """What is wrong with including `target` from `folder` (such as "engine/src/scene"), or None."""
    parts = folder.split("/")
    for library, allowed in LIBRARIES:
        if library.match(target) and folder not in allowed:
            return "is for " + (", ".join(sorted(allowed)) or "tests and bench") + " alone"
    if parts[:2] == ["engine", "src"]:
        layer = parts[2] if len(parts) > 2 else ""
        if layer not in LOWER:
            return "stands in no known layer; extend scripts/check_layers.py"
        first = target.split("/")[0]
        if first in LOWER and first != layer and first not in LOWER[layer]:
            return f"points up or sideways from {layer}"
        if layer not in DEVICE_HEADERS.get(target, {layer}):
            return f"points up from {layer}"
        if target == "isophote_kernels.hpp" and layer not in ("upload", "render"):
            return "is for upload and render alone"
    elif parts[:2] == ["engine", "include"]:
        if quote == '"' and not target.startswith("isophote/") and target != "shared/features.inc":
            return "is not public"
    elif target.split("/")[0] in LOWER or target.endswith("_kernels.hpp"):
        return "is not public"
    return None


def violations(root):
    for top in ("engine", "cli", "viewer"):
        files = sorted(file for pattern in SOURCES for file in (root / top).rglob(pattern))
        for file in files:
            path = file.relative_to(root).as_posix()
            # engine/src/LAYER, engine/include/isophote, or the top folder of a program
            depth = 3 if top == "engine" else 1
            folder = "/".join(path.split("/")[:-1][:depth])
            text = file.read_text(encoding="utf-8")
            for match in INCLUDE.finditer(text):
                quote, target = match.groups()
                if path == "engine/include/isophote/device.hpp" and target == "vulkan/vulkan.h":
                    continue
                error = layer_error(folder, quote, target)
                if error:
                    yield f"{path}:{text.count(chr(10), 0, match.start(1)) + 1}: {target} {error}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1])
    found = list(violations(root))
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
