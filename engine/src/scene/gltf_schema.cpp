// Source: Khronos glTF 2.0.1 specification, JSON schemas, and those of the extensions named below.
#include "scene/gltf_schema.hpp"

#include <cfloat>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "isophote/error.hpp"

namespace isophote::gltf {
namespace {

struct Shape;

struct Member {
  const char* name;
  const Shape* shape;
  bool required = false;
};

enum class Kind { Any, Bool, Integer, Number, String, Index, Array, Object, Map };

/// What one value has to look like.
struct Shape {
  Kind kind = Kind::Any;
  double lower = -DBL_MAX;          ///< Integer, Number: inclusive; Array: fewest items
  double upper = DBL_MAX;           ///< Integer, Number: inclusive; Array: most items
  std::vector<double> choices = {}; ///< Integer: when not empty, the only values
  const char* target = nullptr;     ///< Index: pointer of the array it points into
  const Shape* item = nullptr;      ///< Array, Map: of every element
  std::vector<Member> members = {}; ///< Object; further members are ignored
};

const Shape kBool{.kind = Kind::Bool};
const Shape kString{.kind = Kind::String};
const Shape kNumber{.kind = Kind::Number};
const Shape kFloat{.kind = Kind::Number, .lower = -FLT_MAX, .upper = FLT_MAX}; // stored as float
const Shape kUnsigned{.kind = Kind::Integer, .lower = 0, .upper = 0x1p64};
const Shape kPositive{.kind = Kind::Integer, .lower = 1, .upper = 0x1p64};
const Shape kUvSet{.kind = Kind::Integer, .lower = 0, .upper = 0x7fffffff};

Shape arrayOf(const Shape& item, double fewest = 0, double most = static_cast<double>(kMaxArrayItems)) {
  return {.kind = Kind::Array, .lower = fewest, .upper = most, .item = &item};
}
Shape indexInto(const char* pointer) { return {.kind = Kind::Index, .target = pointer}; }
Shape mapOf(const Shape& item) { return {.kind = Kind::Map, .item = &item}; }
Shape object(std::vector<Member> members) { return {.kind = Kind::Object, .members = std::move(members)}; }

const Shape kAccessorIndex = indexInto("/accessors");
const Shape kBufferIndex = indexInto("/buffers");
const Shape kViewIndex = indexInto("/bufferViews");
const Shape kCameraIndex = indexInto("/cameras");
const Shape kImageIndex = indexInto("/images");
const Shape kLightIndex = indexInto("/extensions/KHR_lights_punctual/lights");
const Shape kMaterialIndex = indexInto("/materials");
const Shape kMeshIndex = indexInto("/meshes");
const Shape kNodeIndex = indexInto("/nodes");
const Shape kSamplerIndex = indexInto("/samplers");
const Shape kSceneIndex = indexInto("/scenes");
const Shape kSkinIndex = indexInto("/skins");
const Shape kTextureIndex = indexInto("/textures");
const Shape kVariantIndex = indexInto("/extensions/KHR_materials_variants/variants");

const Shape kFloat2 = arrayOf(kFloat, 2, 2);
const Shape kFloat3 = arrayOf(kFloat, 3, 3);
const Shape kFloat4 = arrayOf(kFloat, 4, 4);
const Shape kNumber3 = arrayOf(kNumber, 3, 3);
const Shape kNumber4 = arrayOf(kNumber, 4, 4);
const Shape kNumber16 = arrayOf(kNumber, 16, 16);
const Shape kFloats = arrayOf(kFloat);
const Shape kNodeIndices = arrayOf(kNodeIndex);
const Shape kJoints = arrayOf(kNodeIndex, 1);

// Geometry
const Shape kAttributes = mapOf(kAccessorIndex);
const Shape kMorphTargets = arrayOf(kAttributes);
const Shape kMode{.kind = Kind::Integer, .choices = {0, 1, 2, 3, 4, 5, 6}};
const Shape kUniqueId{.kind = Kind::Integer, .lower = 0, .upper = 0xffffffff};
const Shape kDracoAttributes = mapOf(kUniqueId);
const Shape kDraco = object({{"bufferView", &kViewIndex, true}, {"attributes", &kDracoAttributes, true}});
const Shape kVariantIndices = arrayOf(kVariantIndex);
const Shape kVariantMapping = object({{"material", &kMaterialIndex, true}, {"variants", &kVariantIndices, true}});
const Shape kVariantMappings = arrayOf(kVariantMapping);
const Shape kPrimitiveVariants = object({{"mappings", &kVariantMappings, true}});
const Shape kPrimitiveExtensions =
    object({{"KHR_draco_mesh_compression", &kDraco}, {"KHR_materials_variants", &kPrimitiveVariants}});
const Shape kPrimitive = object({{"attributes", &kAttributes, true},
                                 {"extensions", &kPrimitiveExtensions},
                                 {"indices", &kAccessorIndex},
                                 {"material", &kMaterialIndex},
                                 {"mode", &kMode},
                                 {"targets", &kMorphTargets}});
const Shape kPrimitives = arrayOf(kPrimitive, 1);
const Shape kMesh = object({{"name", &kString}, {"primitives", &kPrimitives, true}, {"weights", &kFloats}});

const Shape kComponentType{.kind = Kind::Integer, .choices = {5120, 5121, 5122, 5123, 5125, 5126}};
const Shape kIndexComponentType{.kind = Kind::Integer, .choices = {5121, 5123, 5125}};
const Shape kSparseIndices = object(
    {{"bufferView", &kViewIndex, true}, {"byteOffset", &kUnsigned}, {"componentType", &kIndexComponentType, true}});
const Shape kSparseValues = object({{"bufferView", &kViewIndex, true}, {"byteOffset", &kUnsigned}});
const Shape kSparse =
    object({{"count", &kPositive, true}, {"indices", &kSparseIndices, true}, {"values", &kSparseValues, true}});
const Shape kAccessor = object({{"bufferView", &kViewIndex},
                                {"byteOffset", &kUnsigned},
                                {"componentType", &kComponentType, true},
                                {"count", &kPositive, true},
                                {"normalized", &kBool},
                                {"sparse", &kSparse},
                                {"type", &kString, true}});
const Shape kStride{.kind = Kind::Integer, .lower = 4, .upper = 252};
const Shape kMeshoptView = object({{"buffer", &kBufferIndex, true},
                                   {"byteOffset", &kUnsigned},
                                   {"byteLength", &kPositive, true},
                                   {"byteStride", &kPositive, true},
                                   {"count", &kPositive, true},
                                   {"mode", &kString, true},
                                   {"filter", &kString}});
const Shape kViewExtensions =
    object({{"EXT_meshopt_compression", &kMeshoptView}, {"KHR_meshopt_compression", &kMeshoptView}});
const Shape kBufferView = object({{"buffer", &kBufferIndex, true},
                                  {"byteOffset", &kUnsigned},
                                  {"byteLength", &kPositive, true},
                                  {"byteStride", &kStride},
                                  {"extensions", &kViewExtensions}});
const Shape kMeshoptBuffer = object({{"fallback", &kBool}});
const Shape kBufferExtensions =
    object({{"EXT_meshopt_compression", &kMeshoptBuffer}, {"KHR_meshopt_compression", &kMeshoptBuffer}});
const Shape kBuffer = object({{"uri", &kString}, {"byteLength", &kPositive, true}, {"extensions", &kBufferExtensions}});

// Nodes
const Shape kLightReference = object({{"light", &kLightIndex, true}});
const Shape kInstancing = object({{"attributes", &kAttributes, true}});
const Shape kVisibility = object({{"visible", &kBool}});
const Shape kNodeExtensions = object({{"KHR_lights_punctual", &kLightReference},
                                      {"EXT_mesh_gpu_instancing", &kInstancing},
                                      {"KHR_node_visibility", &kVisibility}});
const Shape kNode = object({{"camera", &kCameraIndex},
                            {"children", &kNodeIndices},
                            {"extensions", &kNodeExtensions},
                            {"matrix", &kNumber16},
                            {"mesh", &kMeshIndex},
                            {"name", &kString},
                            {"rotation", &kNumber4},
                            {"scale", &kNumber3},
                            {"skin", &kSkinIndex},
                            {"translation", &kNumber3},
                            {"weights", &kFloats}});
const Shape kScene = object({{"nodes", &kNodeIndices}});
const Shape kSkin = object({{"inverseBindMatrices", &kAccessorIndex}, {"joints", &kJoints, true}});

// Materials
const Shape kTextureTransform =
    object({{"offset", &kFloat2}, {"rotation", &kFloat}, {"scale", &kFloat2}, {"texCoord", &kUvSet}});
const Shape kTextureInfoExtensions = object({{"KHR_texture_transform", &kTextureTransform}});
const Shape kTextureInfo = object({{"index", &kTextureIndex, true},
                                   {"texCoord", &kUvSet},
                                   {"scale", &kFloat},
                                   {"strength", &kFloat},
                                   {"extensions", &kTextureInfoExtensions}});
const Shape kMetallicRoughness = object({{"baseColorFactor", &kFloat4},
                                         {"baseColorTexture", &kTextureInfo},
                                         {"metallicFactor", &kFloat},
                                         {"roughnessFactor", &kFloat},
                                         {"metallicRoughnessTexture", &kTextureInfo}});
const Shape kEmissiveStrength = object({{"emissiveStrength", &kFloat}});
const Shape kIor = object({{"ior", &kFloat}});
const Shape kSpecular = object({{"specularFactor", &kFloat},
                                {"specularTexture", &kTextureInfo},
                                {"specularColorFactor", &kFloat3},
                                {"specularColorTexture", &kTextureInfo}});
const Shape kClearcoat = object({{"clearcoatFactor", &kFloat},
                                 {"clearcoatTexture", &kTextureInfo},
                                 {"clearcoatRoughnessFactor", &kFloat},
                                 {"clearcoatRoughnessTexture", &kTextureInfo},
                                 {"clearcoatNormalTexture", &kTextureInfo}});
const Shape kSheen = object({{"sheenColorFactor", &kFloat3},
                             {"sheenColorTexture", &kTextureInfo},
                             {"sheenRoughnessFactor", &kFloat},
                             {"sheenRoughnessTexture", &kTextureInfo}});
const Shape kAnisotropy =
    object({{"anisotropyStrength", &kFloat}, {"anisotropyRotation", &kFloat}, {"anisotropyTexture", &kTextureInfo}});
const Shape kIridescence = object({{"iridescenceFactor", &kFloat},
                                   {"iridescenceTexture", &kTextureInfo},
                                   {"iridescenceIor", &kFloat},
                                   {"iridescenceThicknessMinimum", &kFloat},
                                   {"iridescenceThicknessMaximum", &kFloat},
                                   {"iridescenceThicknessTexture", &kTextureInfo}});
const Shape kTransmission = object({{"transmissionFactor", &kFloat}, {"transmissionTexture", &kTextureInfo}});
const Shape kDiffuseTransmission = object({{"diffuseTransmissionFactor", &kFloat},
                                           {"diffuseTransmissionTexture", &kTextureInfo},
                                           {"diffuseTransmissionColorFactor", &kFloat3},
                                           {"diffuseTransmissionColorTexture", &kTextureInfo}});
const Shape kVolume = object({{"thicknessFactor", &kFloat},
                              {"thicknessTexture", &kTextureInfo},
                              {"attenuationDistance", &kFloat},
                              {"attenuationColor", &kFloat3}});
const Shape kVolumeScatter = object({{"multiscatterColor", &kFloat3}, {"scatterAnisotropy", &kFloat}});
const Shape kDispersion = object({{"dispersion", &kFloat}});
const Shape kUnlit = object({});
const Shape kSpecularGlossiness = object({{"diffuseFactor", &kFloat4},
                                          {"diffuseTexture", &kTextureInfo},
                                          {"specularFactor", &kFloat3},
                                          {"glossinessFactor", &kFloat},
                                          {"specularGlossinessTexture", &kTextureInfo}});
const Shape kMaterialExtensions = object({{"KHR_materials_anisotropy", &kAnisotropy},
                                          {"KHR_materials_clearcoat", &kClearcoat},
                                          {"KHR_materials_diffuse_transmission", &kDiffuseTransmission},
                                          {"KHR_materials_dispersion", &kDispersion},
                                          {"KHR_materials_emissive_strength", &kEmissiveStrength},
                                          {"KHR_materials_ior", &kIor},
                                          {"KHR_materials_pbrSpecularGlossiness", &kSpecularGlossiness},
                                          {"KHR_materials_iridescence", &kIridescence},
                                          {"KHR_materials_sheen", &kSheen},
                                          {"KHR_materials_specular", &kSpecular},
                                          {"KHR_materials_transmission", &kTransmission},
                                          {"KHR_materials_unlit", &kUnlit},
                                          {"KHR_materials_volume", &kVolume},
                                          {"KHR_materials_volume_scatter", &kVolumeScatter}});
const Shape kMaterial = object({{"name", &kString},
                                {"alphaCutoff", &kFloat},
                                {"alphaMode", &kString},
                                {"doubleSided", &kBool},
                                {"emissiveFactor", &kFloat3},
                                {"emissiveTexture", &kTextureInfo},
                                {"extensions", &kMaterialExtensions},
                                {"normalTexture", &kTextureInfo},
                                {"occlusionTexture", &kTextureInfo},
                                {"pbrMetallicRoughness", &kMetallicRoughness}});
const Shape kTextureSource = object({{"source", &kImageIndex}});
const Shape kTextureExtensions =
    object({{"EXT_texture_webp", &kTextureSource}, {"KHR_texture_basisu", &kTextureSource}});
const Shape kTexture =
    object({{"sampler", &kSamplerIndex}, {"source", &kImageIndex}, {"extensions", &kTextureExtensions}});
const Shape kMagnification{.kind = Kind::Integer, .choices = {9728, 9729}};
const Shape kMinification{.kind = Kind::Integer, .choices = {9728, 9729, 9984, 9985, 9986, 9987}};
const Shape kWrap{.kind = Kind::Integer, .choices = {10497, 33071, 33648}};
const Shape kSampler =
    object({{"magFilter", &kMagnification}, {"minFilter", &kMinification}, {"wrapS", &kWrap}, {"wrapT", &kWrap}});
const Shape kImage =
    object({{"name", &kString}, {"uri", &kString}, {"mimeType", &kString}, {"bufferView", &kViewIndex}});

// Cameras and lights
const Shape kPerspective =
    object({{"aspectRatio", &kNumber}, {"yfov", &kNumber, true}, {"zfar", &kNumber}, {"znear", &kNumber, true}});
const Shape kOrthographic =
    object({{"xmag", &kNumber, true}, {"ymag", &kNumber, true}, {"zfar", &kNumber, true}, {"znear", &kNumber, true}});
const Shape kCamera = object(
    {{"name", &kString}, {"type", &kString, true}, {"perspective", &kPerspective}, {"orthographic", &kOrthographic}});
const Shape kSpot = object({{"innerConeAngle", &kFloat}, {"outerConeAngle", &kFloat}});
const Shape kLight = object({{"name", &kString},
                             {"type", &kString, true},
                             {"color", &kFloat3},
                             {"intensity", &kFloat},
                             {"range", &kFloat},
                             {"spot", &kSpot}});
const Shape kLights = arrayOf(kLight);
const Shape kLightsExtension = object({{"lights", &kLights, true}});
const Shape kVariant = object({{"name", &kString, true}});
const Shape kVariantList = arrayOf(kVariant, 1);
const Shape kVariants = object({{"variants", &kVariantList, true}});
const Shape kRootExtensions =
    object({{"KHR_lights_punctual", &kLightsExtension}, {"KHR_materials_variants", &kVariants}});

// The root
const Shape kAccessors = arrayOf(kAccessor);
const Shape kBuffers = arrayOf(kBuffer);
const Shape kBufferViews = arrayOf(kBufferView);
const Shape kCameras = arrayOf(kCamera);
const Shape kImages = arrayOf(kImage);
const Shape kMaterials = arrayOf(kMaterial);
const Shape kMeshes = arrayOf(kMesh);
const Shape kNodes = arrayOf(kNode);
const Shape kSamplers = arrayOf(kSampler);
const Shape kScenes = arrayOf(kScene);
const Shape kSkins = arrayOf(kSkin);
const Shape kTextures = arrayOf(kTexture);
const Shape kAnyArray{.kind = Kind::Array, .lower = 0, .upper = static_cast<double>(kMaxArrayItems)};
const Shape kRoot = object({{"accessors", &kAccessors},
                            {"animations", &kAnyArray},
                            {"buffers", &kBuffers},
                            {"bufferViews", &kBufferViews},
                            {"cameras", &kCameras},
                            {"extensions", &kRootExtensions},
                            {"images", &kImages},
                            {"materials", &kMaterials},
                            {"meshes", &kMeshes},
                            {"nodes", &kNodes},
                            {"samplers", &kSamplers},
                            {"scene", &kSceneIndex},
                            {"scenes", &kScenes},
                            {"skins", &kSkins},
                            {"textures", &kTextures}});

class Checker {
public:
  Checker(const std::string& file, const Json& root) : file_(file), root_(root) {}

  void check(const Json& value, const Shape& shape) {
    switch (shape.kind) {
    case Kind::Any:
      return;
    case Kind::Bool:
      return require(value.is_boolean(), "true or false", value);
    case Kind::String:
      return require(value.is_string(), "a string", value);
    case Kind::Number:
      return checkNumber(value, shape);
    case Kind::Integer:
      return checkInteger(value, shape);
    case Kind::Index:
      return checkIndex(value, shape);
    case Kind::Array:
      return checkArray(value, shape);
    case Kind::Object:
      return checkObject(value, shape);
    case Kind::Map:
      return checkMap(value, shape);
    }
  }

private:
  /// A step from the root to the value: a member's name, or an array index where the name is null.
  struct Step {
    const char* name;
    size_t index;
  };

  void require(bool holds, std::string_view expected, const Json& found) const {
    if (!holds) fail(expected, found);
  }

  /// RFC 6901, section 3.
  static std::string escaped(std::string_view name) {
    std::string result;
    for (const char c : name) {
      if (c == '~') {
        result += "~0";
      } else if (c == '/') {
        result += "~1";
      } else {
        result += c;
      }
    }
    return result;
  }

  [[noreturn]] void fail(std::string_view expected, const Json& found) const {
    std::string shown = found.is_structured() ? found.type_name() : found.dump(-1, ' ', true);
    constexpr size_t kShownLength = 60;
    if (shown.size() > kShownLength) shown = shown.substr(0, kShownLength) + "...";
    std::string pointer;
    for (const Step& step : path_) pointer += '/' + (step.name ? escaped(step.name) : std::to_string(step.index));
    throw SceneError(file_, pointer, fmt::format("{}, found {}", expected, shown));
  }

  void checkNumber(const Json& value, const Shape& shape) const {
    require(value.is_number(), "a number", value);
    const double number = value.get<double>();
    if (!(number >= shape.lower && number <= shape.upper)) {
      fail(fmt::format("a number in [{}, {}]", shape.lower, shape.upper), value);
    }
  }

  void checkInteger(const Json& value, const Shape& shape) const {
    require(value.is_number_integer(), "an integer", value);
    const double number = value.get<double>(); // only compared with bounds that double holds exactly
    if (shape.choices.empty()) {
      if (number < shape.lower) fail(fmt::format("an integer of at least {:.0f}", shape.lower), value);
      if (number > shape.upper) fail(fmt::format("an integer of at most {:.0f}", shape.upper), value);
      return;
    }
    for (const double choice : shape.choices) {
      if (number == choice) return; // exact: both are small integers
    }
    fail(fmt::format("one of {}", fmt::join(shape.choices, ", ")), value);
  }

  size_t targetCount(const Shape& shape) {
    const auto [found, isNew] = targetCounts_.try_emplace(&shape, 0);
    const Json::json_pointer pointer(shape.target);
    if (isNew && root_.contains(pointer)) found->second = root_.at(pointer).size();
    return found->second;
  }

  void checkIndex(const Json& value, const Shape& shape) {
    const size_t count = targetCount(shape);
    if (!value.is_number_unsigned() || value.get<uint64_t>() >= count) {
      fail(fmt::format("an index into {} with {} items (UNRESOLVED_REFERENCE)", shape.target, count), value);
    }
  }

  void checkArray(const Json& value, const Shape& shape) {
    require(value.is_array(), "an array", value);
    const double count = static_cast<double>(value.size());
    if (count < shape.lower || count > shape.upper) {
      const std::string most = shape.lower == shape.upper ? "exactly" : "at least";
      fail(fmt::format("an array of {} {:.0f} items, not {}", most, shape.lower, value.size()), value);
    }
    if (!shape.item) return;
    path_.push_back({nullptr, 0});
    for (size_t i = 0; i < value.size(); ++i) {
      path_.back().index = i;
      check(value[i], *shape.item);
    }
    path_.pop_back();
  }

  void checkObject(const Json& value, const Shape& shape) {
    require(value.is_object(), "an object", value);
    for (const Member& expected : shape.members) {
      const Json* found = member(value, expected.name);
      if (!found && expected.required) fail(fmt::format("a member \"{}\"", expected.name), value);
      if (!found) continue;
      path_.push_back({expected.name, 0});
      check(*found, *expected.shape);
      path_.pop_back();
    }
    checkExtensionsAreObject(value);
  }

  /// Also where no shape says what is inside.
  void checkExtensionsAreObject(const Json& value) {
    const Json* extensions = member(value, "extensions");
    if (!extensions) return;
    path_.push_back({"extensions", 0});
    require(extensions->is_object(), "an object", *extensions);
    path_.pop_back();
  }

  void checkMap(const Json& value, const Shape& shape) {
    require(value.is_object(), "an object", value);
    for (const auto& [name, item] : value.items()) {
      path_.push_back({name.c_str(), 0});
      check(item, *shape.item);
      path_.pop_back();
    }
  }

  const std::string& file_;
  const Json& root_;
  std::vector<Step> path_;
  std::unordered_map<const Shape*, size_t> targetCounts_; ///< of Index shapes
};

} // namespace

void checkSchema(const std::string& file, const Json& root) { Checker(file, root).check(root, kRoot); }

} // namespace isophote::gltf
