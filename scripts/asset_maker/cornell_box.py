"""The Cornell box from the measured data of the Cornell University Program of Computer Graphics.

Geometry in millimetres, camera, reflectance spectra and the light's spectrum: "Cornell Box Data",
https://www.graphics.cornell.edu/online/box/data.html. Stored in metres. The ceiling has a hole where the light is, so that
no two surfaces coincide.
"""
import math

from asset_maker.gltf import Gltf
from asset_maker.shapes import merge, quad

# 400 to 700 nm in steps of 4 nm.
WHITE = """.343 .445 .551 .624 .665 .687 .708 .723 .715 .710 .745 .758 .739 .767 .777 .765 .751 .745 .748 .729 .745 .757 .753
 .750 .746 .747 .735 .732 .739 .734 .725 .721 .733 .725 .732 .743 .744 .748 .728 .716 .733 .726 .713 .740 .754 .764 .752 .736
 .734 .741 .740 .732 .745 .755 .751 .744 .731 .733 .744 .731 .712 .708 .729 .730 .727 .707 .703 .729 .750 .760 .751 .739 .724
 .730 .740 .737"""
GREEN = """.092 .096 .098 .097 .098 .095 .095 .097 .095 .094 .097 .098 .096 .101 .103 .104 .107 .109 .112 .115 .125 .140 .160
 .187 .229 .285 .343 .390 .435 .464 .472 .476 .481 .462 .447 .441 .426 .406 .373 .347 .337 .314 .285 .277 .266 .250 .230 .207
 .186 .171 .160 .148 .141 .136 .130 .126 .123 .121 .122 .119 .114 .115 .117 .117 .118 .120 .122 .128 .132 .139 .144 .146 .150
 .152 .157 .159"""
RED = """.040 .046 .048 .053 .049 .050 .053 .055 .057 .056 .059 .057 .061 .061 .060 .062 .062 .062 .061 .062 .060 .059 .057
 .058 .058 .058 .056 .055 .056 .059 .057 .055 .059 .059 .058 .059 .061 .061 .063 .063 .067 .068 .072 .080 .090 .099 .124 .154
 .192 .255 .287 .349 .402 .443 .487 .513 .558 .584 .620 .606 .609 .651 .612 .610 .650 .638 .627 .620 .630 .628 .642 .639 .657
 .639 .635 .642"""
# Radiance, linear between 400, 500, 600 and 700 nm.
LIGHT = (0.0, 8.0, 15.6, 18.4)


def _lobe(wavelength, mean, below, above):
    return math.exp(-0.5 * ((wavelength - mean) * (below if wavelength < mean else above)) ** 2)


def _cie_1931(nm):
    """The 2-degree color matching functions; Wyman, Sloan and Shirley 2013, "Simple Analytic Approximations to the CIE XYZ
    Color Matching Functions", JCGT 2(2), the multi-lobe fit of table 1."""
    x = (1.056 * _lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * _lobe(nm, 442.0, 0.0624, 0.0374)
         - 0.065 * _lobe(nm, 501.1, 0.0490, 0.0382))
    y = 0.821 * _lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * _lobe(nm, 530.9, 0.0613, 0.0322)
    z = 1.217 * _lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * _lobe(nm, 459.0, 0.0385, 0.0725)
    return x, y, z


def _rec709(spectrum):
    """Linear Rec.709 of 76 samples, scaled channel by channel so that an equal-energy spectrum of 1 is (1, 1, 1): a grey
    surface then stays grey, and the light keeps its color relative to equal energy."""
    def integrate(values):
        xyz = [0.0, 0.0, 0.0]
        for i, value in enumerate(values):
            for c, weight in enumerate(_cie_1931(400 + 4 * i)):
                xyz[c] += value * weight
        x, y, z = xyz
        return (3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
                0.0556434 * x - 0.2040259 * y + 1.0572252 * z)
    return tuple(round(value / one, 4) for value, one in zip(integrate(spectrum), integrate([1.0] * 76)))


def reflectance(table):
    return _rec709([float(value) for value in table.split()])


def light_radiance():
    def at(nm):
        i = min((nm - 400) // 100, 2)
        return LIGHT[i] + (LIGHT[i + 1] - LIGHT[i]) * (nm - 400 - 100 * i) / 100
    return _rec709([at(400 + 4 * i) for i in range(76)])


def _block(height, footprint):
    """Top and sides of a block whose top corners are counter-clockwise seen from above."""
    top = [(x, height, z) for x, z in footprint]
    sides = []
    for (x0, z0), (x1, z1) in zip(footprint, footprint[1:] + footprint[:1]):
        sides.append(_millimetres((x0, height, z0), (x0, 0, z0), (x1, 0, z1), (x1, height, z1)))
    return merge([_millimetres(*top), *sides])


def _millimetres(*corners):
    return quad(*(tuple(c / 1000 for c in corner) for corner in corners))


def _white_shell():
    floor = _millimetres((552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2))
    back = _millimetres((549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2))

    def ceiling(x0, x1, z0, z1):
        return _millimetres((x1, 548.8, z0), (x1, 548.8, z1), (x0, 548.8, z1), (x0, 548.8, z0))
    around_the_light = [ceiling(0, 556, 0, 227), ceiling(0, 556, 332, 559.2), ceiling(0, 213, 227, 332),
                        ceiling(343, 556, 227, 332)]
    return merge([floor, back, *around_the_light])


def scene():
    gltf = Gltf("Cornell box")
    white, green, red = (gltf.lambert(name, reflectance(table))
                         for name, table in (("white", WHITE), ("green", GREEN), ("red", RED)))
    light = gltf.emitter("light", light_radiance())

    def place(name, shape, material):
        gltf.node(gltf.mesh(name, gltf.shape(shape), material), name=name)

    place("shell", _white_shell(), white)
    place("right wall", _millimetres((0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)), green)
    place("left wall", _millimetres((552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)), red)
    place("short block", _block(165, [(130, 65), (82, 225), (240, 272), (290, 114)]), white)
    place("tall block", _block(330, [(423, 247), (265, 296), (314, 456), (472, 406)]), white)
    place("light", _millimetres((343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)), light)
    # Focal length 35 mm, film 25 mm x 25 mm.
    gltf.camera("camera", (0.278, 0.273, -0.8), (0.278, 0.273, 0.0), 2 * math.atan(0.0125 / 0.035), 1.0)
    return gltf
