#!/usr/bin/env python3
"""Writes the scenes of assets/, always the same bytes.

usage: scripts/make_assets.py [FOLDER]   (assets/ of this checkout)
"""
import pathlib
import sys

from asset_maker import caustic, cornell_box, demo, lecture, many_lights, material_grid, open_air, triangle, veach


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1] / "assets")
    folder.mkdir(parents=True, exist_ok=True)
    cornell_box.scene().write_gltf(folder / "cornell-box.gltf")
    triangle.scene().write_gltf(folder / "triangle.gltf")
    material_grid.scene().write_glb(folder / "material-grid.glb")
    demo.scene().write_glb(folder / "demo.glb")
    lecture.scene().write_glb(folder / "lecture.glb")
    veach.scene().write_gltf(folder / "veach-plates.gltf")
    caustic.scene().write_glb(folder / "caustic.glb")
    many_lights.scene().write_glb(folder / "many-lights.glb")
    open_air.scene().write_glb(folder / "open-air.glb")
    (folder / "sky.hdr").write_bytes(open_air.sky_hdr())


if __name__ == "__main__":
    main()
