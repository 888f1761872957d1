#include "isophote/image.hpp"

#include <algorithm>

namespace isophote {

const Channel* Image::find(const std::string& name) const {
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const Channel& channel) { return channel.name == name; });
  return found == channels.end() ? nullptr : &*found;
}

} // namespace isophote
