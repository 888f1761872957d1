#include "scene/gltf_json.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace {

/// Builds the tree from parser events. nlohmann's own builder accepts repeated keys and any depth, and its variant with
/// a callback takes time quadratic in the length of arrays.
class TreeBuilder final : public nlohmann::json_sax<Json> {
public:
  explicit TreeBuilder(const std::string& file) : file_(file) {}

  [[nodiscard]] Json take() { return std::move(root_); }

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(int64_t value) override { return put(value); }
  bool number_unsigned(uint64_t value) override { return put(value); }
  bool number_float(double value, const std::string&) override { return put(value); }
  bool string(std::string& value) override { return put(std::move(value)); }
  bool binary(Json::binary_t&) override { return false; } // not in JSON text
  bool start_object(size_t) override { return open(Json::object()); }
  bool start_array(size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string& name) override {
    const auto [place, isNew] = open_.back()->get_ref<Json::object_t&>().try_emplace(name);
    if (!isNew) throw SceneError(file_, "", fmt::format("every key of an object once, \"{}\" stands twice", name));
    member_ = &place->second;
    return true;
  }

  bool parse_error(size_t, const std::string&, const Json::exception& error) override {
    throw SceneError(file_, "", fmt::format("valid JSON ({})", error.what()));
  }

private:
  template <class Value> bool put(Value&& value) {
    place(std::forward<Value>(value));
    return true;
  }

  /// Pointers into arrays stay valid: an array does not grow while one of its elements is open.
  template <class Value> Json* place(Value&& value) {
    Json* where = &root_;
    if (!open_.empty() && open_.back()->is_array()) {
      where = &open_.back()->emplace_back();
    } else if (!open_.empty()) {
      where = member_;
    }
    *where = std::forward<Value>(value);
    return where;
  }

  bool open(Json container) {
    if (open_.size() == kMaxJsonDepth) {
      throw SceneError(file_, "", fmt::format("JSON nested at most {} deep", kMaxJsonDepth));
    }
    open_.push_back(place(std::move(container)));
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  const std::string& file_;
  Json root_;
  std::vector<Json*> open_;
  Json* member_ = nullptr; ///< of the innermost object, waits for its value
};

} // namespace

Json parseJson(const std::string& file, std::span<const std::byte> text) {
  if (text.size() > kMaxJsonBytes) {
    throw LimitError(fmt::format("{}: {} bytes of JSON, the limit is {}", file, text.size(), kMaxJsonBytes));
  }
  const char* begin = reinterpret_cast<const char*>(text.data());
  TreeBuilder builder(file);
  Json::sax_parse(begin, begin + text.size(), &builder);
  Json root = builder.take();
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

std::optional<double> extraNumber(const Json& object, const char* name) {
  const Json* extras = member(object, "extras");
  if (extras == nullptr || !extras->is_object()) return std::nullopt;
  const Json* value = member(*extras, name);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
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
