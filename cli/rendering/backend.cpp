#include "rendering/backend.hpp"

#include "isophote/error.hpp"
#include "parse.hpp"

namespace isophote::cli {

const char* backendName(Backend backend) { return backend == Backend::RayQuery ? "ray-query" : "compute"; }

Backend backendFromName(const std::string& name) {
  if (name == "compute") return Backend::Compute;
  if (name == "ray-query") return Backend::RayQuery;
  throw UsageError("'" + name + "' is neither compute nor ray-query");
}

void addBackendFlag(CLI::App& command, Backend& backend) {
  addValue(
      command, "--backend", "NAME", [&backend](const std::string& text) { backend = backendFromName(text); },
      "Who finds what rays meet: compute (own BVH, default) or ray-query (the device, where it has VK_KHR_ray_query)");
}

} // namespace isophote::cli
