// `isophote envelope`: the error of the image as one quantity goes to its extreme.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands/commands.hpp"
#include "commands/envelope_report.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "isophote/error.hpp"
#include "isophote/image.hpp"
#include "rendering/interrupt.hpp"
#include "rendering/progress_line.hpp"

namespace isophote::cli {
namespace {

using envelope::Point;
using envelope::Sweep;

constexpr const char* kFiles[] = {"envelope.json", "envelope.csv", "README.md"};
constexpr uint32_t kQuickDivisor = 16;

constexpr const char* kExamples = R"(Examples:
  isophote envelope -o docs/envelope                          all sweeps; minutes
  isophote envelope -o envelope --quick                       the ends of each, a minute
  isophote envelope -o envelope --only scale --only ior       these again, beside what the folder holds of others

Each sweep renders a scene whose image is known, at values on the way to an extreme. Ctrl-C keeps what was measured
(exit code 130).)";

struct EnvelopeOptions {
  std::string directory;
  std::vector<std::string> only;
  bool quick = false;
  bool json = false;
  std::string device;
  bool quiet = false;
};

std::vector<Sweep> chosenSweeps(const std::vector<std::string>& only) {
  std::vector<Sweep> sweeps = envelope::allSweeps();
  if (only.empty()) return sweeps;
  std::vector<Sweep> chosen;
  for (const std::string& name : only) {
    const auto found =
        std::find_if(sweeps.begin(), sweeps.end(), [&](const Sweep& sweep) { return sweep.name == name; });
    if (found == sweeps.end()) {
      std::vector<std::string> names;
      for (const Sweep& sweep : sweeps) names.push_back(sweep.name);
      throw UsageError(fmt::format("--only: no sweep '{}'; there are {}", name, fmt::join(names, ", ")));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

/// The ends and the tame value, without what takes long.
void shorten(Sweep& sweep) {
  std::erase_if(sweep.values,
                [&](double value) { return std::count(sweep.slow.begin(), sweep.slow.end(), value) > 0; });
  std::vector<double> kept;
  for (const double value : sweep.values) {
    if (value == sweep.values.front() || value == sweep.values.back() || value == sweep.tame) kept.push_back(value);
  }
  sweep.values = std::move(kept);
}

void prepareDirectory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw OutputError(directory + ": cannot be made: " + error.message());
  for (const char* file : kFiles) checkWritable(std::filesystem::path(directory) / file);
}

std::string commandLine(const EnvelopeOptions& options) {
  const std::filesystem::path directory = options.directory;
  std::string text = "isophote envelope -o " + (directory.is_absolute() ? directory.filename() : directory).string();
  if (options.quick) text += " --quick";
  return text;
}

class EnvelopeRun {
public:
  EnvelopeRun(const Device& device, const EnvelopeOptions& options)
      : device_(device), options_(options), line_(options.quiet) {}

  std::vector<MeasuredSweep> run(const std::vector<Sweep>& sweeps) {
    size_t total = 0, done = 0;
    for (const Sweep& sweep : sweeps) total += sweep.values.size();
    std::vector<MeasuredSweep> result;
    for (const Sweep& sweep : sweeps) {
      MeasuredSweep measured{.sweep = sweep, .points = {}};
      for (const double value : sweep.values) {
        if (interrupted()) break;
        show(done++, total, sweep, value);
        const Point point = measurePoint(sweep, value);
        if (interrupted() && !point.failure.empty()) break; // this one was not finished
        measured.points.push_back(point);
      }
      if (!measured.points.empty()) result.push_back(std::move(measured));
      if (interrupted()) break;
    }
    line_.clear();
    return result;
  }

  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

private:
  Point measurePoint(const Sweep& sweep, double value) const {
    if (sweep.measured) return sweep.measured(device_, value);
    envelope::Effort effort;
    effort.divideBy = options_.quick ? kQuickDivisor : 1;
    effort.goOn = [] { return !interrupted(); };
    return envelope::measure(device_, sweep.at(value), value, effort);
  }

  void show(size_t done, size_t total, const Sweep& sweep, double value) {
    if (!line_.due()) return;
    line_.show(fmt::format("{:3.0f}%  {} elapsed: {} {:.6g}", std::floor(100.0 * double(done) / double(total)),
                           clockText(elapsed()), sweep.name, value));
  }

  const Device& device_;
  const EnvelopeOptions& options_;
  ProgressLine line_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double secondsOf(const std::vector<MeasuredSweep>& sweeps) {
  double seconds = 0;
  for (const MeasuredSweep& measured : sweeps) {
    for (const Point& point : measured.points) seconds += point.seconds;
  }
  return seconds;
}

/// With what the folder holds of other sweeps from earlier runs, in the order of the pages.
std::vector<MeasuredSweep> withEarlierOnes(std::vector<MeasuredSweep> measured, const std::string& directory) {
  std::ifstream in(std::filesystem::path(directory) / kFiles[0]);
  const std::string json{std::istreambuf_iterator<char>(in), {}};
  const std::vector<Sweep> all = envelope::allSweeps();
  const auto indexOf = [&](const MeasuredSweep& m) {
    return std::find_if(all.begin(), all.end(), [&](const Sweep& s) { return s.name == m.sweep.name; }) - all.begin();
  };
  for (const MeasuredSweep& earlier : measuredBefore(json, all)) {
    if (std::none_of(measured.begin(), measured.end(),
                     [&](const MeasuredSweep& m) { return m.sweep.name == earlier.sweep.name; }))
      measured.push_back(earlier);
  }
  std::sort(measured.begin(), measured.end(), [&](const auto& a, const auto& b) { return indexOf(a) < indexOf(b); });
  return measured;
}

void writeReport(const std::vector<MeasuredSweep>& sweeps, const EnvelopeContext& context,
                 const std::string& directory) {
  const std::filesystem::path folder = directory;
  writeFileAtomically(folder / kFiles[0], envelopeJson(sweeps, context).dump(2) + "\n");
  writeFileAtomically(folder / kFiles[1], envelopeCsv(sweeps));
  writeFileAtomically(folder / kFiles[2], envelopePage(sweeps, context));
  for (const MeasuredSweep& measured : sweeps)
    writeFileAtomically(folder / (measured.sweep.name + ".svg"), envelopeCurve(measured));
}

int runEnvelope(const EnvelopeOptions& options) {
  catchInterrupts();
  std::vector<Sweep> sweeps = chosenSweeps(options.only);
  if (options.quick) std::for_each(sweeps.begin(), sweeps.end(), shorten);
  prepareDirectory(options.directory);
  const VulkanInstance instance;
  const Device device(instance, {.selector = options.device});
  EnvelopeRun run(device, options);
  std::vector<MeasuredSweep> measured = run.run(sweeps);
  if (!options.only.empty()) measured = withEarlierOnes(std::move(measured), options.directory);
  const EnvelopeContext context{.command = commandLine(options),
                                .device = device.info().name,
                                .driver = device.info().driver,
                                .seconds = secondsOf(measured),
                                .interrupted = interrupted()};
  writeReport(measured, context, options.directory);
  if (options.json) {
    fmt::print("{}\n", envelopeJson(measured, context).dump(2));
  } else if (!options.quiet) {
    fmt::print("{} sweeps in {:.0f} s: {}\n", measured.size(), context.seconds,
               (std::filesystem::path(options.directory) / kFiles[2]).string());
  }
  if (!context.interrupted) return kDone;
  printError("interrupted; what was measured is saved");
  return kInterrupted;
}

} // namespace

void addEnvelopeCommand(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("envelope", "Measure the error at extremes of scale, roughness, brightness and more");
  const auto options = std::make_shared<EnvelopeOptions>();
  command
      ->add_option("-o,--output", options->directory,
                   "Folder for README.md, a curve of each sweep, envelope.json and envelope.csv; made if missing")
      ->type_name("DIR")
      ->required();
  command->add_option("--only", options->only, "This sweep alone, the folder's others are kept; repeatable (all)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_flag("--quick", options->quick, "The ends and the middle of each sweep, fewer samples");
  command->add_flag("--json", options->json, "Print what envelope.json holds");
  command->add_option("--device", options->device, "Vulkan device, as for render")->type_name("NAME|INDEX|cpu");
  command->add_flag("--quiet", options->quiet, "Print warnings and errors only");
  command->footer(kExamples);
  command->callback([options, &action] { action = [options] { return runEnvelope(*options); }; });
}

} // namespace isophote::cli
