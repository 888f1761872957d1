#include "render/film_head.hpp"

#include <bit>
#include <cstdint>

namespace isophote {
namespace {

using Json = nlohmann::ordered_json;

Json bits(double value) { return std::bit_cast<uint64_t>(value); }
double fromBits(const Json& json) { return std::bit_cast<double>(json.get<uint64_t>()); }

} // namespace

Json filmHead(const FilmSums& sums) {
  const PixelRect& crop = sums.options.crop;
  return {{"size", {sums.options.width, sums.options.height}},
          {"crop", {crop.x0, crop.y0, crop.x1, crop.y1}},
          {"aovs", sums.options.aovs},
          {"clamp_ledger", sums.options.clampLedger},
          {"depth_ledger", sums.options.depthLedger},
          {"radiance_per_unit", bits(sums.radiancePerUnit)},
          {"length_per_unit", bits(sums.lengthPerUnit)},
          {"world_origin", {bits(sums.worldOrigin.x), bits(sums.worldOrigin.y), bits(sums.worldOrigin.z)}}};
}

FilmSums filmFromHead(const Json& head) {
  FilmSums sums;
  sums.options.width = head.at("size").at(0);
  sums.options.height = head.at("size").at(1);
  const Json& crop = head.at("crop");
  sums.options.crop = {crop.at(0), crop.at(1), crop.at(2), crop.at(3)};
  sums.options.aovs = head.at("aovs");
  sums.options.clampLedger = head.at("clamp_ledger");
  sums.options.depthLedger = head.at("depth_ledger");
  sums.radiancePerUnit = fromBits(head.at("radiance_per_unit"));
  sums.lengthPerUnit = fromBits(head.at("length_per_unit"));
  for (int axis = 0; axis < 3; ++axis) {
    sums.worldOrigin[axis] = fromBits(head.at("world_origin").at(static_cast<size_t>(axis)));
  }
  return sums;
}

} // namespace isophote
