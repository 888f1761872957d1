// Runs the built `isophote` and looks at what it says and returns.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "unit/io_fixture.hpp"

namespace isophote::test {

struct CommandResult {
  int exitCode = -1; ///< negative: ended by this signal
  std::string out;
  std::string err;
};

class CommandLine : public InTemporaryFolder {
protected:
  void SetUp() override {
    InTemporaryFolder::SetUp();
    if (access(kBinary, X_OK) != 0) GTEST_SKIP() << "the isophote command was not built (ISOPHOTE_BUILD_CLI)";
  }

  /// Arguments reach the program as they are, without a shell.
  [[nodiscard]] CommandResult run(const std::vector<std::string>& arguments) const { return wait(start(arguments)); }

  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0) return child;
    std::vector<char*> argv = {const_cast<char*>(kBinary)};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    redirect(outFile(getpid()), STDOUT_FILENO);
    redirect(errFile(getpid()), STDERR_FILENO);
    execv(kBinary, argv.data());
    _exit(126);
  }

  [[nodiscard]] CommandResult wait(pid_t child) const {
    int status = 0;
    waitpid(child, &status, 0);
    CommandResult result{.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
                         .out = output(child),
                         .err = readBytes(errFile(child))};
    std::filesystem::remove(outFile(child));
    std::filesystem::remove(errFile(child));
    return result;
  }

  /// What a running child has written to stdout so far.
  [[nodiscard]] std::string output(pid_t child) const { return readBytes(outFile(child)); }

  /// One triangle in front of one camera, with one point light; `extra` goes into the asset's top level.
  [[nodiscard]] std::string writeTriangle(const std::string& name, const std::string& extra = "") const {
    writeBytes(path(name), R"({"asset": {"version": "2.0"}, )" + extra + R"(
      "extensionsUsed": ["KHR_lights_punctual"],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "lamp"}]}},
      "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
      "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]},
                {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 2]}],
      "cameras": [{"type": "perspective", "name": "front", "perspective": {"yfov": 0.7, "znear": 0.1, "aspectRatio": 2}}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]})");
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    writeBytes(path("triangle.bin"), std::string(reinterpret_cast<const char*>(positions), sizeof(positions)));
    return path(name).string();
  }

  static void expectOneErrorLine(const CommandResult& result) {
    EXPECT_TRUE(result.err.starts_with("isophote: ")) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
  }

private:
  static constexpr const char* kBinary = ISOPHOTE_BINARY_DIR "/bin/isophote";

  [[nodiscard]] std::filesystem::path outFile(pid_t child) const { return path("stdout." + std::to_string(child)); }
  [[nodiscard]] std::filesystem::path errFile(pid_t child) const { return path("stderr." + std::to_string(child)); }

  static void redirect(const std::filesystem::path& file, int descriptor) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(opened, descriptor);
    close(opened);
  }
};

/// For commands that render.
class CommandLineOnDevice : public CommandLine {
protected:
  void SetUp() override {
    CommandLine::SetUp();
    if (IsSkipped()) return;
    if (run({"devices"}).exitCode != 0) GTEST_SKIP() << "no Vulkan device can be used";
  }
};

} // namespace isophote::test
