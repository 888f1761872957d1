"""A still life in the corner of a room: metal, ceramic, matt paint and a tiled floor under soft panels."""
import math

from asset_maker.gltf import Gltf
from asset_maker.png import grey_png
from asset_maker.shapes import lathe, merge, quad, rounded_box, sphere, tube


def _turn(degrees, axis=1):
    return axis, math.cos(math.radians(degrees) / 2), math.sin(math.radians(degrees) / 2)


def _tiles():
    """Four tiles of 32 x 32 texels with dark joints."""
    tones = ((214, 150), (158, 205))
    return grey_png([[70 if x % 32 == 0 or y % 32 == 0 else tones[y // 32][x // 32] for x in range(64)] for y in range(64)])


def _knot(t):
    """The (2, 3) torus knot, standing upright enough to look at."""
    a = 2 * math.pi * t
    radius = 0.36 + 0.13 * math.cos(3 * a)
    return radius * math.cos(2 * a), 0.15 * math.sin(3 * a), radius * math.sin(2 * a)


def _vase():
    """Profile from the inside of the neck over the lip and the outside down to the foot."""
    shape = ((0.0, 0.17), (0.16, 0.09), (0.62, 0.31), (1.0, 0.16))  # (share of the height from the top, radius)

    def radius(s):
        for (s0, r0), (s1, r1) in zip(shape, shape[1:]):
            if s <= s1:
                return r0 + (r1 - r0) * 0.5 * (1 - math.cos(math.pi * (s - s0) / (s1 - s0)))
        return shape[-1][1]

    outside = [(radius(i / 28), 1.3 * (1 - i / 28)) for i in range(29)]
    inside = [(0.06, 1.05), (0.075, 1.15), (0.13, 1.28), (0.155, 1.308)]
    return lathe([*inside, *outside, outside[-1], (0.0, 0.0)], 40)


def _bowl():
    """A half sphere with a wall: inside from its middle to the rim, outside from the rim to the foot."""
    steps = 12
    inner = [(0.40 * math.sin(a), 0.47 - 0.40 * math.cos(a)) for a in (math.pi / 2.2 * i / steps for i in range(steps + 1))]
    outer = [(0.43 * math.sin(a), 0.47 - 0.43 * math.cos(a)) for a in (math.pi / 2.2 * i / steps for i in range(steps + 1))]
    outer[0], inner[0] = (0.0, 0.04), (0.0, 0.07)
    return lathe([*inner, inner[-1], outer[-1], *reversed(outer)], 40)


def _room(gltf):
    tiles = gltf.material("tiles", (0.80, 0.74, 0.66), 0.0, 0.22, gltf.texture("tiles", _tiles()))
    floor = quad((-3.0, 0.0, 7.0), (5.0, 0.0, 7.0), (5.0, 0.0, -2.5), (-3.0, 0.0, -2.5),
                 [(0.0, 9.5), (8.0, 9.5), (8.0, 0.0), (0.0, 0.0)])
    gltf.node(gltf.mesh("floor", gltf.shape(floor), tiles), name="floor")
    plaster = gltf.lambert("plaster", (0.68, 0.64, 0.60))
    shell = merge([quad((-3.0, 0.0, -2.5), (5.0, 0.0, -2.5), (5.0, 4.5, -2.5), (-3.0, 4.5, -2.5)),  # back
                   quad((5.0, 0.0, -2.5), (5.0, 0.0, 7.0), (5.0, 4.5, 7.0), (5.0, 4.5, -2.5)),      # right
                   quad((5.0, 0.0, 7.0), (-3.0, 0.0, 7.0), (-3.0, 4.5, 7.0), (5.0, 4.5, 7.0)),      # behind the camera
                   quad((-3.0, 4.5, -2.5), (5.0, 4.5, -2.5), (5.0, 4.5, 7.0), (-3.0, 4.5, 7.0))])   # ceiling
    gltf.node(gltf.mesh("room", gltf.shape(shell), plaster), name="room")
    blue = gltf.lambert("blue paint", (0.10, 0.22, 0.34))
    side = quad((-3.0, 0.0, 7.0), (-3.0, 0.0, -2.5), (-3.0, 4.5, -2.5), (-3.0, 4.5, 7.0))
    gltf.node(gltf.mesh("side wall", gltf.shape(side), blue), name="side wall")


def _lights(gltf):
    window = gltf.shape(quad((-2.99, 1.0, 2.8), (-2.99, 1.0, 0.2), (-2.99, 3.4, 0.2), (-2.99, 3.4, 2.8)))
    gltf.node(gltf.mesh("window", window, gltf.emitter("daylight", (6.0, 7.4, 9.5))), name="window")
    panel = gltf.shape(quad((1.4, 4.4, -0.8), (3.6, 4.4, -0.8), (3.6, 4.4, 1.4), (1.4, 4.4, 1.4)))
    gltf.node(gltf.mesh("ceiling panel", panel, gltf.emitter("warm panel", (8.0, 6.0, 3.9))), name="ceiling panel")
    strip = gltf.mesh("strip", gltf.shape(quad((-0.035, 0.0, 0.0), (0.035, 0.0, 0.0), (0.035, 1.1, 0.0), (-0.035, 1.1, 0.0))),
                      gltf.emitter("strip", (5.0, 2.0, 0.8)))
    for i in range(3):
        gltf.node(strip, (-1.75 + 0.32 * i, 0.75 + 0.2 * i, -2.49), name=f"strip {i}")


def _objects(gltf):
    block = gltf.shape(rounded_box((0.5, 0.5, 0.5), 0.05, 3))
    plinth = gltf.mesh("plinth", block, gltf.lambert("chalk", (0.76, 0.74, 0.70)))
    gltf.node(plinth, (0.0, 0.25, -0.4), (1.3, 0.5, 1.3), _turn(18.0), "plinth")
    gold = gltf.material("gold", (1.0, 0.77, 0.34), 1.0, 0.22)
    knot = gltf.mesh("knot", gltf.shape(tube(_knot, 0.085, 160, 14)), gold)
    gltf.node(knot, (0.0, 1.02, -0.4), 1.0, _turn(68.0, axis=0), "knot")

    ball = gltf.shape(sphere(0.5, 32, 48))
    gltf.node(gltf.mesh("steel ball", ball, gltf.material("steel", (0.82, 0.83, 0.85), 1.0, 0.08)), (-0.92, 0.42, 0.6), 0.84,
              name="steel ball")
    glaze = gltf.material("glaze", (0.02, 0.20, 0.22), 0.0, 0.12)
    gltf.node(gltf.mesh("vase", gltf.shape(_vase()), glaze), (1.35, 0.0, -0.75), 1.1, name="vase")
    copper = gltf.material("copper", (0.96, 0.64, 0.54), 1.0, 0.3)
    gltf.node(gltf.mesh("bowl", gltf.shape(_bowl()), copper), (1.25, -0.035, 0.85), 1.0, name="bowl")
    orange = gltf.mesh("orange", ball, gltf.material("orange peel", (0.85, 0.28, 0.03), 0.0, 0.45))
    for x, y, z in ((1.12, 0.27, 0.92), (1.36, 0.28, 0.94), (1.27, 0.27, 0.72), (1.25, 0.44, 0.86)):
        gltf.node(orange, (x, y, z), 0.25, name="orange")
    red = gltf.mesh("red cube", block, gltf.material("red lacquer", (0.50, 0.03, 0.03), 0.0, 0.18))
    cube = gltf.mesh("chalk cube", block, gltf.lambert("ochre", (0.65, 0.42, 0.12)))
    gltf.node(red, (-2.25, 0.275, -1.35), 0.55, _turn(24.0), "red cube")
    gltf.node(cube, (-2.22, 0.725, -1.32), 0.35, _turn(50.0), "ochre cube")
    gltf.node(cube, (-1.75, 0.14, 0.75), 0.28, _turn(-22.0), "ochre cube")
    bead = gltf.mesh("bead", ball, gltf.material("pearl", (0.86, 0.84, 0.80), 0.0, 0.25))
    for i in range(9):
        angle = math.radians(200.0 + 15.0 * i)
        gltf.node(bead, (0.1 + 0.75 * math.cos(angle), 0.06, 0.85 - 0.55 * math.sin(angle)), 0.12, name="bead")


def scene():
    gltf = Gltf("Still life")
    _room(gltf)
    _lights(gltf)
    _objects(gltf)
    gltf.camera("camera", (0.9, 1.65, 6.0), (0.1, 0.72, -0.3), math.radians(27.0), 1.6)
    return gltf
