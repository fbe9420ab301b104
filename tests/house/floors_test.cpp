// SPDX-License-Identifier: Apache-2.0
// reference/architecture.md: five buildings with rooms; a room includes only what the room
// may know, and lives in a namespace of its own.

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "house/sources.hpp"

namespace kelpie::floors_test {
namespace {

using house_test::files_below;
using house_test::kRoot;
using house_test::lines_of;
using house_test::fs::path;

using Rooms = std::set<std::string>;
using Building = std::map<std::string, Rooms>;

// Rooms of src/library and which rooms each may know. Public headers are in include/kelpie/<room>,
// private headers beside the sources.
const Building kLibrary{
    {"core", {}},
    {"svr", {"core"}},
    {"motion", {"core"}},
    {"alignment", {"motion", "core"}},
    {"vehicle", {"motion", "core"}},
    {"identify", {"alignment", "motion", "core"}},
    {"stream", {"motion", "core"}},
    {"learner", {"motion", "svr", "core"}},
    {"posterior", {"learner", "motion", "svr", "core"}},
    {"model", {"posterior", "learner", "vehicle", "alignment", "motion", "svr", "core"}},
    {"files", {"model", "alignment", "motion", "core"}},
    {"navigation", {"model", "core"}},
    {"c",
     {"navigation", "files", "model", "learner", "vehicle", "alignment", "motion", "stream", "svr",
      "core"}},
};

// Rooms of the other buildings, and which of these rooms each may know; for rooms of the library,
// see kWithoutLearning.
const Building kLogs{
    {"file", {}},
    {"wire", {}},
    {"mavlink", {"wire"}},
    {"bag", {"mavlink", "wire", "file"}},
    {"log", {"bag", "file"}},
};
const Building kTools{
    {"jobs", {"file"}},
    {"simulator", {"file"}},
    {"chart", {}},
    {"study", {"jobs", "log", "simulator", "file"}},
    {"format", {"study", "log", "simulator", "file"}},
    {"fmu", {"format", "file"}},
    {"fleet", {"format", "study", "jobs", "log", "file"}},
    {"health", {"study", "log", "file"}},
    {"report", {"fleet", "health", "format", "study", "log", "bag", "chart", "file"}},
    {"cli",
     {"report", "fmu", "fleet", "health", "format", "study", "jobs", "log", "bag", "simulator",
      "chart", "file"}},
};
const Building kLive{
    {"live", {"format", "study", "log", "bag", "chart", "file"}},
    {"dds", {}},
    {"ros", {"live", "dds", "log", "bag", "file"}},
    {"autopilot", {"live", "log", "bag", "mavlink", "file"}},
    {"web", {"live", "report", "study", "log", "chart", "file"}},
    {"console",
     {"web", "live", "ros", "autopilot", "cli", "report", "format", "study", "log", "bag",
      "simulator", "chart", "file"}},
};
const std::map<std::string, const Building*> kAroundTheLibrary{
    {"logs", &kLogs}, {"tools", &kTools}, {"live", &kLive}};

// Rooms that know nothing of learning: of the library, these rooms see kNumbers alone.
const Rooms kWithoutLearning{"file", "jobs", "simulator", "wire", "mavlink",
                             "bag",  "dds",  "log",       "chart"};
const Rooms kNumbers{"core", "motion", "stream"};

// The main program adds the commands of kelpie-live, where that building stands.
const std::string kProgram = "program.cpp";

struct Include {
  path file;
  std::string name;
};

std::vector<Include> includes_of(const std::vector<path>& files) {
  EXPECT_FALSE(files.empty()) << "a room without sources";
  std::vector<Include> includes;
  for (const path& file : files) {
    for (const std::string& line : lines_of(file)) {
      const std::size_t first = line.find_first_of("<\"");
      if (line.starts_with("#include") && first != std::string::npos) {
        const std::size_t end = line.find_first_of(">\"", first + 1);
        includes.push_back({file, line.substr(first + 1, end - first - 1)});
      }
    }
  }
  return includes;
}

std::vector<path> library_files(const std::string& room) {
  return files_below({path("include/kelpie") / room, path("src/library") / room});
}

// "room" of "kelpie/room/x.hpp" and of "room/x.hpp"; empty for a header of another project.
std::string room_of(const std::string& name) {
  if (name == "kelpie/kelpie.h") {
    return "c";
  }
  const std::size_t begin = name.starts_with("kelpie/") ? 7 : 0;
  const std::size_t end = name.find('/', begin);
  return end == std::string::npos ? std::string() : name.substr(begin, end - begin);
}

bool is_around_the_library(const std::string& room) {
  return std::ranges::any_of(kAroundTheLibrary,
                             [&](const auto& one) { return one.second->contains(room); });
}

TEST(Floors, ARoomOfTheLibraryIncludesOnlyWhatLiesBelowIt) {
  for (const auto& [room, known] : kLibrary) {
    std::size_t own = 0;
    for (const auto& [file, name] : includes_of(library_files(room))) {
      const std::string other = room_of(name);
      own += other == room ? 1 : 0;
      EXPECT_TRUE(!kLibrary.contains(other) || other == room || known.contains(other))
          << file << " includes " << name;
      EXPECT_FALSE(is_around_the_library(other)) << file << " includes " << name;
    }
    EXPECT_GT(own, 0U) << room << ": no include was understood";
  }
}

TEST(Floors, ARoomAroundTheLibraryIncludesOnlyWhatTheRoomMayKnow) {
  for (const auto& [building, rooms] : kAroundTheLibrary) {
    for (const auto& [room, known] : *rooms) {
      std::size_t own = 0;
      for (const auto& [file, name] : includes_of(files_below({path("src") / building / room}))) {
        const std::string other = room_of(name);
        own += other == room ? 1 : 0;
        if (file.filename() == kProgram) {
          continue;
        }
        EXPECT_TRUE(!is_around_the_library(other) || other == room || known.contains(other))
            << file << " includes " << name;
        EXPECT_NE(other, "lab") << file << " includes " << name;
        EXPECT_TRUE(!kLibrary.contains(other) || !kWithoutLearning.contains(room) ||
                    kNumbers.contains(other))
            << file << " includes " << name;
      }
      EXPECT_GT(own, 0U) << room << ": no include was understood";
    }
  }
}

TEST(Floors, TheLibraryHasNoFilesClockThreadsOrPrinting) {
  const Rooms foreign{"fstream", "iostream", "filesystem", "chrono", "thread",
                      "mutex",   "cstdio",   "ctime",      "future"};
  for (const auto& [room, known] : kLibrary) {
    for (const auto& [file, name] : includes_of(library_files(room))) {
      EXPECT_FALSE(foreign.contains(name)) << file << " includes " << name;
      for (const char* const library : {"fmt/", "toml", "CLI"}) {
        EXPECT_FALSE(name.starts_with(library)) << file << " includes " << name;
      }
      // For model.json, in one place.
      EXPECT_TRUE(!name.starts_with("nlohmann") || file.filename() == "json_node.hpp")
          << file << " includes " << name;
    }
  }
}

// The layout of such types follows from the flags of the including program.
TEST(Floors, NoPublicHeaderShowsEigenOrHighway) {
  for (const auto& [file, name] : includes_of(files_below({"include"}))) {
    EXPECT_TRUE(name.starts_with("kelpie/") || name.find('/') == std::string::npos)
        << file << " includes " << name;
  }
}

// Users see these headers: few enough to know them.
TEST(Floors, AtMostFortyHeadersArePublic) {
  EXPECT_LE(files_below({"include"}).size(), 40U);
}

TEST(Floors, OnlyTheDoorReadsRecordedLogs) {
  for (const path& file : files_below({"lab", "src/tools", "src/live"})) {
    for (const std::string& line : lines_of(file)) {
      for (const char* const reader : {"read_csv(", "read_series("}) {
        EXPECT_EQ(line.find(reader), std::string::npos) << file << ": " << line;
      }
    }
  }
}

TEST(Floors, ARoomAroundTheLibraryLivesInItsNamespace) {
  for (const auto& [building, rooms] : kAroundTheLibrary) {
    for (const auto& [room, known] : *rooms) {
      // The commands of kelpie-live join those of the program.
      const std::string name = room == "console" ? "cli" : room;
      for (const path& file : files_below({path("src") / building / room})) {
        if (file.filename() == "main.cpp") {
          continue;
        }
        bool found = false;
        for (const std::string& line : lines_of(file)) {
          found = found || line == "namespace kelpie::" + name + " {";
          EXPECT_NE(line, "namespace kelpie {") << file;
        }
        EXPECT_TRUE(found) << file << " is in another namespace";
      }
    }
  }
}

TEST(Floors, EveryBuildingHasADoorplateAndEveryRoomIsKnownHere) {
  std::map<std::string, const Building*> buildings = kAroundTheLibrary;
  buildings.emplace("library", &kLibrary);
  for (const auto& [building, rooms] : buildings) {
    const path folder = kRoot / "src" / building;
    EXPECT_TRUE(exists(folder / "README.md")) << folder;
    EXPECT_TRUE(exists(folder / "CMakeLists.txt")) << folder;
    for (const auto& entry : house_test::fs::directory_iterator(folder)) {
      if (entry.is_directory()) {
        EXPECT_TRUE(rooms->contains(entry.path().filename())) << entry.path();
      }
    }
  }
  EXPECT_TRUE(exists(kRoot / "lab/README.md"));
  for (const auto& entry : house_test::fs::directory_iterator(kRoot / "src")) {
    EXPECT_TRUE(buildings.contains(entry.path().filename())) << entry.path();
  }
}

}  // namespace
}  // namespace kelpie::floors_test
