#include "lecture/lecture.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "isophote/error_split.hpp"
#include "lecture/course.hpp"
#include "lecture/formulas.hpp"
#include "rendering/interrupt.hpp"
#include "trade/measurement.hpp"
#include "trade/study_files.hpp"
#include "trade/workbench.hpp"

namespace isophote::cli {
namespace {

constexpr uint32_t kMagnification = 4;                // of the pictures, so that single pixels can be seen
constexpr uint64_t kReferenceSeed = 0x7265666572656e; // none of the runs'

/// For a cell of a table.
std::string cellText(const std::string& text) {
  std::string cell;
  for (const char c : text) {
    if (c == '|') cell += '\\';
    cell += c;
  }
  return cell;
}

/// What was found of one figure.
struct Found {
  ErrorSplit split;
  double referenceError = 0;
  double microseconds = 0; ///< for a sample of all pixels
  std::string picture;     ///< file name
};

Image magnified(const Image& image) {
  Image large{.width = image.width * kMagnification, .height = image.height * kMagnification};
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>& values = image.find(name)->values;
    Channel channel{name, std::vector<float>(size_t{large.width} * large.height)};
    for (uint32_t y = 0; y < large.height; ++y) {
      for (uint32_t x = 0; x < large.width; ++x) {
        channel.values[size_t{y} * large.width + x] =
            values[size_t{y / kMagnification} * image.width + x / kMagnification];
      }
    }
    large.channels.push_back(std::move(channel));
  }
  return large;
}

/// Light that was reflected once, `factor` times; `emission` is the picture without reflection, which has no noise
/// where pixels see one surface alone.
void scaleReflected(Image& image, const Image& emission, double factor) {
  for (const char* name : {"R", "G", "B"}) {
    std::vector<float>& values = std::find_if(image.channels.begin(), image.channels.end(), [&](const Channel& c) {
                                   return c.name == name;
                                 })->values;
    const std::vector<float>& direct = emission.find(name)->values;
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = direct[i] + static_cast<float>(factor) * (values[i] - direct[i]);
  }
}

class Lecture {
public:
  Lecture(const Device& device, const LectureOptions& options, const std::function<void(const std::string&)>& progress)
      : device_(device), options_(options), progress_(progress) {}

  bool write() {
    const std::vector<CourseComparison> comparisons = courseComparisons();
    std::filesystem::create_directories(options_.folder);
    std::string page = introduction();
    for (const CourseComparison& comparison : comparisons) figureCount_ += comparison.figures.size();
    for (size_t i = 0; i < comparisons.size(); ++i) {
      progress_(fmt::format("comparison {} of {}: {}", i + 1, comparisons.size(), comparisons[i].title));
      const auto text = comparisonText(comparisons[i], i + 1);
      if (!text) return false;
      page += *text;
    }
    page += formulaTable();
    writeFileAtomically(std::filesystem::path(options_.folder) / "README.md", page);
    return true;
  }

private:
  Workbench& bench(const std::string& variant) {
    std::unique_ptr<Workbench>& entry = benches_[variant];
    if (!entry) {
      LoadedScene loaded = loadScene(options_.scene, {}, variant);
      view_ = chooseView(loaded.scene, {}, options_.width, std::nullopt);
      entry = std::make_unique<Workbench>(device_, std::move(loaded.scene), view_, [] { return !interrupted(); });
    }
    return *entry;
  }

  /// The exact settings with the figure's number of bounces, and its model where that is another material's.
  const Image* reference(const CourseFigure& figure) {
    Configuration exact;
    for (const Change& change : figure.configuration.changes) {
      if (change.key == "max-depth" || change.key == "ndf") exact.changes.push_back(change);
    }
    const std::string key = figure.variant + exact.name();
    if (!references_.contains(key)) {
      const auto result =
          bench(figure.variant).render(exact.settings(), kReferenceSeed, {0, options_.referenceSamples});
      if (!result) return nullptr;
      references_.emplace(key, result->image);
    }
    return &references_.at(key);
  }

  std::optional<Found> measure(const CourseFigure& figure, const std::string& picture) {
    const Image* expected = reference(figure);
    if (expected == nullptr) return std::nullopt;
    ErrorSplitter splitter(*expected);
    Workbench& workbench = bench(figure.variant);
    Found found{.picture = picture};
    for (uint32_t run = 0; run < options_.runs; ++run) {
      auto result = workbench.render(figure.configuration.settings(), 1 + run, {0, figure.samples});
      if (!result) return std::nullopt;
      if (figure.reflectedTimes != 1) {
        Settings emission;
        emission.estimator.maxDepth = 0;
        const auto direct = workbench.render(emission, 1 + run, {0, figure.samples});
        if (!direct) return std::nullopt;
        scaleReflected(result->image, direct->image, figure.reflectedTimes);
      }
      splitter.add(result->image);
      found.microseconds += 1e6 * result->seconds / figure.samples / options_.runs;
      if (run == 0) {
        writePng(std::filesystem::path(options_.folder) / picture, magnified(result->image), 0, ToneMap::Srgb,
                 Transfer::Gamma22);
      }
    }
    found.split = splitter.split();
    found.referenceError = rootOf(splitter.referenceSquare());
    return found;
  }

  std::optional<std::string> comparisonText(const CourseComparison& comparison, size_t number) {
    std::string names = "|", rule = "|", pictures = "|", noise = "|", bias = "|", brightness = "|", time = "|",
                cost = "|", errors = "|";
    double firstCost = 0;
    for (size_t f = 0; f < comparison.figures.size(); ++f) {
      const CourseFigure& figure = comparison.figures[f];
      const auto found = measure(figure, fmt::format("{:02}-{}.png", number, static_cast<char>('a' + f)));
      if (!found) return std::nullopt;
      const ErrorSplit& s = found->split;
      const double ownCost = s.noiseSquare.value * found->microseconds * figure.samples;
      if (f == 0) firstCost = ownCost;
      names += fmt::format(" {}, {} samples |", figure.caption, figure.samples);
      rule += "---|";
      pictures += fmt::format(" ![{}]({}) |", figure.caption, found->picture);
      noise += fmt::format(" noise {:.3g}% ({:.3g} to {:.3g}%) |", 100 * rootOf(s.noiseSquare.value),
                           100 * rootOf(s.noiseSquare.lower), 100 * rootOf(s.noiseSquare.upper));
      // Relative to pixels that are known no better than to a tenth, single pixels mean nothing.
      bias += biasIsSeen(s, figureCount_, found->referenceError < 0.1)
                  ? fmt::format(" **bias {:.3g}%** ({:.3g} to {:.3g}%) |", 100 * rootOf(s.biasSquare.value),
                                100 * rootOf(s.biasSquare.lower), 100 * rootOf(s.biasSquare.upper))
                  : fmt::format(" no bias seen (below {:.3g}%) |", 100 * rootOf(s.biasSquare.upper));
      brightness += fmt::format(" brightness {:+.3g}% ({:+.3g} to {:+.3g}%) |", 100 * s.brightness.value,
                                100 * s.brightness.lower, 100 * s.brightness.upper);
      errors += fmt::format(" reference known to {:.3g}% |", 100 * found->referenceError);
      time += fmt::format(" {:.3g} ms a sample |", found->microseconds / 1000);
      cost += figure.reflectedTimes == 1 ? fmt::format(" {:.3g} of the time to the same noise |", ownCost / firstCost)
                                         : std::string(" made of another picture |");
    }
    std::string text = fmt::format("\n## {}. {}\n\n", number, comparison.title);
    if (!comparison.remark.empty()) text += comparison.remark + "\n\n";
    for (const std::string* line : {&names, &rule, &pictures, &noise, &bias, &brightness, &errors, &time, &cost})
      text += *line + "\n";
    return text;
  }

  [[nodiscard]] std::string introduction() const {
    return fmt::format(
        "# The course, measured\n\n"
        "Isophote grew from the course PA213, \"Monte Carlo Rendering\" (J. Byška, after K. Crane). Here are its "
        "comparisons, rendered\nwith the settings that it describes: `isophote trade assets/lecture.glb --lecture -o "
        "docs/lecture` writes this page.\n\n"
        "Three spheres under a round lamp, {} pixels wide; {} seeds a picture; against {} samples of the exact "
        "settings "
        "with as many\nbounces. Errors are relative (docs/accuracy.md), in brackets their 95% intervals; the time is "
        "for a "
        "sample of all pixels on\n{}, and the time to the same noise relative to the first picture. Pictures are "
        "encoded by "
        "x^(1/2.2) as in the course,\neach pixel {} times as large.\n",
        options_.width, options_.runs, options_.referenceSamples, device_.info().name, kMagnification);
  }

  [[nodiscard]] static std::string formulaTable() {
    std::string text =
        "\n## Where the course's formula is wrong\n\n"
        "Evaluated outside of the renderer, which has none of them. Sources: Walter et al. 2007 (the "
        "distributions of normals), Veach 1997\n(mixtures, densities on lights), IEC 61966-2-1 (sRGB).\n\n"
        "| what | as written | correct | gives | should give | bias |\n|---|---|---|---|---|---|\n";
    for (const CourseFormula& f : courseFormulas()) {
      text += fmt::format("| {} | {} | {} | {:.4g} | {:.4g} | {:+.3g}% |\n", f.what, cellText(f.asWritten),
                          cellText(f.correct), f.found, f.expected, 100 * (f.found / f.expected - 1));
    }
    return text;
  }

  const Device& device_;
  const LectureOptions& options_;
  const std::function<void(const std::string&)>& progress_;
  View view_;
  size_t figureCount_ = 0; ///< in all: as many chances to see a bias that is not there
  std::map<std::string, std::unique_ptr<Workbench>> benches_;
  std::map<std::string, Image> references_;
};

} // namespace

bool writeLecture(const Device& device, const LectureOptions& options,
                  const std::function<void(const std::string&)>& progress) {
  return Lecture(device, options, progress).write();
}

} // namespace isophote::cli
