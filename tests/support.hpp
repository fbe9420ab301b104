// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace kelpie::testing {

/// A file of the real data, looked for in $KELPIE_DATA_DIR, then in ../shared/data; empty when it
/// is in neither.
inline std::filesystem::path data_file(const std::string& name) {
  const char* const named = std::getenv("KELPIE_DATA_DIR");  // NOLINT: no thread writes it
  for (const std::filesystem::path& folder :
       {std::filesystem::path(named == nullptr ? "" : named),
        std::filesystem::path(KELPIE_SOURCE_DIR) / ".." / "shared" / "data"}) {
    if (!folder.empty() && std::filesystem::exists(folder / name)) {
      return folder / name;
    }
  }
  return {};
}

/// A folder of its own for one test, gone afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / ("kelpie-" + std::to_string(::getpid()) + "-" +
                                                      test->test_suite_name() + "." + test->name());
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// What `action` throws as Error, or "" when it doesn't.
template <typename Error, typename Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace kelpie::testing
