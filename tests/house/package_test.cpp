// SPDX-License-Identifier: Apache-2.0
// package.xml, debian/control and scripts/setup.sh name what CMake looks for
// (docs/howto/install.md).

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

#include "house/sources.hpp"

namespace kelpie::package_test {
namespace {

// The key of rosdep, or else the Debian package; "": of the compiler or of CMake, or of an option
// that is off without a word.
struct Names {
  std::string rosdep;
  std::string debian;
};

// By the name in CMake
const std::map<std::string, Names> kKeys{
    {"Eigen3", {"eigen", "libeigen3-dev"}},
    {"nlohmann_json", {"nlohmann-json-dev", "nlohmann-json3-dev"}},
    {"PkgConfig", {"pkg-config", "pkg-config"}},
    {"libhwy", {"libhwy-dev", "libhwy-dev"}},
    {"fmt", {"fmt", "libfmt-dev"}},
    {"tomlplusplus", {"libtomlplusplus-dev", "libtomlplusplus-dev"}},
    {"yaml-cpp", {"yaml-cpp", "libyaml-cpp-dev"}},
    {"SQLite3", {"libsqlite3-dev", "libsqlite3-dev"}},
    {"ZLIB", {"zlib", "zlib1g-dev"}},
    {"BZip2", {"bzip2", "libbz2-dev"}},
    {"libzstd", {"libzstd-dev", "libzstd-dev"}},
    {"liblz4", {"liblz4-dev", "liblz4-dev"}},
    {"matio", {"libmatio-dev", "libmatio-dev"}},
    {"CLI11", {"cli11", "libcli11-dev"}},
    {"tinyxml2", {"tinyxml2", "libtinyxml2-dev"}},
    {"libzip", {"libzip-dev", "libzip-dev"}},
    {"Threads", {"", ""}},
    {"libcrypto", {"libssl-dev", "libssl-dev"}},
    {"CycloneDDS", {"cyclonedds", "cyclonedds-dev"}},
    {"libmicrohttpd", {"libmicrohttpd-dev", "libmicrohttpd-dev"}},
    {"libsystemd", {"libsystemd-dev", "libsystemd-dev"}},
    {"GTest", {"gtest", "libgtest-dev"}},
    {"rapidcheck", {"librapidcheck-dev", "librapidcheck-dev"}},
    {"LibSVM", {"libsvm-dev", "libsvm-dev"}},
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
      if (const std::string& rosdep = key->second.rosdep; !rosdep.empty()) {
        wanted.insert(rosdep);
        EXPECT_TRUE(named.contains(rosdep)) << "package.xml lacks " << rosdep;
      }
    }
  }
  for (const std::string& name : named) {
    EXPECT_TRUE(wanted.contains(name)) << "package.xml names " << name << ", which nothing needs";
  }
}

TEST(Package, DebianHasWhatCMakeLooksFor) {
  const std::string control = house_test::text_of(house_test::kRoot / "debian/control");
  const std::string setup = house_test::text_of(house_test::kRoot / "scripts/setup.sh");
  const auto names = [](const std::string& text, const std::string& package) {
    return std::regex_search(text, std::regex("[ \n]" + package + "[ ,\n]"));
  };
  for (const std::string& name : wanted_by("cmake/Dependencies.cmake")) {
    const std::string& package = kKeys.at(name).debian;
    EXPECT_TRUE(package.empty() || names(control, package)) << "debian/control lacks " << package;
    EXPECT_TRUE(package.empty() || names(setup, package)) << "scripts/setup.sh lacks " << package;
  }
  EXPECT_TRUE(names(control, "pybind11-dev"));
}

TEST(Package, OneVersionStandsEverywhere) {
  const auto found = [](const char* file, const char* pattern) {
    std::smatch match;
    const std::string text = house_test::text_of(house_test::kRoot / file);
    return std::regex_search(text, match, std::regex(pattern)) ? match.str(1) : file;
  };
  const std::string version = found("CMakeLists.txt", R"(project\(kelpie VERSION ([0-9.]+))");
  EXPECT_EQ(found("CITATION.cff", R"(\nversion: ([0-9.]+))"), version);
  EXPECT_EQ(found("package.xml", R"(<version>([0-9.]+)<)"), version);
  EXPECT_EQ(found("debian/changelog", R"(^kelpie \(([0-9.]+)\))"), version);
  EXPECT_EQ(found("CHANGELOG.md", R"(\n## ([0-9.]+))"), version);
  EXPECT_EQ(found("README.md", R"(find_package\(kelpie ([0-9.]+))"),
            version.substr(0, version.rfind('.')));
}

}  // namespace
}  // namespace kelpie::package_test
