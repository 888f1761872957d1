"""A ball and a block in the open, and the sky that lights them: a bright blue one with a small sun."""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import quad, rounded_box, sphere

SKY_WIDTH, SKY_HEIGHT = 64, 32
SUN_TEXEL = (22, 9)


def scene():
    gltf = Gltf("In the open; light it with --env sky.hdr")
    clay = gltf.material("clay", (0.7, 0.4, 0.3), 0.0, 0.5)
    gltf.node(gltf.mesh("ball", gltf.shape(sphere(0.5, 16, 24)), clay), (-0.6, 0.5, 0.0))
    steel = gltf.material("steel", (0.6, 0.6, 0.62), 1.0, 0.3)
    gltf.node(gltf.mesh("block", gltf.shape(rounded_box((0.4, 0.4, 0.4), 0.06, 2)), steel), (0.6, 0.4, 0.2))
    ground = gltf.lambert("ground", (0.45, 0.45, 0.4))
    gltf.node(gltf.mesh("ground", gltf.shape(quad((-20.0, 0.0, 20.0), (20.0, 0.0, 20.0), (20.0, 0.0, -20.0), (-20.0, 0.0, -20.0))), ground))
    gltf.camera("camera", (0.4, 1.5, 3.6), (0.0, 0.4, 0.0), math.radians(40.0), 1.0)
    return gltf


def _rgbe(color):
    """Ward 1991, "Real Pixels": three mantissas with the exponent of the largest."""
    fraction, exponent = math.frexp(max(color))
    scale = fraction * 256.0 / max(color)
    return bytes([*(int(c * scale) for c in color), exponent + 128])


def _sky_color(row):
    height = math.cos(math.pi * (row + 0.5) / SKY_HEIGHT)
    if height < 0:
        return (0.2, 0.18, 0.15)
    return (1.1 - 0.8 * height, 1.2 - 0.6 * height, 1.3 - 0.3 * height)


def sky_hdr():
    """A Radiance file without run-length coding."""
    texels = bytearray()
    for row in range(SKY_HEIGHT):
        for column in range(SKY_WIDTH):
            texels += _rgbe((900.0, 800.0, 600.0) if (column, row) == SUN_TEXEL else _sky_color(row))
    return b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {SKY_HEIGHT} +X {SKY_WIDTH}\n".encode("ascii") + bytes(texels)
