// SPDX-License-Identifier: Apache-2.0
#include "bag/mcap_reader.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "bag/bags.hpp"
#include "bag/compression.hpp"
#include "bag/inspect.hpp"
#include "bag/series.hpp"
#include "support.hpp"

namespace kelpie::mcap_reader_test {
namespace {

using testing::as_bytes;
using testing::Content;
using testing::read_all;
using testing::small_mcap;

std::string refusal(std::string_view mcap) {
  return testing::message_of<InputError>([&] { read_all(mcap); });
}

std::string fixture(const std::string& name) {
  return testing::read_text(std::filesystem::path(KELPIE_SOURCE_DIR) / "tests/logs/bag/fixtures" /
                            name);
}

std::size_t length_of_record(const std::string& mcap, std::size_t at) {
  std::uint64_t length = 0;
  std::memcpy(&length, &mcap[at + 1], sizeof length);
  return 9 + static_cast<std::size_t>(length);
}

// Offset of the record of this kind and number, counted from 0, outside of chunks.
std::size_t offset_of(const std::string& mcap, char opcode, std::size_t number) {
  std::size_t at = 8;
  for (; mcap[at] != opcode || number-- > 0; at += length_of_record(mcap, at)) {
  }
  return at;
}

constexpr char kMessage = 5;
constexpr char kChunk = 6;

// Files of another implementation: see scripts/mcap_peer.mjs.
class PeerFile : public ::testing::TestWithParam<const char*> {};

TEST_P(PeerFile, IsReadToTheLastNumber) {
  const std::string file = fixture(GetParam());
  const std::vector<std::string> columns{
      "/cmd:linear.x",     "/cmd:angular.z",     "/sample:stamp.sec",  "/sample:speeds[0]",
      "/sample:speeds[1]", "/sample:pairs[1].a", "/sample:pairs[1].b", "/sample:on"};
  const auto bag = bag::read_mcap(as_bytes(file), GetParam(), bag::ReadMode::strict);
  const auto series =
      bag::read_series(*bag, bag::MessageDefinitions(), columns, bag::Clock::receive);
  ASSERT_EQ(series.size(), 2U);
  ASSERT_EQ(series[0].times_ns.size(), 12U);
  ASSERT_EQ(series[1].times_ns.size(), 12U);
  for (std::size_t k = 0; k < 12; ++k) {
    const auto x = static_cast<double>(k);
    EXPECT_EQ(series[0].times_ns[k], 100'000'000'000 + 100'000'000 * static_cast<std::int64_t>(k));
    EXPECT_DOUBLE_EQ(series[0].values[0][k], 0.1 * x);
    EXPECT_DOUBLE_EQ(series[0].values[1][k], 1.0 / (x + 1.0));
    const std::vector<double> expected{100 + x, x + 0.5, -x, x, 20 * x, static_cast<double>(k % 2)};
    for (std::size_t c = 0; c < expected.size(); ++c) {
      EXPECT_DOUBLE_EQ(series[1].values[c][k], expected[c]) << columns[2 + c];
    }
  }
  EXPECT_EQ(bag->topics().front().qos_profiles, "- 1");
}

INSTANTIATE_TEST_SUITE_P(All, PeerFile,
                         ::testing::Values("plain.mcap", "chunks.mcap", "zstd.mcap", "lz4.mcap"));

// A record, or a text within one, with its length before it.
std::string with_length(std::uint64_t bytes, std::string_view content) {
  std::string text(static_cast<std::size_t>(bytes), '\0');
  const std::uint64_t length = content.size();
  std::memcpy(text.data(), &length, text.size());
  return text + std::string(content);
}

std::string record(char opcode, std::string_view content) {
  return opcode + with_length(8, content);
}

std::string number_text(std::uint64_t value) {
  std::string text(sizeof value, '\0');
  std::memcpy(text.data(), &value, text.size());
  return text;
}

// A chunk of this content, packed.
std::string chunk(const std::string& content) {
  return record(kChunk, std::string(16, '\0') + number_text(content.size()) + std::string(4, '\0') +
                            with_length(4, "zstd") + with_length(8, bag::pack("zstd", content)));
}

// A file of these records.
std::string mcap_of_records(const std::string& records) {
  const std::string magic = small_mcap().substr(0, 8);
  return magic + record(1, with_length(4, "ros2") + with_length(4, "")) + records +
         record(15, std::string(4, '\0')) + record(2, std::string(20, '\0')) + magic;
}

// Each chunk alone is no more than is accepted of any file.
TEST(McapReader, ChunksThatTogetherUnpackToMuchAreRefused) {
  const std::string one = chunk(record(kMessage, std::string(40'000'000, '\0')));
  const std::string mcap = mcap_of_records(one + one + one);
  EXPECT_LT(mcap.size(), 100'000U);
  const std::string message = refusal(mcap);
  EXPECT_NE(message.find("a message belongs to the channel 0"), std::string::npos) << message;
  const Content content = read_all(mcap, bag::ReadMode::recover);
  ASSERT_EQ(content.losses.size(), 2U);
  EXPECT_NE(content.losses[1].find("the chunks up to here are to hold 80000018 bytes"),
            std::string::npos)
      << content.losses[1];
}

// A channel of a few bytes names a schema that may be long.
TEST(McapReader, TopicsByTooManyDefinitionsAreRefused) {
  const auto mcap = [](const std::string& definition, std::uint8_t topics) {
    std::string records = record(3, std::string("\1\0", 2) + with_length(4, "t/msg/T") +
                                        with_length(4, "ros2msg") + with_length(4, definition));
    for (std::uint8_t k = 0; k < topics; ++k) {
      records += record(4, std::string(1, static_cast<char>(k)) + std::string("\0\1\0", 3) +
                               with_length(4, "/t" + std::to_string(k)) + with_length(4, "cdr") +
                               with_length(4, ""));
    }
    return mcap_of_records(records);
  };
  const std::string much = mcap("# " + std::string(1'000'000, 'x') + "\nfloat64 x\n", 100);
  EXPECT_NE(refusal(much).find("defines its topics by more than 64 MB"), std::string::npos);
  EXPECT_LE(read_all(much, bag::ReadMode::recover).topics.size(), 64U);

  std::string fields;
  for (int k = 0; k < 19'000; ++k) {
    fields += "float64 x" + std::to_string(k) + "\n";
  }
  const std::string many = mcap(fields, 15);
  const auto bag = bag::read_mcap(as_bytes(many), "many.mcap", bag::ReadMode::strict);
  const bag::BagReport report = bag::inspect_bag(*bag, bag::MessageDefinitions());
  EXPECT_EQ(std::ranges::count_if(report.topics,
                                  [](const auto& topic) { return !topic.not_decoded.empty(); }),
            4);
}

// Each costs memory, and packed as they are they cost nothing on disk.
TEST(McapReader, MoreMessagesThanBytesAreRefused) {
  const std::string zeros(40, '\0');
  std::string messages;
  for (int i = 0; i < 150'000; ++i) {
    messages += record(kMessage, std::string("\1\0", 2) + zeros);
  }
  const std::string mcap =
      mcap_of_records(record(4, std::string("\1\0\0\0", 4) + with_length(4, "/a") +
                                    with_length(4, "cdr") + with_length(4, "")) +
                      chunk(messages));
  EXPECT_LT(mcap.size(), 20'000U);
  const std::string message = refusal(mcap);
  EXPECT_NE(message.find("the bag unpacks to more than 1"), std::string::npos) << message;
  EXPECT_LT(read_all(mcap, bag::ReadMode::recover).messages.size(), 125'000U);
}

TEST(McapReader, AFlippedBitIsFoundOrChangesNothing) {
  for (const char* const compression : {"zstd", "lz4", ""}) {
    const std::string whole = small_mcap(compression, 2);
    const Content content = read_all(whole);
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += 3) {
      std::string flipped = whole;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
      Content read;
      if (testing::message_of<InputError>([&] { read = read_all(flipped); }).empty()) {
        ASSERT_EQ(read.messages.size(), content.messages.size()) << compression << ", bit " << bit;
        for (std::size_t k = 0; k < read.messages.size(); ++k) {
          EXPECT_EQ(read.messages[k].receive_ns, content.messages[k].receive_ns);
          EXPECT_EQ(read.messages[k].data, content.messages[k].data);
        }
      }
    }
  }
}

TEST(McapReader, EveryTruncationIsRefusedAndReadInRecovery) {
  for (const std::string& whole :
       {small_mcap(), fixture("plain.mcap"), fixture("chunks.mcap"), fixture("lz4.mcap")}) {
    std::size_t most = 0;
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const std::string cut = whole.substr(0, length);
      EXPECT_NE(refusal(cut), "") << length;
      if (length < 8) {
        continue;
      }
      const Content content = read_all(cut, bag::ReadMode::recover);
      EXPECT_FALSE(content.losses.empty()) << length;
      EXPECT_GE(content.messages.size(), most) << length;  // more of a file, more of its messages
      most = content.messages.size();
    }
    EXPECT_EQ(most, read_all(whole).messages.size());
  }
}

// Every `step` bits, which meets every place of a bit in a byte.
void expect_flipped_bits_to_be_survived(std::size_t step) {
  const bag::MessageDefinitions definitions;
  for (const char* const name : {"plain.mcap", "chunks.mcap", "zstd.mcap", "lz4.mcap"}) {
    const std::string whole = fixture(name);
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += step) {
      std::string flipped = whole;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
      for (const bag::ReadMode mode : {bag::ReadMode::strict, bag::ReadMode::recover}) {
        try {
          const auto bag = bag::read_mcap(as_bytes(flipped), name, mode);
          EXPECT_LE(bag::inspect_bag(*bag, definitions).messages,
                    26U);  // a channel may turn into a message
        } catch (const InputError& error) {
          EXPECT_TRUE(mode == bag::ReadMode::strict || bit < 64) << error.what();
        }
      }
    }
  }
}

TEST(McapReader, FlippedBitsOfAnotherWritersFileAreSurvived) {
  expect_flipped_bits_to_be_survived(23);
}

TEST(NightlyMcapReader, MoreFlippedBitsAreSurvived) {
  expect_flipped_bits_to_be_survived(5);
}

TEST(McapReader, ADamagedChunkIsNamedAndTheOthersAreRecovered) {
  std::string file = small_mcap("", 6);
  const std::size_t all = read_all(file).messages.size();
  const std::size_t chunk = offset_of(file, kChunk, 1);
  file[chunk + 100] = static_cast<char>(file[chunk + 100] ^ 1);
  EXPECT_EQ(refusal(file), "small.mcap: offset " + std::to_string(chunk) +
                               ": a chunk is damaged: its CRC is wrong");
  const Content content = read_all(file, bag::ReadMode::recover);
  EXPECT_LT(content.messages.size(), all);
  EXPECT_GE(content.messages.size(), all - 6);
  ASSERT_EQ(content.losses.size(), 2U);
  EXPECT_NE(content.losses[1].find("the summary states 12 messages"), std::string::npos);
}

TEST(McapReader, BehindADamagedLengthReadingGoesOnAtTheNextChunk) {
  const std::string file = small_mcap("zstd", 6);
  const std::size_t all = read_all(file).messages.size();
  for (const int wrong : {1, 2, 7}) {  // too long by a little, by more, beyond the end
    std::string damaged = file;
    damaged[offset_of(file, kChunk, 1) + static_cast<std::size_t>(wrong)] += 1;
    const Content content = read_all(damaged, bag::ReadMode::recover);
    EXPECT_GE(content.messages.size(), all - 6) << wrong;
    EXPECT_FALSE(content.losses.empty());
  }
}

TEST(McapReader, SizesThatTheFileCannotBackAreNotAllocated) {
  std::string file = small_mcap("zstd", 2);
  const std::size_t size_field = offset_of(file, kChunk, 0) + 9 + 16;
  file[size_field + 5] = 0x7F;  // some 140 TB
  EXPECT_NE(refusal(file).find("cannot come of"), std::string::npos);
}

TEST(McapReader, AMessageOfAnUnknownChannelOrTimeIsNamed) {
  const std::string file = fixture("plain.mcap");
  const std::size_t at = offset_of(file, kMessage, 0);
  std::string wrong = file;
  wrong[at + 9] = 99;
  EXPECT_EQ(refusal(wrong), "small.mcap: offset " + std::to_string(at) +
                                ": a message belongs to the channel 99, which isn't defined "
                                "before it");
  wrong = file;
  wrong[at + 9 + 6 + 7] = 0x70;
  EXPECT_NE(refusal(wrong).find("later than the year 2116"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::mcap_reader_test
