// SPDX-License-Identifier: Apache-2.0
// Over this machine's loopback interface, and a pseudo terminal in place of a serial line.
#include "autopilot/byte_line.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::byte_line_test {
namespace {

using autopilot::ByteLine;
using autopilot::Connection;
using std::chrono::milliseconds;

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write(ByteLine& line, std::string_view text) {
  line.write(std::as_bytes(std::span(text)));
}

// All that comes until there is as much, or two minutes have gone by.
std::string read(ByteLine& line, std::size_t bytes) {
  std::string text;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (text.size() < bytes && std::chrono::steady_clock::now() < end) {
    text += text_of(line.read(milliseconds(20)));
  }
  return text;
}

Connection sending_to(const autopilot::UdpLine& listener) {
  return {.kind = Connection::Kind::udp_send, .host = "127.0.0.1", .port = listener.port()};
}

TEST(UdpLine, AnswersWhomItIsToldTo) {
  autopilot::UdpLine listener({.port = 0});
  write(listener, "to nobody yet");
  const auto vehicle = autopilot::open_line(sending_to(listener));
  const auto other = autopilot::open_line(sending_to(listener));
  write(*vehicle, "vehicle");
  EXPECT_EQ(read(listener, 7), "vehicle");
  listener.answer(listener.source());
  EXPECT_TRUE(listener.source().text().starts_with("127.0.0.1:"));
  write(*other, "other");
  EXPECT_EQ(read(listener, 5), "other");
  write(listener, "answer");
  EXPECT_EQ(read(*vehicle, 6), "answer");
  EXPECT_EQ(text_of(other->read(milliseconds(20))), "");
}

TEST(UdpLine, APortThatIsTakenIsNamed) {
  const autopilot::UdpLine first({.port = 0});
  const std::string why =
      testing::message_of<InputError>([&] { autopilot::open_line({.port = first.port()}); });
  EXPECT_NE(why.find("UDP port " + std::to_string(first.port())), std::string::npos) << why;
  EXPECT_THROW(autopilot::open_line({.host = "no such host.invalid", .port = 1}), InputError);
}

// The other end of a serial line, under a name of its own that a new one can take over.
class Plug {
 public:
  explicit Plug(const std::filesystem::path& name) {
    std::array<char, 256> device{};
    EXPECT_EQ(::openpty(&master_, &slave_, device.data(), nullptr, nullptr), 0);
    std::filesystem::remove(name);
    std::filesystem::create_symlink(device.data(), name);
    ::close(slave_);
  }
  ~Plug() { ::close(master_); }
  Plug(const Plug&) = delete;
  Plug(Plug&&) = delete;
  Plug& operator=(const Plug&) = delete;
  Plug& operator=(Plug&&) = delete;

  void write(std::string_view text) const {
    EXPECT_EQ(::write(master_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  std::string read() const {
    std::array<char, 256> bytes{};
    const ssize_t count = ::read(master_, bytes.data(), bytes.size());
    return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count))};
  }

 private:
  int master_ = -1;
  int slave_ = -1;
};

TEST(SerialLine, TakesBytesAsTheyAreAndIsOpenedAgainWhenItIsBack) {
  const testing::TemporaryFolder folder;
  const std::string name = folder / "ttyACM0";
  auto plug = std::make_unique<Plug>(name);
  const auto line =
      autopilot::open_line({.kind = Connection::Kind::serial, .device = name, .baud = 115'200});
  const std::string raw("\n\r\x03\x11\x13\xFF\x00z", 8);  // nothing is made of control characters
  plug->write(raw);
  EXPECT_EQ(read(*line, raw.size()), raw);
  write(*line, raw);
  EXPECT_EQ(plug->read(), raw);
  EXPECT_EQ(line->fault(), "");

  plug.reset();
  read(*line, 0);
  for (int k = 0; k < 10'000 && line->fault().empty(); ++k) {
    line->read(milliseconds(5));
  }
  EXPECT_NE(line->fault().find("is gone"), std::string::npos);
  write(*line, "to nobody");
  plug = std::make_unique<Plug>(name);
  for (int k = 0; k < 10'000 && !line->fault().empty(); ++k) {
    line->read(milliseconds(5));
  }
  EXPECT_EQ(line->fault(), "");
  plug->write("back");
  EXPECT_EQ(read(*line, 4), "back");
}

TEST(SerialLine, WhatIsNoneIsNamed) {
  const testing::TemporaryFolder folder;
  const auto refusal = [](const std::string& device) {
    return testing::message_of<InputError>([&] {
      autopilot::open_line({.kind = Connection::Kind::serial, .device = device, .baud = 115'200});
    });
  };
  EXPECT_NE(refusal(folder / "none").find("none: No such file"), std::string::npos);
  testing::write_text(folder / "file", "x");
  EXPECT_NE(refusal(folder / "file").find("is no serial line"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::byte_line_test
