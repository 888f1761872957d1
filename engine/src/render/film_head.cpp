#include "render/film_head.hpp"

#include <bit>
#include <cstdint>

#include "render/whole_number.hpp"

namespace isophote {
namespace {

using Json = nlohmann::ordered_json;

Json bits(double value) { return std::bit_cast<uint64_t>(value); }
double fromBits(const Json& json) { return std::bit_cast<double>(wholeNumber<uint64_t>(json)); }

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
  const auto number = [](const Json& json) { return wholeNumber<uint32_t>(json); };
  sums.options.width = number(head.at("size").at(0));
  sums.options.height = number(head.at("size").at(1));
  const Json& crop = head.at("crop");
  sums.options.crop = {number(crop.at(0)), number(crop.at(1)), number(crop.at(2)), number(crop.at(3))};
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
