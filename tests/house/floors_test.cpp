// SPDX-License-Identifier: Apache-2.0
// The floors of docs/architecture.md: a room includes only what it may know, and lives in a
// namespace of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace kelpie::floors_test {
namespace {

namespace fs = std::filesystem;

using Rooms = std::set<std::string>;

const fs::path kRoot = KELPIE_SOURCE_DIR;

// The library's rooms: headers in include/kelpie/<room>/, sources in src/<room>/.
const std::map<std::string, Rooms> kLibrary{
    {"core", {}},
    {"kernel", {"core"}},
    {"svr", {"kernel", "core"}},
    {"motion", {"core"}},
    {"stream", {"motion", "core"}},
    {"online", {"motion", "svr", "kernel", "core"}},
    {"model", {"online", "motion", "svr", "kernel", "core"}},
    {"navigation", {"model", "core"}},
    {"c", {"model", "online", "stream", "motion", "svr", "kernel", "core"}},
};

// Which rooms of the tools each of them may know; of the library, every room.
const std::map<std::string, Rooms> kTools{
    {"file", {}},
    {"jobs", {"file"}},
    {"mpi", {"jobs"}},
    {"vehicle", {"file"}},
    {"wire", {}},
    {"mavlink", {"wire"}},
    {"bag", {"mavlink", "wire", "file"}},
    {"dds", {}},
    {"log", {"bag", "file"}},
    {"study", {"jobs", "log", "vehicle", "file"}},
    {"format", {"study", "log", "vehicle", "file"}},
    {"fleet", {"format", "study", "jobs", "log", "file"}},
    {"chart", {}},
    {"live", {"format", "study", "log", "bag", "chart", "file"}},
    {"ros", {"live", "dds", "log", "bag", "file"}},
    {"autopilot", {"live", "log", "bag", "mavlink", "file"}},
    {"report", {"fleet", "format", "study", "log", "bag", "chart", "file"}},
    {"web", {"live", "report", "study", "log", "chart", "file"}},
    {"cli",
     {"web", "live", "ros", "autopilot", "report", "fleet", "format", "study", "jobs", "log", "bag",
      "vehicle", "chart", "file"}},
};

// Who knows nothing of learning, though it may know what the library knows of numbers, units and
// signals.
const Rooms kWithoutLearning{"file",    "jobs", "mpi", "vehicle", "wire",
                             "mavlink", "bag",  "dds", "log",     "chart"};
const Rooms kNumbers{"core", "motion", "stream"};

struct Include {
  fs::path file;
  std::string name;
};

std::vector<fs::path> files_of(const std::vector<fs::path>& folders) {
  std::vector<fs::path> files;
  for (const fs::path& folder : folders) {
    if (fs::exists(kRoot / folder)) {
      for (const auto& entry : fs::directory_iterator(kRoot / folder)) {
        if (entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp") {
          files.push_back(entry.path());
        }
      }
    }
  }
  EXPECT_FALSE(files.empty()) << folders.front() << " has no sources";
  return files;
}

std::vector<Include> includes_of(const std::vector<fs::path>& files) {
  std::vector<Include> includes;
  for (const fs::path& file : files) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
      const std::size_t first = line.find_first_of("<\"");
      if (line.starts_with("#include") && first != std::string::npos) {
        const std::size_t end = line.find_first_of(">\"", first + 1);
        includes.push_back({file, line.substr(first + 1, end - first - 1)});
      }
    }
  }
  return includes;
}

std::vector<fs::path> library_files(const std::string& room) {
  return files_of({fs::path("include/kelpie") / room, fs::path("src") / room});
}

// "room" of "kelpie/room/x.hpp" or "room/x.hpp"; empty where it is another project's.
std::string room_of(const std::string& name, bool library) {
  if (name == "kelpie/kelpie.h") {
    return "c";  // whose one header it is
  }
  const std::string prefix = library ? "kelpie/" : "";
  if (!name.starts_with(prefix) || (!library && name.starts_with("kelpie/"))) {
    return {};
  }
  const std::size_t end = name.find('/', prefix.size());
  return end == std::string::npos ? std::string() : name.substr(prefix.size(), end - prefix.size());
}

TEST(Floors, ARoomOfTheLibraryIncludesOnlyWhatLiesBelowIt) {
  for (const auto& [room, known] : kLibrary) {
    std::size_t own = 0;
    for (const auto& [file, name] : includes_of(library_files(room))) {
      const std::string other = room_of(name, true);
      own += other == room ? 1 : 0;
      EXPECT_TRUE(other.empty() || other == room || known.contains(other))
          << file << " includes " << name;
      EXPECT_FALSE(kTools.contains(room_of(name, false))) << file << " includes " << name;
    }
    EXPECT_GT(own, 0U) << room << ": no include was understood";
  }
}

TEST(Floors, ARoomOfTheToolsIncludesOnlyWhatItMayKnow) {
  for (const auto& [room, known] : kTools) {
    std::size_t own = 0;
    for (const auto& [file, name] : includes_of(files_of({fs::path("src") / room}))) {
      const std::string other = room_of(name, false);
      own += other == room ? 1 : 0;
      EXPECT_TRUE(!kTools.contains(other) || other == room || known.contains(other))
          << file << " includes " << name;
      EXPECT_NE(other, "lab") << file << " includes " << name;
      const std::string below = room_of(name, true);
      EXPECT_TRUE(below.empty() || !kWithoutLearning.contains(room) || kNumbers.contains(below))
          << file << " includes " << name;
    }
    EXPECT_GT(own, 0U) << room << ": no include was understood";
  }
}

TEST(Floors, TheLibraryHasNoFilesClockThreadsOrPrinting) {
  const Rooms foreign{"fstream", "iostream", "filesystem", "chrono", "thread",
                      "mutex",   "cstdio",   "ctime",      "future"};
  for (const auto& [room, known] : kLibrary) {
    for (const auto& [file, name] : includes_of(library_files(room))) {
      EXPECT_FALSE(foreign.contains(name)) << file << " includes " << name;
      for (const char* const library : {"fmt/", "toml", "nlohmann", "CLI"}) {
        EXPECT_FALSE(name.starts_with(library)) << file << " includes " << name;
      }
    }
  }
}

// What their types look like follows from the flags of whoever includes them.
TEST(Floors, NoPublicHeaderShowsEigenOrHighway) {
  for (const auto& [room, known] : kLibrary) {
    if (const fs::path folder = fs::path("include/kelpie") / room; fs::exists(kRoot / folder)) {
      for (const auto& [file, name] : includes_of(files_of({folder}))) {
        EXPECT_TRUE(name.find("Eigen/") == std::string::npos && !name.starts_with("hwy/")) << file;
        EXPECT_TRUE(room_of(name, true) != "" || name.find('/') == std::string::npos) << file;
      }
    }
  }
}

TEST(Floors, OnlyTheDoorReadsRecordedLogs) {
  std::vector<fs::path> folders{"lab"};
  for (const auto& [room, known] : kTools) {
    if (room != "log" && room != "bag") {
      folders.push_back(fs::path("src") / room);
    }
  }
  for (const fs::path& file : files_of(folders)) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
      for (const char* const reader : {"read_csv(", "read_series("}) {
        EXPECT_EQ(line.find(reader), std::string::npos) << file << ": " << line;
      }
    }
  }
}

TEST(Floors, ARoomOfTheToolsLivesInItsNamespace) {
  for (const auto& [room, known] : kTools) {
    for (const fs::path& file : files_of({fs::path("src") / room})) {
      if (file.filename() == "main.cpp") {
        continue;
      }
      std::ifstream stream(file);
      bool found = false;
      for (std::string line; std::getline(stream, line);) {
        found = found || line == "namespace kelpie::" + room + " {";
        EXPECT_NE(line, "namespace kelpie {") << file;
      }
      EXPECT_TRUE(found) << file << " is in another namespace";
    }
  }
}

TEST(Floors, EveryRoomIsKnownHere) {
  std::size_t rooms = 0;
  for (const char* const folder : {"src", "include/kelpie"}) {
    for (const auto& entry : fs::directory_iterator(kRoot / folder)) {
      if (!entry.is_directory()) {
        continue;
      }
      const std::string room = entry.path().filename().string();
      EXPECT_TRUE(kLibrary.contains(room) || kTools.contains(room)) << entry.path();
      ++rooms;
    }
  }
  EXPECT_GE(rooms, kLibrary.size() + kTools.size());
}

// So that no file is cut in two to stay under a number: the number is a hint, this is the limit.
TEST(Floors, NoSourceIsAboveThreeHundredLines) {
  std::vector<fs::path> folders{"lab"};
  for (const auto* const rooms : {&kLibrary, &kTools}) {
    for (const auto& [room, known] : *rooms) {
      folders.push_back(fs::path("src") / room);
    }
  }
  for (const fs::path& file : files_of(folders)) {
    std::ifstream stream(file);
    std::size_t lines = 0;
    for (std::string line; std::getline(stream, line);) {
      ++lines;
    }
    EXPECT_LE(lines, 300U) << file;
  }
}

}  // namespace
}  // namespace kelpie::floors_test
