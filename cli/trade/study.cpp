#include "trade/study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "isophote/error.hpp"
#include "rendering/interrupt.hpp"
#include "shared/film_types.h"

namespace isophote::cli {
namespace {

// Of the whole time, for compiling the kernels of all configurations; those that are not reached are not measured.
constexpr double kProbeShare = 0.45;
// Shares of the time that is left then; what remains is for the confirmation.
constexpr double kReferenceShare = 0.3;
constexpr double kSinglesShare = 0.35;
constexpr double kSearchShare = 0.2;

constexpr uint32_t kProbeSamples = gpu::kReplicateCount;
constexpr uint32_t kPlannedRounds = 5;
constexpr uint32_t kFewestRounds = 3; // two give intervals that say nothing
constexpr uint32_t kMostRounds = 16;
constexpr uint32_t kSearchRounds = 6;
constexpr size_t kSearchBatch = 2; // combinations that are measured side by side
constexpr uint32_t kMostSamples = 1u << 14;
constexpr double kWorstReference = 0.01; // mean square: a tenth
constexpr double kReferenceGain = 400;   // the reference need not be better than a run's mean square by more

constexpr uint64_t kProbeSeed = 0x70726f6265;         // none of the runs', which count from 1
constexpr uint64_t kReferenceSeed = 0x7265666572656e; // likewise

/// Whole rounds over the replicates, within reason.
uint32_t wholeSamples(double samples) {
  const double rounds = std::floor(samples / gpu::kReplicateCount);
  return static_cast<uint32_t>(std::clamp(rounds, 1.0, double(kMostSamples) / gpu::kReplicateCount)) *
         gpu::kReplicateCount;
}

bool sameColors(const Image& a, const Image& b) {
  constexpr std::array<const char*, 3> kColors = {"R", "G", "B"};
  return std::all_of(kColors.begin(), kColors.end(),
                     [&](const char* name) { return a.find(name)->values == b.find(name)->values; });
}

class StudyRunner {
public:
  StudyRunner(Workbench& bench, const StudyPlan& plan, const std::function<double()>& elapsed,
              const StudyProgress& progress)
      : bench_(bench), plan_(plan), elapsed_(elapsed), progress_(progress) {}

  Study run() {
    study_.measurements.push_back({.configuration = {}});
    for (const Configuration& configuration : singleChanges(plan_.settings)) {
      study_.measurements.push_back(
          {.configuration = configuration, .declaredUnbiased = configuration.declaredUnbiased()});
    }
    probe();
    const double left = plan_.seconds - elapsed_();
    chooseSamples(kSinglesShare * left);
    makeReference(elapsed_() + kReferenceShare * left);
    measureSingles(elapsed_() + kSinglesShare * left);
    search(elapsed_() + kSearchShare * left);
    study_.front = front();
    study_.recommendations = recommend(study_);
    confirm();
    study_.seconds = elapsed_();
    study_.compileSeconds = bench_.compileSeconds();
    study_.interrupted = interrupted();
    return std::move(study_);
  }

private:
  [[nodiscard]] bool timeLeft(double deadline) const {
    return !interrupted() && elapsed_() < std::min(deadline, plan_.seconds);
  }

  std::vector<size_t> active() const {
    std::vector<size_t> list;
    for (size_t i = 0; i < study_.measurements.size(); ++i) {
      const MeasurementState state = study_.measurements[i].state;
      const bool usable = state == MeasurementState::Planned || state == MeasurementState::Measured;
      if (usable && secondsPerSample_[i] > 0) list.push_back(i);
    }
    return list;
  }

  /// Every configuration once with one seed: which do not go together, which change nothing, and how long they take.
  void probe() {
    std::optional<BenchRender> exact;
    secondsPerSample_.assign(study_.measurements.size(), 0);
    for (size_t i = 0; i < study_.measurements.size() && !interrupted(); ++i) {
      // What was asked for by name is measured whatever it takes.
      if (i > 0 && plan_.settings.empty() && !timeLeft(kProbeShare * plan_.seconds)) return;
      Measurement& m = study_.measurements[i];
      progress_(fmt::format("trying {} of {} settings", i, study_.measurements.size() - 1));
      try {
        const Settings settings = m.configuration.settings();
        const auto result = bench_.render(settings, kProbeSeed, {0, kProbeSamples});
        if (!result) return;
        secondsPerSample_[i] = result->seconds / kProbeSamples;
        if (i == 0) {
          exact = result;
          probeSquare_ = result->error.value * result->error.value;
        } else if (!m.configuration.executionOnly() && sameColors(result->image, exact->image)) {
          m.state = MeasurementState::NoEffect;
        }
      } catch (const UsageError& error) {
        m.state = MeasurementState::Refused;
        m.reason = error.what();
      }
    }
  }

  /// So that the planned rounds take `seconds`. A render takes some time whatever its samples; how much, a second probe
  /// of the exact settings tells, and the others are taken to be alike.
  void chooseSamples(double seconds) {
    study_.samplesPerRun = kProbeSamples;
    constexpr uint32_t kMore = 8 * kProbeSamples;
    const auto result = bench_.render(Settings{}, kProbeSeed, {0, kMore});
    if (!result) return;
    const double first = secondsPerSample_[0] * kProbeSamples;
    const double grown = (result->seconds - first) / (kMore - kProbeSamples) / secondsPerSample_[0];
    const double share = std::clamp(grown, 0.02, 1.0); // of the first probe's time that more samples multiply
    double fixed = 0;
    double perSample = 0;
    for (const size_t i : active()) {
      fixed += (1 - share) * secondsPerSample_[i] * kProbeSamples;
      perSample += share * secondsPerSample_[i];
    }
    if (perSample > 0) study_.samplesPerRun = wholeSamples((seconds / kPlannedRounds - fixed) / perSample);
  }

  void makeReference(double deadline) {
    Reference& reference = study_.reference;
    if (plan_.reference) {
      reference.source = plan_.referenceFile;
      reference.image = *plan_.reference;
    } else {
      reference.source = "rendered";
      renderReference(deadline);
    }
    if (reference.image.channels.empty()) return; // interrupted at once
    splitter_.emplace(reference.image);
    reference.square = splitter_->referenceSquare();
    const double runSquare = probeSquare_ * kProbeSamples / study_.samplesPerRun;
    reference.goodEnough = reference.square <= std::min(runSquare / kPlannedRounds, kWorstReference);
  }

  void renderReference(double deadline) {
    Reference& reference = study_.reference;
    const Settings exact;
    Film film = bench_.makeFilm();
    const double start = elapsed_();
    uint32_t next = 2 * study_.samplesPerRun;
    while (next > 0 && (reference.samples == 0 ? !interrupted() : timeLeft(deadline))) {
      progress_(fmt::format("reference, {} samples a pixel", reference.samples));
      const bool whole = bench_.renderMore(exact, kReferenceSeed, {reference.samples, reference.samples + next}, film);
      if (!whole) break; // pixels now differ in their number of samples, which their error bars know
      reference.samples += next;
      const ErrorEstimate error = film.error();
      const double wanted = probeSquare_ * kProbeSamples / study_.samplesPerRun / kReferenceGain;
      if (error.known && error.value * error.value <= wanted) break;
      const double rate = reference.samples / std::max(elapsed_() - start, 1e-9);
      const double fitting = std::min(double(reference.samples), rate * (deadline - elapsed_()));
      next = fitting >= gpu::kReplicateCount ? wholeSamples(fitting) : 0;
    }
    if (reference.samples == 0) return;
    reference.seconds = elapsed_() - start;
    reference.untrustedShare = film.error().untrustedShare;
    reference.image = film.resolve();
  }

  /// One more run of a configuration; false where it was ended.
  bool measure(size_t index, uint32_t round) {
    Measurement& m = study_.measurements[index];
    const uint64_t seed = nextSeed_++;
    const auto result = bench_.render(m.configuration.settings(), seed, {0, study_.samplesPerRun});
    if (!result) return false;
    if (!m.splitter) m.splitter = splitter_;
    m.splitter->add(result->image);
    m.split = m.splitter->split();
    m.state = MeasurementState::Measured;
    m.runs.push_back({.round = round, .seed = seed, .samples = study_.samplesPerRun, .seconds = result->seconds});
    // Without error bars the second run tells the noise of the first, too.
    for (size_t run = 0; run < m.runs.size(); ++run) m.runs[run].noiseSquare = m.splitter->noiseSquares()[run];
    return true;
  }

  /// Each configuration once, from another one on in each round, so that none profits from its place.
  bool measureRound(const std::vector<size_t>& configurations, const std::string& stage) {
    const uint32_t round = round_++;
    for (size_t i = 0; i < configurations.size(); ++i) {
      progress_(fmt::format("{}, run {} of {}", stage, i + 1, configurations.size()));
      if (!measure(configurations[(i + round) % configurations.size()], round)) return false;
    }
    return true;
  }

  void measureSingles(double deadline) {
    if (!splitter_) return;
    const std::vector<size_t> configurations = active();
    double roundSeconds = 0;
    for (uint32_t round = 0; round < kMostRounds && !interrupted(); ++round) {
      if (round >= kFewestRounds && elapsed_() + roundSeconds > deadline) return;
      const double start = elapsed_();
      if (!measureRound(configurations, fmt::format("one setting at a time, round {}", round + 1))) return;
      roundSeconds = elapsed_() - start;
      runSeconds_ = roundSeconds / static_cast<double>(configurations.size());
    }
  }

  /// What the search is among.
  std::vector<size_t> measuredWays() const {
    std::vector<size_t> list;
    for (size_t i = 0; i < study_.measurements.size(); ++i) {
      const Measurement& m = study_.measurements[i];
      if (m.measured() && !m.configuration.denoised()) list.push_back(i);
    }
    return list;
  }

  std::vector<size_t> front() const {
    const std::vector<size_t> candidates = measuredWays();
    std::vector<TradeOff> ways;
    for (const size_t i : candidates) ways.push_back(study_.tradeOff(i));
    std::vector<size_t> front;
    for (const size_t i : paretoFront(ways)) front.push_back(candidates[i]);
    return front;
  }

  [[nodiscard]] bool known(const Configuration& configuration) const {
    return std::any_of(study_.measurements.begin(), study_.measurements.end(),
                       [&](const Measurement& m) { return m.configuration == configuration; });
  }

  /// What is promising and not yet tried: a way on the front with one more way that pays, best forecast first. The
  /// forecast takes gains as independent.
  std::vector<Configuration> nextCombinations() const {
    const double exactCost = study_.tradeOff(0).cost;
    std::vector<std::pair<double, Configuration>> found;
    for (const size_t a : front()) {
      for (const size_t b : measuredWays()) {
        const Measurement &first = study_.measurements[a], &second = study_.measurements[b];
        const double gain = study_.tradeOff(b).cost / exactCost;
        Configuration both = first.configuration.combinedWith(second.configuration);
        if (!(gain < 1) || both.exact() || known(both)) continue;
        if (std::any_of(found.begin(), found.end(), [&](const auto& entry) { return entry.second == both; })) continue;
        found.emplace_back(study_.tradeOff(a).cost * gain, std::move(both));
      }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Configuration> list;
    for (size_t i = 0; i < std::min(found.size(), kSearchBatch); ++i) list.push_back(found[i].second);
    return list;
  }

  void search(double deadline) {
    if (!study_.exact().measured()) return;
    while (timeLeft(deadline)) {
      std::vector<size_t> batch = {0}; // the exact settings again, to pair times with
      for (const Configuration& configuration : nextCombinations()) {
        batch.push_back(study_.measurements.size());
        study_.measurements.push_back(
            {.configuration = configuration, .declaredUnbiased = configuration.declaredUnbiased()});
      }
      if (batch.size() == 1) return;
      if (elapsed_() + batchSeconds(batch.size()) > deadline) {
        study_.measurements.resize(study_.measurements.size() + 1 - batch.size());
        return;
      }
      for (uint32_t round = 0; round < kSearchRounds && (round < kFewestRounds || timeLeft(deadline)); ++round) {
        if (!measureBatch(batch, round)) return;
      }
    }
  }

  /// What the fewest rounds of so many configurations take, compilation of the new ones included.
  [[nodiscard]] double batchSeconds(size_t configurations) const {
    const double compile = bench_.compileSeconds() / static_cast<double>(std::max<size_t>(measuredWays().size(), 1));
    return static_cast<double>(configurations) * (compile + kFewestRounds * runSeconds_);
  }

  bool measureBatch(const std::vector<size_t>& batch, uint32_t round) {
    try {
      return measureRound(batch, fmt::format("combinations, round {}", round + 1));
    } catch (const UsageError& error) { // one of the combinations does not go together: which, is seen by its runs
      for (const size_t i : batch) {
        Measurement& m = study_.measurements[i];
        if (m.state != MeasurementState::Planned) continue;
        m.state = MeasurementState::Refused;
        m.reason = error.what();
      }
      return true;
    }
  }

  /// Fresh seeds, the recommended number of samples where there is time for two runs of each.
  void confirm() {
    std::vector<Recommendation>& list = study_.recommendations;
    if (list.empty() || interrupted()) return;
    std::vector<ErrorSplitter> splitters(list.size(), *splitter_);
    std::vector<std::vector<double>> seconds(list.size());
    constexpr int kRuns = 2;
    constexpr double kMargin = 0.85; // the machine may be slower than it was
    double left = kMargin * std::max(plan_.seconds - elapsed_(), 0.0);
    for (size_t i = 0; i < list.size(); ++i) { // the draft first, which leaves most of its share to the others
      Recommendation& r = list[i];
      const Measurement& m = study_.measurements[r.measurement];
      const double perSample = m.seconds().value / m.samples();
      const double share = left / static_cast<double>(list.size() - i);
      r.confirmedSamples = std::min(r.samples, wholeSamples(share / kRuns / perSample));
      r.forecastSeconds = perSample * r.confirmedSamples;
      left -= kRuns * r.forecastSeconds;
      const double noiseSquare = m.split.noiseSquare.value * m.samples() / r.confirmedSamples;
      r.forecastError = std::sqrt(noiseSquare + study_.tradeOff(r.measurement).biasSquare);
    }
    for (int run = 0; run < kRuns; ++run) {
      for (size_t i = 0; i < list.size(); ++i) {
        progress_(fmt::format("confirming {} with fresh seeds", list[i].purpose));
        const Configuration& configuration = study_.measurements[list[i].measurement].configuration;
        const auto result = bench_.render(configuration.settings(), nextSeed_++, {0, list[i].confirmedSamples});
        if (!result) return;
        splitters[i].add(result->image);
        seconds[i].push_back(result->seconds);
        list[i].found = splitters[i].split();
        list[i].foundSeconds = meanInterval(seconds[i]);
      }
    }
  }

  Workbench& bench_;
  const StudyPlan& plan_;
  const std::function<double()>& elapsed_;
  const StudyProgress& progress_;
  Study study_;
  std::optional<ErrorSplitter> splitter_; ///< without runs
  std::vector<double> secondsPerSample_;
  double probeSquare_ = 0; ///< noise of the exact settings after kProbeSamples
  double runSeconds_ = 0;  ///< of one run with all about it
  uint64_t nextSeed_ = 1;
  uint32_t round_ = 0;
};

} // namespace

size_t Study::measuredCount() const {
  return static_cast<size_t>(
      std::count_if(measurements.begin(), measurements.end(), [](const Measurement& m) { return m.measured(); }));
}

Study runStudy(Workbench& bench, const StudyPlan& plan, const std::function<double()>& elapsed,
               const StudyProgress& progress) {
  return StudyRunner(bench, plan, elapsed, progress).run();
}

std::vector<Recommendation> recommend(const Study& study) {
  if (!study.exact().measured()) return {};
  std::vector<Recommendation> list;
  for (const auto& [purpose, error, biasAllowed] :
       {std::tuple{"draft", 0.2, true}, std::tuple{"balanced", 0.05, true}, std::tuple{"final", 0.01, false}}) {
    size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < study.measurements.size(); ++i) {
      const Measurement& m = study.measurements[i];
      if (!m.measured() || m.configuration.denoised()) continue;
      const bool biased = !m.declaredUnbiased || study.biasSeen(m);
      if (biased && !biasAllowed) continue;
      // Cheaper beyond doubt, not by the luck of being the least of many.
      if (i > 0 && !(priceOf(m, study.exact()).cost.upper < 1)) continue;
      const double weighted = secondsToError(study.tradeOff(i), error) *
                              std::pow(1.05, static_cast<double>(m.configuration.changes.size()));
      if (weighted >= least) continue;
      least = weighted;
      best = i;
    }
    const Measurement& m = study.measurements[best];
    const TradeOff way = study.tradeOff(best);
    const double samples = m.split.noiseSquare.value * m.samples() / (error * error - way.biasSquare);
    const double seconds = secondsToError(way, error);
    const double rounds = std::ceil(std::min(samples, 1e9) / gpu::kReplicateCount);
    list.push_back({.purpose = purpose,
                    .targetError = error,
                    .measurement = best,
                    .samples = static_cast<uint32_t>(std::max(rounds, 1.0)) * gpu::kReplicateCount,
                    .seconds = seconds});
  }
  return list;
}

} // namespace isophote::cli
