// SPDX-License-Identifier: Apache-2.0
// package.xml names what CMake looks for (docs/howto/install.md, "In a ROS 2 workspace").

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

#include "house/sources.hpp"

namespace kelpie::package_test {
namespace {

// By the name in CMake: the key of rosdep, or the Debian package; "": of the compiler or of CMake,
// or of an option that is off without a word.
const std::map<std::string, std::string> kKeys{
    {"Eigen3", "eigen"},
    {"nlohmann_json", "nlohmann-json-dev"},
    {"PkgConfig", "pkg-config"},
    {"libhwy", "libhwy-dev"},
    {"fmt", "fmt"},
    {"tomlplusplus", "libtomlplusplus-dev"},
    {"yaml-cpp", "yaml-cpp"},
    {"SQLite3", "libsqlite3-dev"},
    {"ZLIB", "zlib"},
    {"BZip2", "bzip2"},
    {"libzstd", "libzstd-dev"},
    {"liblz4", "liblz4-dev"},
    {"matio", "libmatio-dev"},
    {"CLI11", "cli11"},
    {"tinyxml2", "tinyxml2"},
    {"libzip", "libzip-dev"},
    {"Threads", ""},
    {"ompi-c", ""},
    {"libcrypto", "libssl-dev"},
    {"CycloneDDS", "cyclonedds"},
    {"libmicrohttpd", "libmicrohttpd-dev"},
    {"libsystemd", "libsystemd-dev"},
    {"GTest", "gtest"},
    {"rapidcheck", "librapidcheck-dev"},
    {"LibSVM", "libsvm-dev"},
};

// What a file of CMake looks for without QUIET: find_package(), pkg_check_modules(),
// kelpie_optional().
std::set<std::string> wanted_by(const house_test::fs::path& file) {
  static const std::regex kWanted(
      R"((?:find_package\(|IMPORTED_TARGET |kelpie_optional\(\w+ \w+ )([A-Za-z][\w+-]*)([^)\n]*))");
  const std::string text =
      std::regex_replace(house_test::text_of(house_test::kRoot / file), std::regex("#[^\n]*"), "");
  std::set<std::string> names;
  for (std::sregex_iterator it(text.begin(), text.end(), kWanted), end; it != end; ++it) {
    if (it->str(2).find("QUIET") == std::string::npos && it->str(1) != "Python3") {
      names.insert(it->str(1));
    }
  }
  return names;
}

TEST(Package, NamesWhatCMakeLooksFor) {
  static const std::regex kDepend(R"(<(\w*depend)>([^<]+)</)");
  const std::string package = house_test::text_of(house_test::kRoot / "package.xml");
  std::set<std::string> named;
  for (std::sregex_iterator it(package.begin(), package.end(), kDepend), end; it != end; ++it) {
    named.insert(it->str(2));
  }
  std::set<std::string> wanted{"cmake"};
  for (const char* const file : {"cmake/Dependencies.cmake", "tests/CMakeLists.txt"}) {
    const std::set<std::string> names = wanted_by(file);
    EXPECT_GE(names.size(), 3U) << file;
    for (const std::string& name : names) {
      const auto key = kKeys.find(name);
      ASSERT_NE(key, kKeys.end()) << file << ": " << name << " has no key in this test";
      if (!key->second.empty()) {
        wanted.insert(key->second);
        EXPECT_TRUE(named.contains(key->second)) << "package.xml lacks " << key->second;
      }
    }
  }
  for (const std::string& name : named) {
    EXPECT_TRUE(wanted.contains(name)) << "package.xml names " << name << ", which nothing needs";
  }
}

}  // namespace
}  // namespace kelpie::package_test
