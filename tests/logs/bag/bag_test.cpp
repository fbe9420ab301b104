// SPDX-License-Identifier: Apache-2.0
#include "bag/reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bag/bags.hpp"
#include "bag/endless_db3.hpp"
#include "bag/mcap_writer.hpp"
#include "bag/open_bag.hpp"
#include "bag/series.hpp"
#include "plain_user.hpp"
#include "support.hpp"

namespace kelpie::bag_test {
namespace {

namespace fs = std::filesystem;
using testing::content_of;
using testing::kSecond;
using testing::Recorded;
using testing::small_mcap;
using testing::small_messages;
using testing::small_topics;
using testing::TemporaryFolder;
using testing::write_db3;
using testing::write_text;

std::string refusal(const fs::path& path) {
  return testing::message_of<InputError>([&] { content_of(*bag::open_bag(path)); });
}

void write_metadata(const fs::path& folder, const std::string& storage,
                    const std::vector<std::string>& files, const std::string& more = "") {
  std::string text =
      "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: " + storage + "\n" + more +
      "  relative_file_paths:\n";
  for (const std::string& file : files) {
    text += "    - " + file + "\n";
  }
  write_text(folder / "metadata.yaml", text);
}

void expect_refusal(const fs::path& path, const std::string& message) {
  EXPECT_NE(refusal(path).find(message), std::string::npos) << refusal(path);
}

TEST(Bag, AFolderIsItsFilesOneAfterTheOther) {
  const TemporaryFolder folder;
  const std::vector<Recorded> all = small_messages(4);
  write_db3(folder / "a.db3", small_topics(), {all.begin(), all.begin() + 4});
  // The second file has its topics the other way round.
  std::vector<Recorded> rest(all.begin() + 4, all.end());
  std::ranges::for_each(rest, [](Recorded& message) { message.topic = 1 - message.topic; });
  write_db3(folder / "b.db3", {small_topics()[1], small_topics()[0]}, rest);
  write_metadata(folder.path(), "sqlite3", {"a.db3", "b.db3"});
  const auto content = content_of(*bag::open_bag(folder.path()));
  EXPECT_EQ(content.topics.size(), 2U);
  ASSERT_EQ(content.messages.size(), all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(content.messages[k].topic, all[k].topic);
    EXPECT_EQ(content.messages[k].receive_ns, all[k].receive_ns);
    EXPECT_EQ(content.messages[k].data, all[k].data);
  }
}

TEST(Bag, SingleFilesAreToldApartByTheirContent) {
  const TemporaryFolder folder;
  write_db3(folder / "a.bin", small_topics(), small_messages(2));
  write_text(folder / "b.bin", small_mcap());
  EXPECT_EQ(content_of(*bag::open_bag(folder / "a.bin")).messages.size(), 4U);
  EXPECT_EQ(content_of(*bag::open_bag(folder / "b.bin")).messages.size(), 12U);
  write_text(folder / "c.db3", "t,u,v\n");
  write_text(folder / "d.bag", "#ROSBAG V2.0\n");
  write_text(folder / "e.mcap", "");
  expect_refusal(
      folder / "c.db3",
      "c.db3: is of no known format; these are read: SQLite of rosbag2 (.db3), MCAP (.mcap)");
  expect_refusal(folder / "d.bag", "offset 13: is cut off");
  expect_refusal(folder / "e.mcap", "is empty");
  expect_refusal(folder / "f.mcap", "f.mcap: cannot be read");
}

TEST(Bag, MetadataThatCannotBeUsedAreNamedWithTheirLine) {
  const TemporaryFolder folder;
  expect_refusal(folder.path(), "metadata.yaml: is missing");
  const TemporaryFolder tables;
  write_text(tables / "dive.csv", "t,u,udot\n0,1,2\n");
  expect_refusal(tables.path(), "name the files: " + (tables / "*.csv").string());
  write_text(folder / "metadata.yaml", "a: [1\nb: 2\n");
  expect_refusal(folder.path(), "is no YAML");
  write_text(folder / "metadata.yaml", "- 1\n");
  expect_refusal(folder.path(), "rosbag2_bagfile_information: is missing");
  write_metadata(folder.path(), "sqlite", {"a.db3"});
  expect_refusal(folder.path(),
                 "metadata.yaml:3: storage_identifier: the storage 'sqlite' is "
                 "unknown (did you mean 'sqlite3'?)");
  write_metadata(folder.path(), "sqlite3", {"a.db3"}, "  compression_mode: FILE\n");
  expect_refusal(folder.path(), "rosbag2 compressed this bag");
  write_metadata(folder.path(), "sqlite3", {".."});
  expect_refusal(folder.path(), "the name of a file is due");
  write_metadata(folder.path(), "sqlite3", {});
  expect_refusal(folder.path(), "a list of files is due");
}

// Until Foxy from the folder above, of the recording machine, renamed since; never outside.
TEST(Bag, AFileIsFoundInTheFolderByOtherPaths) {
  const TemporaryFolder folder;
  write_text(folder / "a.mcap", small_mcap());
  for (const char* const path :
       {"old/a.mcap", "/home/rec/old/a.mcap", "../../a.mcap", "before.mcap"}) {
    write_metadata(folder.path(), "\"\"", {path});
    EXPECT_EQ(content_of(*bag::open_bag(folder.path())).messages.size(), 12U) << path;
  }
  write_text(folder / "b.mcap", small_mcap());
  expect_refusal(folder.path(), "before.mcap: is missing");  // which of the two?
  fs::create_directory(folder / "in");
  fs::rename(folder / "a.mcap", folder / "in/a.mcap");
  fs::rename(folder / "b.mcap", folder / "in/b.mcap");
  write_metadata(folder / "in", "mcap", {"c.mcap", "../a.mcap"});
  expect_refusal(folder / "in", "c.mcap: is missing");
}

TEST(Bag, AFileIsNamedOnce) {
  const TemporaryFolder folder;
  write_text(folder / "a.mcap", small_mcap());
  for (const char* const again : {"a.mcap", "./a.mcap"}) {
    write_metadata(folder.path(), "mcap", {"a.mcap", again});
    expect_refusal(folder.path(),
                   "metadata.yaml:6: relative_file_paths: 'a.mcap' stands here twice");
  }
}

TEST(Bag, AMissingFileIsNamedAndRecoveryDoesWithout) {
  const TemporaryFolder folder;
  write_text(folder / "b.mcap", small_mcap());
  write_metadata(folder.path(), "mcap", {"a.mcap", "b.mcap"});
  expect_refusal(folder.path(), "a.mcap: is missing; metadata.yaml lists it");
  auto content = content_of(*bag::open_bag(folder.path(), bag::ReadMode::recover));
  EXPECT_EQ(content.messages.size(), 12U);
  EXPECT_EQ(content.losses.size(), 1U);
  fs::remove(folder / "metadata.yaml");
  content = content_of(*bag::open_bag(folder.path(), bag::ReadMode::recover));
  EXPECT_EQ(content.messages.size(), 12U);
}

TEST(Bag, AFolderWithoutPermissionIsNamed) {
  const TemporaryFolder folder;
  const fs::path place = folder / "bag";
  fs::create_directory(place);
  const testing::PlainUser user(place);
  if (!testing::PlainUser::is_plain()) {
    GTEST_SKIP() << "root may read anywhere";
  }
  const auto expect = [&](fs::perms permissions, bag::ReadMode mode) {
    fs::permissions(place, permissions);
    const std::string said =
        testing::message_of<InputError>([&] { content_of(*bag::open_bag(place, mode)); });
    EXPECT_NE(said.find("cannot be read: Permission denied"), std::string::npos) << said;
  };
  for (const bag::ReadMode mode : {bag::ReadMode::strict, bag::ReadMode::recover}) {
    expect(fs::perms::none, mode);
    expect(fs::perms::owner_read, mode);
  }
  expect(fs::perms::owner_exec, bag::ReadMode::recover);
  fs::permissions(place, fs::perms::owner_all);
}

TEST(Bag, ATopicOfTwoTypesIsRefused) {
  const TemporaryFolder folder;
  write_db3(folder / "a.db3", {small_topics()[0]}, {});
  write_db3(folder / "b.db3", {{.name = "/odom", .type = "other/msg/Type"}}, {});
  write_metadata(folder.path(), "sqlite3", {"a.db3", "b.db3"});
  expect_refusal(folder.path(), "b.db3: /odom: has two types");
}

TEST(Bag, EveryCutOfAnSqliteFileIsRefusedAndRecovered) {
  const TemporaryFolder folder;
  write_db3(folder / "a.db3", small_topics(), small_messages(200));
  const std::string whole = testing::read_text(folder / "a.db3");
  std::size_t most = 0;
  for (std::size_t length = whole.size() - 1; length > 512; length -= std::min(length, 1531UL)) {
    write_text(folder / "cut.db3", whole.substr(0, length));
    expect_refusal(folder / "cut.db3", "cut.db3: ");
    const std::string why = testing::message_of<InputError>([&] {
      const auto content = content_of(*bag::open_bag(folder / "cut.db3", bag::ReadMode::recover));
      EXPECT_FALSE(content.losses.empty()) << length;
      most = std::max(most, content.messages.size());
    });
    EXPECT_TRUE(why.empty() || why.find("damaged") != std::string::npos) << why;
  }
  EXPECT_GT(most, 100U);  // of 400: a short cut costs a part only
}

TEST(Bag, ADamagedPageOfAnSqliteFileCostsItsNeighboursOnly) {
  const TemporaryFolder folder;
  write_db3(folder / "a.db3", small_topics(), small_messages(200));
  std::string file = testing::read_text(folder / "a.db3");
  const std::size_t page = file.size() / 2 / 4096 * 4096;
  file.replace(page, 64, 64, '\x7F');
  write_text(folder / "a.db3", file);
  expect_refusal(folder / "a.db3", "is damaged or cut off");
  const auto content = content_of(*bag::open_bag(folder / "a.db3", bag::ReadMode::recover));
  EXPECT_GT(content.messages.size(), 300U);
  EXPECT_LT(content.messages.size(), 400U);
  EXPECT_FALSE(content.losses.empty());
}

TEST(Bag, PagesOfAnSqliteFileThatShareAChildHaveNoEndlessRows) {
  const TemporaryFolder folder;
  // Rows of messages are met one by one; definitions that are no ros2msg are passed over by SQLite.
  for (const std::size_t root : {3UL, 4UL}) {
    const fs::path path = folder / "a.db3";
    const std::size_t bytes = testing::write_endless_db3(path, root);
    expect_refusal(path, "holds more rows than can come of its 40960 bytes");
    if (root == 3) {
      const auto content = content_of(*bag::open_bag(path, bag::ReadMode::recover));
      EXPECT_LE(content.messages.size(), bytes);
      EXPECT_EQ(content.losses.size(), 1U);
    }
  }
}

TEST(Bag, NoiseInAnSqliteFileIsSurvived) {
  const TemporaryFolder folder;
  write_db3(folder / "a.db3", small_topics(), small_messages(20));
  const std::string whole = testing::read_text(folder / "a.db3");
  std::size_t refused = 0;
  std::size_t read = 0;
  for (std::size_t at = 16; at < whole.size(); at += 97) {
    std::string noisy = whole;
    noisy[at] = static_cast<char>(noisy[at] ^ 0x55);
    write_text(folder / "noisy.db3", noisy);
    for (const bag::ReadMode mode : {bag::ReadMode::strict, bag::ReadMode::recover}) {
      try {
        EXPECT_LE(content_of(*bag::open_bag(folder / "noisy.db3", mode)).messages.size(), 40U)
            << at;
        ++read;
      } catch (const InputError& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find("noisy.db3"), std::string::npos);
      }
    }
  }
  EXPECT_GT(refused, 0U);
  EXPECT_GT(read, 0U);
}

TEST(Bag, OtherSqliteFilesAreNoBags) {
  const TemporaryFolder folder;
  sqlite3* raw = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "x.db3").c_str(), &raw), SQLITE_OK);
  sqlite3_exec(raw, "CREATE VIEW messages AS SELECT 1; CREATE TABLE topics(id)", nullptr, nullptr,
               nullptr);
  sqlite3_close(raw);
  expect_refusal(folder / "x.db3", "no bag: it has no tables topics and messages");
}

// A real bag of AUV FlatFish; the numbers are those of this Python:
//   import sqlite3, struct
//   rows = sqlite3.connect('mission_0.db3').execute('select timestamp, data from messages join '
//       'topics on topics.id = topic_id where name = ? order by timestamp', (name,)).fetchall()
//   ThrusterStatus: at = 16 + struct.unpack_from('<I', data, 12)[0]; at += -at % 4 (frame_id)
//       at += 4 + struct.unpack_from('<I', data, at)[0]; at += -(at - 4) % 8 (name)
//       speed, current = struct.unpack_from('<dd', data, at)
//   Odometry ends in six doubles of the twist and 36 of its covariance:
//       struct.unpack_from('<6d', data, len(data) - 42 * 8)
class FlatFish : public ::testing::Test {
 protected:
  void SetUp() override {
    if (testing::data_file("flatfish_bag").empty()) {
      GTEST_SKIP() << "flatfish_bag is in neither $KELPIE_DATA_DIR nor ../shared/data";
    }
    fs::create_directories(folder_ / "thruster_enitech");
    write_text(folder_ / "thruster_enitech/ThrusterStatus.msg",
               "std_msgs/Header header\nstring name\nfloat64 speed\nfloat64 current\n"
               "bool overtemp_bg149\nbool overtemp_motor\nbool start_gain\nbool air_parameters\n"
               "string control_mode\n");
  }

  TemporaryFolder folder_;
};

TEST_F(FlatFish, HasTheNumbersThatPythonReads) {
  const std::vector<std::string> columns{"/flatfish/thruster_surge_left/thruster_status:speed",
                                         "/flatfish/thruster_surge_left/thruster_status:current",
                                         "/flatfish/odom_simple/odom:twist.twist.linear.x",
                                         "/flatfish/odom_simple/odom:twist.twist.angular.z"};
  const auto bag = bag::open_bag(testing::data_file("flatfish_bag"));
  const bag::MessageDefinitions definitions(folder_.path());
  const auto series = bag::read_series(*bag, definitions, columns, bag::Clock::receive);
  ASSERT_EQ(series[0].times_ns.size(), 729U);
  ASSERT_EQ(series[1].times_ns.size(), 1997U);
  struct Row {
    std::size_t series, message;
    std::int64_t time_ns;
    double first, second;
  };
  for (const Row& row : std::vector<Row>{
           {0, 100, 1713265676511607593, 41.46902302738527, 6.0},
           {0, 300, 1713265694291267539, 32.67256359733385, 4.0},
           {0, 728, 1713265766030081563, 0.0, 0.0},
           {1, 0, 1713265666922576826, -0.04029405227716763, 0.0037397389532998204},
           {1, 1000, 1713265716921897320, 0.31957588214684907, 0.04348711110651493},
           {1, 1996, 1713265766721374348, 0.11476334370162979, -0.02700104145333171},
       }) {
    const bag::Series& one = series[row.series];
    EXPECT_EQ(one.times_ns[row.message], row.time_ns);
    EXPECT_EQ(one.values[0][row.message], row.first);
    EXPECT_EQ(one.values[1][row.message], row.second);
  }
}

TEST_F(FlatFish, IsTheSameAsMcap) {
  const auto bag = bag::open_bag(testing::data_file("flatfish_bag"));
  const bag::McapCopy copy = bag::copy_to_mcap(*bag, bag::MessageDefinitions(folder_.path()));
  EXPECT_EQ(copy.messages, 5522U);
  EXPECT_TRUE(copy.undefined.empty());
  const auto original = content_of(*bag::open_bag(testing::data_file("flatfish_bag")));
  const auto copied = testing::read_all(copy.content);
  ASSERT_EQ(copied.messages.size(), original.messages.size());
  for (std::size_t k = 0; k < copied.messages.size(); ++k) {
    ASSERT_EQ(copied.topics[copied.messages[k].topic].name,
              original.topics[original.messages[k].topic].name);
    ASSERT_EQ(copied.messages[k].receive_ns, original.messages[k].receive_ns);
    ASSERT_EQ(copied.messages[k].data, original.messages[k].data);
  }
  // The copy brings its definitions along.
  EXPECT_NO_THROW(
      bag::MessageDefinitions().type(copied.topics[1].type, copied.topics[1].definition));
}

}  // namespace
}  // namespace kelpie::bag_test
