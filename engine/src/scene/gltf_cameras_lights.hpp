// Cameras and KHR_lights_punctual lights, placed by their nodes.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "isophote/scene.hpp"
#include "scene/gltf_document.hpp"

namespace isophote::gltf {

/// Every camera of the document, at the origin.
/// @throws SceneError where one cannot project: yfov outside (0, pi), aspect 0, znear >= zfar, ...
[[nodiscard]] std::vector<Camera> readCameras(Document& document);

/// The camera with the position and orientation of a transform; its scale and mirroring are left out, as glTF says.
[[nodiscard]] Camera placed(const Camera& camera, const glm::dmat4& worldFromNode);

/// Every light of the document, at the origin. Values outside their range are clamped, with a warning.
/// @throws SceneError on unknown types
[[nodiscard]] std::vector<PunctualLight> readLights(Document& document);

/// Nothing where the transform squashes the light's direction to zero.
[[nodiscard]] std::optional<PunctualLight> placed(const PunctualLight& light, const glm::dmat4& worldFromNode);

} // namespace isophote::gltf
