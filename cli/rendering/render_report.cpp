#include "rendering/render_report.hpp"

#include <fmt/format.h>

#include "isophote/version.hpp"
#include "rendering/backend.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;

double totalRays(const RenderStatistics& statistics) {
  return static_cast<double>(statistics.primaryRays + statistics.bounceRays + statistics.shadowRays);
}

Json errorJson(const ErrorEstimate& error) {
  Json json = {{"metric", "relative RMS"}};
  if (!error.known) {
    json["value"] = nullptr; // fewer than two replicates hold samples
    return json;
  }
  json["value"] = error.value;
  json["interval"] = {error.lower, error.upper};
  json["confidence"] = error.confidence;
  json["untrusted_share"] = error.untrustedShare;
  return json;
}

Json intervalJson(const Interval& interval) { return {interval.value, interval.lower, interval.upper}; }

/// The target error and each look at the error, with the forecast that was made then: [value, lower, upper].
Json targetJson(const StopRule& rule, const RenderResult& result) {
  if (!rule.target) return nullptr;
  Json looks = Json::array();
  for (const Look& look : result.looks) {
    Json entry = {{"spp", look.samples}, {"seconds", look.seconds}};
    if (look.error.known) {
      entry["error"] = intervalJson({look.error.value, look.error.lower, look.error.upper});
      entry["forecast_spp"] = intervalJson(look.samplesToTarget);
      entry["forecast_seconds"] = intervalJson(look.secondsToTarget);
    }
    looks.push_back(entry);
  }
  return {{"error", *rule.target},
          {"confidence", rule.confidence},
          {"reached", reached(rule.errorTarget(), result.error)},
          {"looks", looks}};
}

/// How the samples were shared out.
Json adaptiveJson(const std::optional<AdaptivePlan>& plan) {
  if (!plan) return nullptr;
  Json classes = Json::array();
  for (uint32_t c = 0; c < SampleAllocation::kClasses; ++c)
    classes.push_back({{"weight", SampleAllocation::weight(c)}, {"pixels", plan->allocation.pixels[c].size()}});
  return {{"pilot_spp", plan->pilotSamples},
          {"pilot_seconds", plan->pilotSeconds},
          {"classes", classes},
          {"expected_gain", plan->allocation.expectedGain}};
}

Json kernelsJson(const RenderStatistics& statistics) {
  Json list = Json::array();
  for (const KernelStatistics& kernel : statistics.kernels) {
    list.push_back({{"name", kernel.name},
                    {"dispatches", kernel.dispatches},
                    {"ms", kernel.milliseconds},
                    {"longest_ms", kernel.longestMilliseconds},
                    {"compile_ms", kernel.compileMilliseconds},
                    {"spirv_bytes", kernel.spirvBytes}});
  }
  return list;
}

Json pipelineJson(const RenderStatistics& statistics) {
  const auto work = [](const PipelineStatistics& done) {
    return Json{
        {"submits", done.submits},
        {"rays", done.rays},
        {"ms", done.milliseconds},
        {"mrays_per_s", done.milliseconds > 0 ? static_cast<double>(done.rays) / done.milliseconds * 1e-3 : 0.0},
        {"paths_in_flight", done.pathsInFlight},
        {"paths_in_flight_settled", done.pathsInFlightAreSettled}};
  };
  return {{"in_use", statistics.pipeline == Pipeline::Fused ? "fused" : "wavefront"},
          {"settled", statistics.pipelineIsSettled},
          {"wavefront", work(statistics.wavefront)},
          {"fused", work(statistics.fused)}};
}

Json buffersJson(const RenderReport& report) {
  Json list = Json::array();
  for (const auto* uses : {&report.sceneStatistics.buffers, &report.statistics.buffers}) {
    for (const BufferUse& use : *uses) list.push_back({{"name", use.name}, {"bytes", use.bytes}});
  }
  return list;
}

Json leftOutJson(const FeatureSet& features) {
  Json list = Json::array();
  for (const FeatureDescription& description : allFeatures()) {
    if (!features.has(description.feature))
      list.push_back({{"feature", description.name}, {"omitted", description.omitted}});
  }
  return list;
}

/// 1 / (variance * time): what a method is worth, whatever the time spent.
Json figureOfMerit(const RenderResult& result) {
  if (!result.error.known || !(result.error.value > 0) || !(result.seconds > 0)) return nullptr;
  return 1 / (result.error.value * result.error.value * result.seconds);
}

/// The settings that bias the image, and the samples that were lost.
Json ledgerJson(const RenderReport& report) {
  Json ledger = biasJson(report.settings);
  enterAccount(report.bias, ledger);
  const StatusCounters& status = report.statistics.status;
  const uint64_t samples = report.statistics.primaryRays;
  const uint64_t lost = status.nonFinite + status.negative + status.clipped;
  if (lost > 0) ledger["dropped-samples"] = {{"count", lost}, {"of", samples}, {"exact", 0}};
  return ledger;
}

Json sizeJson(const RenderReport& report) {
  return {{"width", report.view.width},
          {"height", report.view.height},
          {"crop", {report.crop.x0, report.crop.y0, report.crop.x1, report.crop.y1}}};
}

const char* outcomeName(Outcome outcome) {
  switch (outcome) {
  case Outcome::Completed:
    return "completed";
  case Outcome::BudgetEnded:
    return "budget ended";
  case Outcome::Interrupted:
    return "interrupted";
  }
  return "";
}

/// What was asked for: the estimator's settings, the image, the camera and the light around the scene.
Json requestJson(const RenderReport& report) {
  Json settings = settingsJson(report.settings, SettingKind::Estimator);
  settings["image"] = sizeJson(report);
  settings["camera"] = report.view.framing ? Json(nullptr) : Json(report.view.camera.name);
  if (!report.view.framing) settings["camera_index"] = report.view.cameraIndex;
  const Camera& camera = report.view.camera;
  if (camera.kind == CameraKind::Panorama) settings["panorama"] = true;
  if (camera.hasLens()) {
    settings["lens"] = {{"radius", camera.lensRadius},
                        {"focus_distance", camera.focusDistance},
                        {"aperture_blades", camera.apertureBlades}};
  }
  settings["environment"] = report.environment;
  if (report.variant) settings["variant"] = *report.variant;
  if (report.adaptive) settings["adaptive"] = true;
  if (report.sceneStatistics.backend != Backend::Compute)
    settings["backend"] = backendName(report.sceneStatistics.backend);
  if (report.settings.scene.bvhBuild != BvhBuild::FastTrace) settings["bvh-build"] = "fast-build";
  return settings;
}

std::string dump(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

} // namespace

std::string errorText(const ErrorEstimate& error) { return dump(errorJson(error)); }

Json statusJson(const StatusCounters& status) {
  return {{"queue_overflow", status.queueOverflow},
          {"stack_overflow", status.stackOverflow},
          {"non_finite", status.nonFinite},
          {"negative", status.negative},
          {"clipped", status.clipped},
          {"out_of_bounds", status.outOfBounds},
          {"medium_overflow", status.mediumOverflow}};
}

Json statsJson(const RenderReport& report) {
  const RenderStatistics& render = report.statistics;
  const SceneStatistics& scene = report.sceneStatistics;
  const double seconds = report.seconds.device;
  Json bindings = Json::array();
  if (render.textureBinding) bindings.push_back({{"name", "textures"}, {"set", 0}, {"binding", 0}});
  return {{"schema", 1},
          {"scene", report.scene},
          {"device", report.device.name},
          {"driver", report.device.driver},
          {"backend", backendName(scene.backend)},
          {"features", report.features.names()},
          {"pipeline", pipelineJson(render)},
          {"kernels", kernelsJson(render)},
          {"rays", {{"primary", render.primaryRays}, {"bounce", render.bounceRays}, {"shadow", render.shadowRays}}},
          {"mrays_per_s", seconds > 0 ? totalRays(render) / seconds * 1e-6 : 0.0},
          {"camera_media", render.cameraMedia},
          {"spp", report.samplesPerPixel},
          {"seconds",
           {{"load", report.seconds.load},
            {"bvh", report.seconds.bvh},
            {"upload", report.seconds.upload},
            {"compile", report.seconds.compile},
            {"render", report.seconds.render},
            {"device", seconds},
            {"denoise", report.seconds.denoise},
            {"write", report.seconds.write},
            {"first_pixel", render.firstPixelSeconds}}},
          {"memory",
           {{"scene_bytes", scene.sceneBytes},
            {"texture_bytes", scene.textureBytes},
            {"bvh_bytes", scene.bvhBytes},
            {"queue_bytes", render.queueBytes},
            {"film_bytes", report.filmBytes},
            {"bytes_per_path", render.bytesPerPath}}},
          {"bvh",
           {{"triangles", scene.triangles},
            {"instanced_triangles", scene.instancedTriangles},
            {"nodes", scene.bvhNodes},
            {"sah_cost", scene.sahCost},
            {"max_depth", scene.bvhMaxDepth}}},
          {"error", errorJson(report.result.error)},
          {"target", targetJson(report.rule, report.result)},
          {"adaptive", adaptiveJson(report.adaptive)},
          {"bias", ledgerJson(report)},
          {"status", statusJson(render.status)},
          {"figure_of_merit", figureOfMerit(report.result)},
          {"outcome", outcomeName(report.result.outcome)},
          {"image", sizeJson(report)},
          {"sample_range", {report.samples.first, report.samples.last}},
          {"settings", settingsJson(report.settings, SettingKind::Estimator)},
          {"execution", settingsJson(report.settings, SettingKind::Execution)},
          {"path_pool_size", render.pathPoolSize},
          {"workgroup_size", render.workgroupSize},
          {"buffers", buffersJson(report)},
          {"bindings", bindings},
          {"scene_features_left_out", leftOutJson(report.features)}};
}

std::string sampleIdentity(const RenderReport& report, uint32_t firstSample) {
  Json identity = {{"version", kVersion},
                   {"scene", report.sceneHash},
                   {"device", report.device.name},
                   {"driver", report.device.driver},
                   {"seed", report.settings.estimator.seed},
                   {"first_sample", firstSample}};
  identity.update(requestJson(report));
  return dump(identity);
}

std::map<std::string, std::string> imageAttributes(const RenderReport& report) {
  Json request = requestJson(report);
  if (report.settings.layers.denoiser != Denoiser::None)
    request.update(settingsJson(report.settings, SettingKind::Layer));
  return {{"isophote.version", kVersion},
          {"isophote.scene", report.scene},
          {"isophote.sceneHash", report.sceneHash},
          {"isophote.settings", dump(request)},
          {"isophote.device", fmt::format("{}, {}", report.device.name, report.device.driver)},
          {"isophote.features", dump(report.features.names())},
          {"isophote.seed", std::to_string(report.settings.estimator.seed)},
          {"isophote.sampleRange", fmt::format("{}:{}", report.samples.first, report.samples.last)},
          {"isophote.error", errorText(report.result.error)},
          {"isophote.bias", dump(ledgerJson(report))},
          {"isophote.status", dump(statusJson(report.statistics.status))}};
}

} // namespace isophote::cli
