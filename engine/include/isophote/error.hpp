// Every way Isophote refuses to go on. Each class maps to one exit code of the command line.
#pragma once

#include <stdexcept>
#include <string>

namespace isophote {

/// Misuse of the public API or an internal failure (exit code 1). Base of all Isophote exceptions.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// An argument or setting outside its domain (exit code 2).
class UsageError : public Error {
public:
  using Error::Error;
};

/// An asset that cannot be trusted or parsed (exit code 3).
/// The message reads `FILE: /json/pointer: what was expected`; the pointer is left out where there is none.
class SceneError : public Error {
public:
  SceneError(const std::string& file, const std::string& jsonPointer, const std::string& expected)
      : Error(jsonPointer.empty() ? file + ": " + expected : file + ": " + jsonPointer + ": " + expected) {}
};

/// A feature that the asset requires and this build does not offer (exit code 4).
class UnsupportedError : public SceneError {
public:
  using SceneError::SceneError;
};

/// Memory, image size or another stated limit would be exceeded (exit code 5).
class LimitError : public Error {
public:
  using Error::Error;
};

/// No suitable device, device lost, or a failed Vulkan call (exit code 6).
class DeviceError : public Error {
public:
  using Error::Error;
};

/// An output file could not be written; what stood there before is untouched (exit code 7).
class OutputError : public Error {
public:
  using Error::Error;
};

} // namespace isophote
