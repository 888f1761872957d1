#include "rendering/bias_ledger.hpp"

#include <numeric>
#include <string>

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;

double channelMean(const Image& image, const std::string& name) {
  const Channel* channel = image.find(name);
  if (channel == nullptr || channel->values.empty()) return 0;
  return std::accumulate(channel->values.begin(), channel->values.end(), 0.0) / double(channel->values.size());
}

/// Of the channels R, G, B after `prefix`.
glm::dvec3 colorMean(const Image& image, const std::string& prefix) {
  return {channelMean(image, prefix + "R"), channelMean(image, prefix + "G"), channelMean(image, prefix + "B")};
}

double sum(const glm::dvec3& color) { return color.r + color.g + color.b; }

} // namespace

BiasAccount biasAccount(const Image& image) {
  BiasAccount account{.kept = colorMean(image, ""), .clamped = colorMean(image, "clamped.")};
  if (image.find("beyond.R") != nullptr) account.beyond = colorMean(image, "beyond.");
  if (image.find("denoised.R") != nullptr) account.undenoised = account.kept - colorMean(image, "denoised.");
  return account;
}

void enterAccount(const BiasAccount& account, Json& ledger) {
  const double whole = sum(account.kept) + sum(account.clamped) + sum(account.beyond.value_or(glm::dvec3(0)));
  const auto enter = [&](const char* setting, const glm::dvec3& removed, const char* layer) {
    if (!ledger.contains(setting)) return;
    Json& entry = ledger[setting];
    entry["removed"] = {removed.r, removed.g, removed.b};
    entry["removed_share"] = whole > 0 ? sum(removed) / whole : 0.0;
    entry["layer"] = layer;
  };
  enter("clamp", account.clamped, "clamped.{R,G,B}");
  if (account.beyond) enter("max-depth", *account.beyond, "beyond.{R,G,B}");
  enter("denoiser", account.undenoised, "denoised.{R,G,B}");
}

} // namespace isophote::cli
