// Tables of albedos in planes: one plane for each pair of values of two outer axes, linear between them.
#ifndef ISOPHOTE_BSDF_TABLE_CELL_GLSL
#define ISOPHOTE_BSDF_TABLE_CELL_GLSL

/// The four planes around a point of the outer axes, and where the point lies between them.
struct TableCell {
  uint planes[4]; // where they begin
  vec2 fraction;
};

/// @param planes where the first plane begins
/// @param size   items of a plane
/// @param count  planes along each axis, at least 1
/// @param low    what the first plane of each axis stands for
/// @param high   what the last one does
/// @param point  clamped to them
TableCell tableCell(const uint planes, const uint size, const uvec2 count, const vec2 low, const vec2 high,
                    const vec2 point) {
  const vec2 range = max(high - low, vec2(1e-9));
  const vec2 position = clamp((point - low) / range, 0.0, 1.0) * vec2(count - 1u);
  const uvec2 first = min(uvec2(position), count - 1u);
  const uvec2 second = min(first + 1u, count - 1u);
  TableCell cell;
  cell.planes[0] = planes + (first.y * count.x + first.x) * size;
  cell.planes[1] = planes + (first.y * count.x + second.x) * size;
  cell.planes[2] = planes + (second.y * count.x + first.x) * size;
  cell.planes[3] = planes + (second.y * count.x + second.x) * size;
  cell.fraction = position - vec2(first);
  return cell;
}

/// Between the values of the four planes.
vec2 mixPlanes(const vec2 values[4], const vec2 fraction) {
  return mix(mix(values[0], values[1], fraction.x), mix(values[2], values[3], fraction.x), fraction.y);
}
vec3 mixPlanes(const vec3 values[4], const vec2 fraction) {
  return mix(mix(values[0], values[1], fraction.x), mix(values[2], values[3], fraction.x), fraction.y);
}

#endif
