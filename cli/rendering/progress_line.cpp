#include "rendering/progress_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace isophote::cli {

std::string clockText(double seconds) {
  const auto total = static_cast<uint64_t>(std::clamp(seconds, 0.0, 1e9));
  const uint64_t hours = total / 3600;
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, total / 60 % 60, total % 60);
  return fmt::format("{}:{:02}", total / 60, total % 60);
}

std::string progressText(const RenderState& state) {
  const double fraction = std::clamp(state.fraction, 0.0, 1.0);
  std::string text = fmt::format("{:3.0f}%  {} elapsed", std::floor(100 * fraction), clockText(state.seconds));
  const auto left = [&](double end) { return clockText(end - state.seconds); };
  if (state.ends) {
    text +=
        fmt::format(", {} left ({} to {})", left(state.ends->value), left(state.ends->lower), left(state.ends->upper));
  } else if (fraction > 0.001) {
    text += fmt::format(", {} left", clockText(state.seconds * (1 - fraction) / fraction));
  }
  if (state.seconds > 0) text += fmt::format(", {:.2f} Mrays/s", state.rays / state.seconds * 1e-6);
  if (state.error.known) text += fmt::format(", error {:.3g}%", 100 * state.error.value);
  return text;
}

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

bool ProgressLine::due() const {
  using namespace std::chrono_literals;
  return !quiet_ && Clock::now() - last_ >= (terminal_ ? 100ms : 5000ms);
}

void ProgressLine::show(const std::string& text) {
  if (quiet_) return;
  if (terminal_) {
    fmt::print(stderr, "\r{:<{}}", text, shown_);
    shown_ = text.size();
    std::fflush(stderr);
  } else {
    fmt::print(stderr, "{}\n", text);
  }
  last_ = Clock::now();
}

void ProgressLine::clear() {
  if (!terminal_ || shown_ == 0) return;
  fmt::print(stderr, "\r{:<{}}\r", "", shown_);
  std::fflush(stderr);
  shown_ = 0;
}

} // namespace isophote::cli
