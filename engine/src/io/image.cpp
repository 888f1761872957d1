#include "isophote/image.hpp"

#include <algorithm>

namespace isophote {
namespace {

template <class Plane> const Plane* findIn(const std::vector<Plane>& planes, const std::string& name) {
  const auto found = std::find_if(planes.begin(), planes.end(), [&](const Plane& plane) { return plane.name == name; });
  return found == planes.end() ? nullptr : &*found;
}

} // namespace

const Channel* Image::find(const std::string& name) const { return findIn(channels, name); }

const IntegerChannel* Image::findIntegers(const std::string& name) const { return findIn(integers, name); }

} // namespace isophote
