// SPDX-License-Identifier: Apache-2.0
// The floors of docs/architecture.md: a room includes only what it may know.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace kelpie::floors_test {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::vector<std::string>> kMayKnow{
    {"core", {}},
    {"kernel", {"core"}},
    {"svr", {"kernel", "core"}},
    {"online", {"svr", "kernel", "core"}},
    {"model", {"online", "svr", "kernel", "core"}},
    {"data", {"core"}},
    {"bag", {"data", "core"}},
    {"vehicle", {"data", "core"}},
    {"baseline", {"model", "online", "svr", "kernel", "core"}},
    {"study", {"baseline", "model", "online", "svr", "kernel", "data", "vehicle", "core"}},
    {"report", {"study", "model", "online", "svr", "kernel", "data", "core"}},
    {"python", {"report", "model", "data", "core"}},
};

const std::vector<std::string> kLibrary{"core", "kernel", "svr", "online", "model"};

std::vector<std::string> includes_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> names;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t first = line.find_first_of("<\"");
    if (line.starts_with("#include") && first != std::string::npos) {
      names.push_back(line.substr(first + 1, line.find_first_of(">\"", first + 1) - first - 1));
    }
  }
  return names;
}

std::vector<fs::path> sources_of(const std::string& room) {
  std::vector<fs::path> files;
  const fs::path root = KELPIE_SOURCE_DIR;
  for (const fs::path& folder :
       {root / "include/kelpie" / room, root / "src" / room, root / room / "src"}) {
    if (fs::exists(folder)) {
      for (const auto& entry : fs::directory_iterator(folder)) {
        files.push_back(entry.path());
      }
    }
  }
  return files;
}

TEST(Floors, ARoomIncludesOnlyWhatLiesBelowIt) {
  const std::string prefix = "kelpie/";
  for (const auto& [room, known] : kMayKnow) {
    for (const fs::path& file : sources_of(room)) {
      for (const std::string& name : includes_of(file)) {
        if (!name.starts_with(prefix)) {
          continue;
        }
        const std::string other =
            name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size());
        EXPECT_TRUE(other == room || std::ranges::find(known, other) != known.end())
            << file.string() << " includes " << name;
      }
    }
  }
}

TEST(Floors, TheLibraryHasNoFilesClockThreadsOrPrinting) {
  const std::vector<std::string> foreign{"fstream", "iostream", "filesystem", "chrono", "thread",
                                         "mutex",   "cstdio",   "ctime",      "future"};
  for (const std::string& room : kLibrary) {
    for (const fs::path& file : sources_of(room)) {
      for (const std::string& name : includes_of(file)) {
        EXPECT_EQ(std::ranges::find(foreign, name), foreign.end())
            << file.string() << " includes " << name;
        EXPECT_FALSE(name.starts_with("fmt/") || name.starts_with("toml") ||
                     name.starts_with("nlohmann") || name.starts_with("CLI"))
            << file.string() << " includes " << name;
      }
    }
  }
}

TEST(Floors, EveryRoomIsKnownHere) {
  for (const auto& entry : fs::directory_iterator(fs::path(KELPIE_SOURCE_DIR) / "src")) {
    const std::string room = entry.path().filename().string();
    EXPECT_TRUE(room == "cli" || kMayKnow.contains(room)) << room;
  }
}

}  // namespace
}  // namespace kelpie::floors_test
