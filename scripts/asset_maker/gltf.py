"""A glTF 2.0 file under construction: what the scenes here need, and no more."""
import base64
import json
import struct

from asset_maker.vectors import cross, normalize, subtract

FLOAT, UNSIGNED_SHORT = 5126, 5123
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


class Gltf:
    def __init__(self, title):
        self.data = bytearray()
        self.extensions = set()
        self.json = {
            "asset": {"version": "2.0", "generator": "Isophote scripts/make_assets.py",
                      "copyright": "CC0 1.0, the Isophote project", "extras": {"title": title}},
            "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [],
            "bufferViews": [], "buffers": [{}],
        }

    def _append(self, key, value):
        self.json.setdefault(key, []).append(value)
        return len(self.json[key]) - 1

    def _view(self, data, target=None):
        self.data.extend(bytes(-len(self.data) % 4))
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.data.extend(data)
        return self._append("bufferViews", view)

    def _floats(self, rows, kind, bounds=False):
        flat = [x for row in rows for x in row]
        accessor = {"bufferView": self._view(struct.pack(f"<{len(flat)}f", *flat), ARRAY_BUFFER),
                    "componentType": FLOAT, "count": len(rows), "type": kind}
        if bounds:  # of the values as stored
            stored = [struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows]
            accessor["min"] = [min(column) for column in zip(*stored)]
            accessor["max"] = [max(column) for column in zip(*stored)]
        return self._append("accessors", accessor)

    def shape(self, shape):
        """Stores a Shape; the result can be the geometry of several meshes."""
        attributes = {"POSITION": self._floats(shape.positions, "VEC3", bounds=True)}
        if shape.normals:
            attributes["NORMAL"] = self._floats(shape.normals, "VEC3")
        if shape.uvs:
            attributes["TEXCOORD_0"] = self._floats(shape.uvs, "VEC2")
        view = self._view(struct.pack(f"<{len(shape.indices)}H", *shape.indices), ELEMENT_ARRAY_BUFFER)
        indices = self._append("accessors", {"bufferView": view, "componentType": UNSIGNED_SHORT,
                                             "count": len(shape.indices), "type": "SCALAR"})
        return {"attributes": attributes, "indices": indices}

    def mesh(self, name, geometry, material):
        return self._append("meshes", {"name": name, "primitives": [{**geometry, "material": material}]})

    def node(self, mesh, translation=None, scale=None, rotation=None, name=None):
        """`rotation` is (axis x, y or z as 0, 1 or 2; angle's half cosine; half sine)."""
        node = {"mesh": mesh}
        if name:
            node["name"] = name
        if translation:
            node["translation"] = list(translation)
        if rotation:
            axis, half_cosine, half_sine = rotation
            quaternion = [0.0, 0.0, 0.0, half_cosine]
            quaternion[axis] = half_sine
            node["rotation"] = quaternion
        if scale:
            node["scale"] = [scale] * 3 if isinstance(scale, float) else list(scale)
        return self._place(node)

    def _place(self, node):
        index = self._append("nodes", node)
        self.json["scenes"][0]["nodes"].append(index)
        return index

    def texture(self, name, png):
        image = self._append("images", {"name": name, "mimeType": "image/png", "bufferView": self._view(png)})
        sampler = self._append("samplers", {"magFilter": 9729, "wrapS": 10497, "wrapT": 10497})
        return self._append("textures", {"source": image, "sampler": sampler})

    def material(self, name, color, metallic=0.0, roughness=1.0, texture=None):
        surface = {"baseColorFactor": [*color, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
        if texture is not None:
            surface["baseColorTexture"] = {"index": texture}
        return self._append("materials", {"name": name, "pbrMetallicRoughness": surface})

    def lambert(self, name, color):
        """Diffuse reflectance `color` and nothing else: a specular factor of 0 removes the coat."""
        self.extensions.add("KHR_materials_specular")
        material = self.material(name, color)
        self.json["materials"][material]["extensions"] = {"KHR_materials_specular": {"specularFactor": 0.0}}
        return material

    def emitter(self, name, radiance):
        """A black surface that emits `radiance` from its front."""
        self.extensions.add("KHR_materials_emissive_strength")
        strength = max(radiance)
        material = self.lambert(name, (0.0, 0.0, 0.0))
        entry = self.json["materials"][material]
        entry["emissiveFactor"] = [round(c / strength, 9) for c in radiance]
        entry["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        return material

    def point_light(self, name, position, intensity, radius=None):
        """With a radius a sphere (docs/lights.md)."""
        self.extensions.add("KHR_lights_punctual")
        root = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})
        light = {"name": name, "type": "point", "color": [1.0, 1.0, 1.0], "intensity": intensity}
        if radius is not None:
            light["extras"] = {"radius": radius}
        root["lights"].append(light)
        self._place({"name": name, "translation": list(position),
                     "extensions": {"KHR_lights_punctual": {"light": len(root["lights"]) - 1}}})

    def camera(self, name, eye, target, yfov, aspect, znear=0.01):
        back = normalize(subtract(eye, target))
        right = normalize(cross((0.0, 1.0, 0.0), back))
        up = cross(back, right)
        camera = self._append("cameras", {"name": name, "type": "perspective", "perspective": {
            "yfov": yfov, "aspectRatio": aspect, "znear": znear}})
        self._place({"name": name, "camera": camera,
                     "matrix": [round(x, 9) for x in (*right, 0.0, *up, 0.0, *back, 0.0, *eye, 1.0)]})

    def _finish(self):
        self.data.extend(bytes(-len(self.data) % 4))
        self.json["buffers"][0]["byteLength"] = len(self.data)
        if self.extensions:
            self.json["extensionsUsed"] = sorted(self.extensions)

    def write_gltf(self, file):
        """Text, with the buffer embedded."""
        self._finish()
        encoded = base64.b64encode(self.data).decode("ascii")
        self.json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + encoded
        file.write_text(json.dumps(self.json, indent=1) + "\n", encoding="utf-8", newline="\n")

    def write_glb(self, file):
        self._finish()
        text = json.dumps(self.json, separators=(",", ":")).encode("utf-8")
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(self.data), b"BIN\0") + self.data
        file.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
