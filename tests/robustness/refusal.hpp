// Checks that an asset is refused, by which exception, and that its message says where.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "isophote/error.hpp"
#include "unit/gltf_asset.hpp"

namespace isophote::test {

/// Loads `bytes` as asset.gltf; the thrown message, or a failure where nothing or another class is thrown.
template <class Exception>
std::string refusalOf(const TemporaryFolder& folder, const std::string& bytes, const LoadOptions& options = {}) {
  try {
    (void)loadGltf(folder.write("asset.gltf", bytes), options);
  } catch (const Exception& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another class of exception: " << error.what();
    return "";
  }
  ADD_FAILURE() << "the asset was accepted";
  return "";
}

/// Expects `Exception` with the file's name and all of `parts` in its message.
template <class Exception>
void expectRefused(const std::string& bytes, const std::vector<std::string>& parts, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const std::string message = refusalOf<Exception>(folder, bytes, options);
  EXPECT_NE(message.find("asset.gltf: "), std::string::npos) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
}

template <class Exception>
void expectRefused(const GltfAsset& asset, const std::vector<std::string>& parts, const LoadOptions& options = {}) {
  expectRefused<Exception>(asset.gltf(), parts, options);
}

} // namespace isophote::test
