#include "scene/gltf_json.hpp"

#include <unordered_set>
#include <vector>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace {

/// A linear scan, so that neither the parser nor anything after it can be driven into deep nesting.
void checkDepth(const std::string& file, std::span<const std::byte> text) {
  uint32_t depth = 0;
  bool inString = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = static_cast<char>(text[i]);
    if (inString) {
      if (c == '\\') {
        ++i;
      } else if (c == '"') {
        inString = false;
      }
    } else if (c == '"') {
      inString = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth) {
        throw SceneError(file, "", fmt::format("JSON nested at most {} deep, deeper at byte {}", kMaxJsonDepth, i));
      }
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
}

/// Parser callback: remembers the keys of every open object. RFC 8259 leaves repeated keys undefined; glTF forbids them.
class DuplicateKeyCheck {
public:
  explicit DuplicateKeyCheck(const std::string& file) : file_(file) {}

  /// `depth`: the number of arrays and objects around the value (nlohmann's count; a key is inside its object).
  /// The end of an object is not reported where its value is dropped, so the depth alone says which object is meant.
  bool operator()(size_t depth, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) {
      keys_.resize(depth + 1);
      keys_[depth].clear();
    } else if (event == Json::parse_event_t::key) {
      const std::string& key = parsed.get_ref<const std::string&>();
      if (!keys_[depth - 1].insert(key).second) {
        throw SceneError(file_, "", fmt::format("every key of an object once, \"{}\" stands twice", key));
      }
      return key != "extras"; // application data: dropped, no glTF feature lives there
    }
    return true;
  }

private:
  const std::string& file_;
  std::vector<std::unordered_set<std::string>> keys_;
};

} // namespace

Json parseJson(const std::string& file, std::span<const std::byte> text) {
  if (text.size() > kMaxJsonBytes) {
    throw LimitError(fmt::format("{}: {} bytes of JSON, the limit is {}", file, text.size(), kMaxJsonBytes));
  }
  checkDepth(file, text);
  const char* begin = reinterpret_cast<const char*>(text.data());
  DuplicateKeyCheck check(file);
  Json root;
  try {
    root = Json::parse(
        begin, begin + text.size(),
        [&check](int depth, Json::parse_event_t event, Json& parsed) {
          return check(static_cast<size_t>(depth), event, parsed);
        });
  } catch (const Json::exception& error) {
    throw SceneError(file, "", fmt::format("valid JSON ({})", error.what()));
  }
  if (!root.is_object()) throw SceneError(file, "", "a JSON object at the root");
  return root;
}

const Json* member(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

const Json* extension(const Json& object, const char* name) {
  const Json* extensions = member(object, "extensions");
  return extensions ? member(*extensions, name) : nullptr;
}

const Json& arrayOrEmpty(const Json& object, const char* name) {
  static const Json kEmpty = Json::array();
  const Json* found = member(object, name);
  return found ? *found : kEmpty;
}

double numberOr(const Json& object, const char* name, double fallback) {
  const Json* found = member(object, name);
  return found ? found->get<double>() : fallback;
}

uint64_t integerOr(const Json& object, const char* name, uint64_t fallback) {
  const Json* found = member(object, name);
  return found ? found->get<uint64_t>() : fallback;
}

bool boolOr(const Json& object, const char* name, bool fallback) {
  const Json* found = member(object, name);
  return found ? found->get<bool>() : fallback;
}

std::string stringOr(const Json& object, const char* name, const std::string& fallback) {
  const Json* found = member(object, name);
  return found ? found->get<std::string>() : fallback;
}

std::optional<uint32_t> indexOf(const Json& object, const char* name) {
  const Json* found = member(object, name);
  if (!found) return std::nullopt;
  return found->get<uint32_t>();
}

} // namespace isophote::gltf
