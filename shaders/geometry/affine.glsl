// Affine maps stored as three rows.
#ifndef ISOPHOTE_GEOMETRY_AFFINE_GLSL
#define ISOPHOTE_GEOMETRY_AFFINE_GLSL

struct Affine {
  vec4 row0;
  vec4 row1;
  vec4 row2;
};

// `precise` below: a point must map to the same bits wherever it is mapped, and the error bounds count these roundings.
vec3 transformPoint(const Affine map, const vec3 p) {
  precise vec3 result = vec3((map.row0.x * p.x + map.row0.y * p.y) + (map.row0.z * p.z + map.row0.w),
                             (map.row1.x * p.x + map.row1.y * p.y) + (map.row1.z * p.z + map.row1.w),
                             (map.row2.x * p.x + map.row2.y * p.y) + (map.row2.z * p.z + map.row2.w));
  return result;
}

vec3 transformVector(const Affine map, const vec3 v) {
  precise vec3 result = vec3((map.row0.x * v.x + map.row0.y * v.y) + map.row0.z * v.z,
                             (map.row1.x * v.x + map.row1.y * v.y) + map.row1.z * v.z,
                             (map.row2.x * v.x + map.row2.y * v.y) + map.row2.z * v.z);
  return result;
}

/// Multiplies by the transpose of the linear part: with the inverse of a map this takes normals through the map.
vec3 transformByTranspose(const Affine map, const vec3 n) {
  return n.x * map.row0.xyz + n.y * map.row1.xyz + n.z * map.row2.xyz;
}

/// |linear part| * v for v >= 0: how far an error box of half extents v reaches behind the map.
vec3 transformExtent(const Affine map, const vec3 v) {
  return vec3(dot(abs(map.row0.xyz), v), dot(abs(map.row1.xyz), v), dot(abs(map.row2.xyz), v));
}

vec3 translationOf(const Affine map) { return vec3(map.row0.w, map.row1.w, map.row2.w); }

#endif
