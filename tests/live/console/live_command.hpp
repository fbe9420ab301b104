// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "live/mission.hpp"
#include "support.hpp"

namespace kelpie::testing {

/// PlotJuggler's place: a socket on this machine that takes what is sent to it.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const int bytes = 1 << 22;
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    socklen_t size = sizeof(address);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Listener() { ::close(socket_); }
  Listener(const Listener&) = delete;
  Listener(Listener&&) = delete;
  Listener& operator=(const Listener&) = delete;
  Listener& operator=(Listener&&) = delete;

  std::string port() const { return std::to_string(port_); }

  /// What has come since the last call.
  std::vector<nlohmann::json> heard() const {
    std::vector<nlohmann::json> messages;
    std::array<char, 65536> bytes{};
    for (;;) {
      const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (count <= 0) {
        return messages;
      }
      messages.push_back(nlohmann::json::parse(bytes.data(), bytes.data() + count));
    }
  }
  /// Of these, the times of samples that were learned [s].
  std::vector<double> learned() const {
    std::vector<double> times_s;
    for (const nlohmann::json& message : heard()) {
      if (message["kelpie"].contains("learned")) {
        times_s.push_back(message["timestamp"]);
      }
    }
    return times_s;
  }

 private:
  int socket_;
  int port_ = 0;
};

/// `kelpie live` in a folder of its own.
class LiveCommand : public CommandTest {
 protected:
  void write_mission(double seconds, const std::string& config = mission_config()) {
    write("mission.mcap", mcap_of(mission_topics(), little_mission(seconds)));
    write("x.toml", config);
  }
  Outcome live(const std::string& arguments) {
    return run("live --config x.toml --from mission.mcap " + arguments);
  }
  std::string model_of(const std::string& folder) const {
    return read_text(folder_ / folder / "model.json");
  }
  void expect_model_of_learn(const std::string& folder, const std::string& align = "auto",
                             const std::string& log = "mission.mcap") {
    const Outcome learned =
        run("learn " + log + " --config x.toml --split none --align " + align + " --out of_learn");
    ASSERT_EQ(learned.exit_code, 0) << learned.err;
    EXPECT_FALSE(model_of("of_learn").empty());
    EXPECT_EQ(model_of(folder), model_of("of_learn"));
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    const Outcome outcome = run("live " + arguments);
    testing::expect_refused(outcome, message);
  }
};

}  // namespace kelpie::testing
