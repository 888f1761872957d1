#include "trade/study_files.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "isophote/version.hpp"

namespace isophote::cli {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: what is not known is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json intervalJson(const Interval& interval) {
  return {{"value", number(interval.value)}, {"interval", {number(interval.lower), number(interval.upper)}}};
}

Json splitJson(const ErrorSplit& split) {
  return {{"noise_square", intervalJson(split.noiseSquare)},
          {"bias_square", intervalJson(split.biasSquare)},
          {"bias_deviations", split.biasDeviations},
          {"brightness", intervalJson(split.brightness)},
          {"brightness_deviations", split.brightnessDeviations}};
}

Json changesJson(const Configuration& configuration) {
  Json json = Json::object();
  for (const Change& change : configuration.changes) json[change.key] = change.value;
  return json;
}

Json runsJson(const Measurement& m) {
  Json list = Json::array();
  for (const Run& run : m.runs) {
    list.push_back({{"round", run.round},
                    {"seed", run.seed},
                    {"samples", run.samples},
                    {"seconds", run.seconds},
                    {"noise_square", run.noiseSquare}});
  }
  return list;
}

Json measurementJson(const Study& study, size_t index) {
  const Measurement& m = study.measurements[index];
  Json json = {{"name", m.configuration.name()},
               {"settings", changesJson(m.configuration)},
               {"state", stateName(m)},
               {"declared_unbiased", m.declaredUnbiased},
               {"layer", m.configuration.denoised() ? "denoised" : "image"}};
  if (m.state == MeasurementState::Refused) json["reason"] = m.reason;
  if (!m.measured()) return json;
  const Price price = priceOf(m, study.exact());
  json["seconds"] = intervalJson(m.seconds());
  json.update(splitJson(m.split));
  json["bias_seen"] = study.biasSeen(m);
  json["cost"] = number(study.tradeOff(index).cost);
  json["on_front"] = std::find(study.front.begin(), study.front.end(), index) != study.front.end();
  json["relative_to_exact"] = {{"seconds", intervalJson(price.seconds)},
                               {"noise_square", intervalJson(price.noise)},
                               {"seconds_to_the_same_noise", intervalJson(price.cost)}};
  json["runs"] = runsJson(m);
  return json;
}

Json recommendationJson(const Study& study, const Recommendation& r, const StudyContext& context) {
  Json json = {{"purpose", r.purpose},
               {"target_error", r.targetError},
               {"settings", changesJson(study.measurements[r.measurement].configuration)},
               {"samples", r.samples},
               {"seconds_forecast", number(r.seconds)},
               {"command", commandLine(study, r, context)}};
  if (!r.tried()) {
    json["confirmation"] = nullptr;
    return json;
  }
  json["confirmation"] = {{"confirmed", r.confirmed()},
                          {"runs", r.found.runs},
                          {"samples", r.confirmedSamples},
                          {"error_forecast", r.forecastError},
                          {"error", rootOf(r.found.totalSquare.value)},
                          {"error_interval", {rootOf(r.found.totalSquare.lower), rootOf(r.found.totalSquare.upper)}},
                          {"seconds_forecast", r.forecastSeconds},
                          {"seconds", intervalJson(r.foundSeconds)}};
  return json;
}

} // namespace

double rootOf(double square) { return std::sqrt(std::max(square, 0.0)); }

const char* stateName(const Measurement& measurement) {
  switch (measurement.state) {
  case MeasurementState::Planned:
    return "not measured";
  case MeasurementState::Measured:
    return measurement.measured() ? "measured" : "not measured";
  case MeasurementState::NoEffect:
    return "no effect";
  case MeasurementState::Refused:
    return "refused";
  }
  return "";
}

std::string shellWord(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string("-_./:=,+%").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string commandLine(const Study& study, const Recommendation& r, const StudyContext& context) {
  std::string text = fmt::format("isophote render {}{} -o {}.exr --spp {}", shellWord(context.scene),
                                 context.sceneFlags, r.purpose, r.samples);
  for (const Change& change : study.measurements[r.measurement].configuration.changes)
    text += fmt::format(" --set {}", shellWord(change.key + "=" + change.value));
  return text;
}

Json studyJson(const Study& study, const StudyContext& context) {
  Json measurements = Json::array();
  for (size_t i = 0; i < study.measurements.size(); ++i) measurements.push_back(measurementJson(study, i));
  Json recommendations = Json::array();
  for (const Recommendation& r : study.recommendations)
    recommendations.push_back(recommendationJson(study, r, context));
  const Reference& reference = study.reference;
  return {{"schema", 1},
          {"version", kVersion},
          {"scene", context.scene},
          {"device", context.device},
          {"driver", context.driver},
          {"image", {{"width", context.width}, {"height", context.height}}},
          {"metric", "mean over pixels and channels of d^2 / (reference^2 + (1% of its mean luminance)^2)"},
          {"budget_seconds", context.budgetSeconds},
          {"seconds", study.seconds},
          {"compile_seconds", study.compileSeconds},
          {"interrupted", study.interrupted},
          {"reference",
           {{"source", reference.source},
            {"samples", reference.samples},
            {"seconds", reference.seconds},
            {"error", rootOf(reference.square)},
            {"untrusted_share", reference.untrustedShare},
            {"good_enough", reference.goodEnough}}},
          {"samples_per_run", study.samplesPerRun},
          {"configurations", measurements},
          {"recommendations", recommendations}};
}

std::string studyCsv(const Study& study) {
  std::string text =
      "configuration,state,runs,samples,seconds,seconds_lower,seconds_upper,noise_rms,noise_square,"
      "noise_square_lower,noise_square_upper,bias_square,bias_square_lower,bias_square_upper,brightness,"
      "brightness_lower,brightness_upper,bias_seen,declared_unbiased,relative_seconds,relative_noise_square,"
      "relative_seconds_to_the_same_noise,relative_lower,relative_upper\n";
  for (const Measurement& m : study.measurements) {
    text += fmt::format("{},{}", m.configuration.name(), stateName(m));
    if (!m.measured()) {
      text += std::string(22, ',') + "\n";
      continue;
    }
    const Price price = priceOf(m, study.exact());
    const auto interval = [&](const Interval& i) {
      text += fmt::format(",{:.6g},{:.6g},{:.6g}", i.value, i.lower, i.upper);
    };
    text += fmt::format(",{},{}", m.runs.size(), m.samples());
    interval(m.seconds());
    text += fmt::format(",{:.6g}", rootOf(m.split.noiseSquare.value));
    interval(m.split.noiseSquare);
    interval(m.split.biasSquare);
    interval(m.split.brightness);
    text += fmt::format(",{},{},{:.6g},{:.6g}", study.biasSeen(m) ? 1 : 0, m.declaredUnbiased ? 1 : 0,
                        price.seconds.value, price.noise.value);
    interval(price.cost);
    text += "\n";
  }
  return text;
}

} // namespace isophote::cli
