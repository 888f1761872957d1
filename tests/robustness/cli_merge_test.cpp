// `isophote merge`: shards of a render, in any order, are the whole of it bit for bit.
#include "support/render.hpp"
#include "unit/cli_fixture.hpp"

namespace isophote {
namespace {

class CliMerge : public test::CommandLineOnDevice {
protected:
  void SetUp() override {
    CommandLineOnDevice::SetUp();
    if (!IsSkipped()) scene_ = writeTriangle("triangle.gltf");
  }
  void render(const std::string& output, const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments = {"render", scene_, "-o", file(output), "--width", "20", "--quiet"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const auto result = run(arguments);
    ASSERT_EQ(result.exitCode, 0) << result.err;
  }
  [[nodiscard]] test::CommandResult merge(const std::vector<std::string>& inputs, const std::string& output) const {
    std::vector<std::string> arguments = {"merge", "-o", file(output), "--quiet"};
    for (const std::string& input : inputs) arguments.push_back(file(input));
    return run(arguments);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return path(name).string(); }

  std::string scene_;
};

TEST_F(CliMerge, ShardsInAnyOrderAreTheWholeRender) {
  render("whole.exr", {"--spp", "40"});
  render("a.exr", {"--sample-range", "0:9"});
  render("b.exr", {"--sample-range", "9:24"});
  render("c.exr", {"--sample-range", "24:40"});
  const Image whole = readExr(file("whole.exr"));
  ASSERT_EQ(merge({"c.exr", "a.exr", "b.exr"}, "at-once.exr").exitCode, 0);
  EXPECT_TRUE(test::bitIdentical(readExr(file("at-once.exr")), whole));
  ASSERT_EQ(merge({"c.exr", "a.exr"}, "two.exr").exitCode, 0);
  EXPECT_EQ(readExr(file("two.exr")).attributes.at("isophote.sampleRange"), "0:9,24:40");
  ASSERT_EQ(merge({"two.exr", "b.exr"}, "in-turn.exr").exitCode, 0);
  const Image inTurn = readExr(file("in-turn.exr"));
  EXPECT_TRUE(test::bitIdentical(inTurn, whole));
  for (const char* name : {"isophote.sampleRange", "isophote.error", "isophote.status", "isophote.bias"}) {
    EXPECT_EQ(inTurn.attributes.at(name), whole.attributes.at(name)) << name;
  }
}

TEST_F(CliMerge, DenoisesTheWholeAsRenderDoes) {
  render("whole.exr", {"--spp", "16", "--denoise"});
  render("a.exr", {"--sample-range", "0:9"});
  render("b.exr", {"--sample-range", "9:16"});
  const auto merged = run({"merge", file("a.exr"), file("b.exr"), "-o", file("merged.exr"), "--denoise", "--quiet"});
  ASSERT_EQ(merged.exitCode, 0) << merged.err;
  EXPECT_TRUE(test::bitIdentical(readExr(file("merged.exr")), readExr(file("whole.exr"))));
  EXPECT_EQ(readExr(file("merged.exr")).attributes.at("isophote.bias"),
            readExr(file("whole.exr")).attributes.at("isophote.bias"));
  const auto compared = run({"compare", file("merged.exr"), file("whole.exr"), "--denoised", "--json"});
  EXPECT_EQ(compared.exitCode, 0) << compared.err;
  EXPECT_EQ(compared.out.find("verdict"), std::string::npos); // the layer has no error bars
  const auto shard = run({"render", scene_, "-o", file("c.exr"), "--sample-range", "0:8", "--denoise"});
  EXPECT_EQ(shard.exitCode, 2) << shard.err;
}

TEST_F(CliMerge, TheLedgerIsThatOfTheWholeImage) {
  const std::vector<std::string> biased = {"--env-color", "1,2,3", "--set", "clamp=0.5"};
  const auto with = [&](std::vector<std::string> samples) {
    samples.insert(samples.end(), biased.begin(), biased.end());
    return samples;
  };
  render("whole.exr", with({"--spp", "24"}));
  render("a.exr", with({"--sample-range", "0:8"}));
  render("b.exr", with({"--sample-range", "8:24"}));
  ASSERT_EQ(merge({"a.exr", "b.exr"}, "merged.exr").exitCode, 0);
  const std::string ledger = readExr(file("whole.exr")).attributes.at("isophote.bias");
  EXPECT_NE(ledger.find("removed_share"), std::string::npos);
  EXPECT_NE(ledger, readExr(file("a.exr")).attributes.at("isophote.bias"));
  EXPECT_EQ(ledger, readExr(file("merged.exr")).attributes.at("isophote.bias"));
}

TEST_F(CliMerge, WhatDoesNotBelongTogetherIsRefused) {
  render("a.exr", {"--sample-range", "0:4"});
  render("overlap.exr", {"--sample-range", "3:8"});
  render("seed.exr", {"--sample-range", "4:8", "--seed", "1"});
  render("plain.exr", {"--spp", "4"});
  struct Case {
    const char* input;
    const char* reason;
  };
  for (const Case& c : {Case{"overlap.exr", "samples 3 to 3"}, Case{"seed.exr", "isophote.seed"},
                        Case{"plain.exr", "--sample-range"}}) {
    const auto refused = merge({"a.exr", c.input}, "out.exr");
    EXPECT_EQ(refused.exitCode, 2) << c.input;
    EXPECT_NE(refused.err.find(c.reason), std::string::npos) << refused.err;
    expectOneErrorLine(refused);
    EXPECT_FALSE(std::filesystem::exists(file("out.exr")));
  }
}

} // namespace
} // namespace isophote
