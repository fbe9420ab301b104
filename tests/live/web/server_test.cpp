// SPDX-License-Identifier: Apache-2.0
// The page as browsers and others ask for it, on a port of this machine.
#include "web/server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "kelpie/core/error.hpp"
#include "live/mission.hpp"
#include "support.hpp"
#include "web/client.hpp"
#include "web/page.hpp"

namespace kelpie::server_test {
namespace {

const std::string kEvil = "<script>alert('x')</script>\"&\n\xff";

// A port that was free a moment ago.
std::uint16_t free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  EXPECT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(socket);
  return ntohs(address.sin_port);
}

class WebPage : public ::testing::Test {
 protected:
  explicit WebPage(const std::string& more = "") : port_(free_port()) {
    testing::write_text(folder_ / "x.toml",
                        testing::mission_config("", "page = " + std::to_string(port_) + more));
    configuration_ = live::read_configuration(folder_ / "x.toml", {});
    page_ = std::make_unique<web::Page>(configuration_, requests_);
  }

  testing::Client client() const { return testing::Client(port_); }

  void learn(double t, double y) {
    const std::vector<double> x{0.0, 0.0};
    const Decision decision{.prediction = {.value = y + 1.0, .lower = y, .upper = y + 2.0},
                            .had_model = t > 1.0};
    page_->learned({.t = t, .x = x, .y = std::span(&y, 1), .decisions = std::span(&decision, 1)});
  }

  // What /events says until `enough` of it has come.
  std::string heard(const std::function<bool(const std::string&)>& enough) const {
    return client().ask("GET", "/events", {}, "", enough).body;
  }

  testing::TemporaryFolder folder_;
  std::uint16_t port_;
  live::Configuration configuration_;
  live::Requests requests_;
  std::unique_ptr<web::Page> page_;
};

class WebPageWithToken : public WebPage {
 protected:
  WebPageWithToken() : WebPage("\ntoken = \"0123456789abcdef\"") {}
};

std::string data_of(const std::string& text, const std::string& event) {
  const std::size_t at = text.find("event: " + event + "\ndata: ");
  if (at == std::string::npos) {
    return "null";
  }
  const std::size_t begin = text.find("data: ", at) + 6;
  return text.substr(begin, text.find('\n', begin) - begin);
}

TEST_F(WebPage, ACountThatIsUnknownIsNull) {
  page_->health({});
  const std::string told = heard([](const std::string& text) {
    return text.find("event: health") != std::string::npos && text.ends_with("\n\n");
  });
  const auto health = nlohmann::json::parse(data_of(told, "health"));
  EXPECT_TRUE(health["parameters_asked"].is_null()) << health["parameters_asked"];
  EXPECT_EQ(health["learned"], 0);
}

TEST_F(WebPage, IsOneDocumentThatAsksNobodyElse) {
  const auto answer = client().get("/");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.header("Content-Security-Policy"), "frame-ancestors 'none'");
  EXPECT_NE(answer.body.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(answer.body.find("connect-src 'self'"), std::string::npos);
  EXPECT_EQ(client().get("/nothing").status, 404);
  EXPECT_EQ(client().get("/save").status, 404);
}

TEST_F(WebPage, WhoComesFirstHearsWhatThereWasThenWhatIsNew) {
  for (int i = 1; i <= 30; ++i) {
    learn(0.1 * i, i);
  }
  page_->event(kEvil);
  live::Health health;
  health.sources.push_back({.name = kEvil, .from = kEvil});
  page_->health(health);
  bool is_more = false;
  const std::string text = heard([&](const std::string& so_far) {
    if (!is_more && so_far.find("event: health") != std::string::npos) {
      is_more = true;
      learn(3.1, 31.0);
    }
    return so_far.find("[3.100,31,") != std::string::npos;
  });
  EXPECT_EQ(nlohmann::json::parse(data_of(text, "plan"))["axes"][0]["name"], "udot");
  const auto samples = nlohmann::json::parse(data_of(text, "samples"));
  ASSERT_EQ(samples.size(), 30U);
  EXPECT_EQ(samples[0], nlohmann::json::parse("[0.1, 1, null, null, null]"));
  EXPECT_EQ(samples[29], nlohmann::json::parse("[3.0, 30, 31, 30, 32]"));
  const auto said = nlohmann::json::parse(data_of(text, "said"));
  EXPECT_EQ(said[0][1], "<script>alert('x')</script>\"&\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(nlohmann::json::parse(data_of(text, "health"))["signals"][0]["name"], said[0][1]);
}

TEST_F(WebPage, TheEndOfTheRunIsSaidWithTheLastSamplesBeforeIt) {
  std::string text;
  std::atomic<bool> has_first{false};
  std::thread reader([&] {
    text = heard([&](const std::string& so_far) {
      has_first = so_far.find("[0.500,5,") != std::string::npos;
      return so_far.find("event: end") != std::string::npos;
    });
  });
  learn(0.5, 5.0);
  while (!has_first) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  learn(0.6, 6.0);
  page_->ended();
  page_.reset();
  reader.join();
  EXPECT_NE(text.find("[0.600,6,"), std::string::npos);
  EXPECT_LT(text.find("[0.600,6,"), text.find("event: end")) << text;
}

// Every number of the table; those whose names were ambiguous under the old names as well.
TEST_F(WebPage, HealthHoldsEveryNumberAndAlert) {
  live::Health health;
  health.transport.lost = 3;
  health.rows = 9;
  health.learner.is_paused = true;
  health.learner.rows_paused = 4;
  health.learner.rows_stuck = 5;
  health.learner.median_delay_ms = 1.5;
  health.learner.checkpoint_error = "Permission denied";
  health.record_error = "No space left on device";
  health.sources.push_back({.name = "u", .from = "/odom:x", .silent_s = 2.0, .is_stuck = true});
  live::AxisHealth& axis = health.learner.axes.emplace_back();
  axis.name = "udot";
  axis.r2_mean = 0.25;
  axis.status.tally.outliers = 7;
  health.learner.thrusters = {{.name = "n", .share = 0.5, .lower = 0.4, .upper = 0.6}};
  page_->health(health);
  const std::string text = heard([&](const std::string& so_far) {
    return so_far.find("event: health") != std::string::npos && so_far.ends_with("\n\n");
  });
  const auto plan = nlohmann::json::parse(data_of(text, "plan"));
  const auto told = nlohmann::json::parse(data_of(text, "health"));
  for (const auto& [list, name] : {std::pair("axes", "axes"), std::pair("signals", "signals"),
                                   std::pair("thrusters", "thrusters")}) {
    for (const auto& field : plan["fields"][list]) {
      EXPECT_TRUE(told[name][0].contains(field["key"])) << field;
    }
  }
  for (const auto& field : plan["fields"]["run"]) {
    EXPECT_TRUE(told.contains(field["key"])) << field;
  }
  EXPECT_EQ(told["lost"], 3);
  EXPECT_EQ(told["rows"], 9);
  EXPECT_EQ(told["rows_paused"], 4);
  EXPECT_EQ(told["paused"], 4);
  EXPECT_EQ(told["rows_stuck"], 5);
  EXPECT_EQ(told["stuck"], 5);
  EXPECT_EQ(told["learning_paused"], true);
  EXPECT_EQ(told["frozen"], true);
  EXPECT_EQ(told["delay_ms"], nlohmann::json::parse("[1.5, 0.0]"));
  EXPECT_EQ(told["signals"][0]["is_stuck"], true);
  EXPECT_EQ(told["signals"][0]["stuck"], true);
  EXPECT_EQ(told["axes"][0]["r2"], nlohmann::json::parse("[null, null, 0.25, null]"));
  EXPECT_EQ(told["axes"][0]["outliers"], 7);
  EXPECT_EQ(told["thrusters"][0]["upper"], 0.6);
  std::string alerts;
  for (const auto& alert : told["alerts"]) {
    alerts += alert["level"].get<std::string>() + " " + alert["text"].get<std::string>() + "\n";
  }
  EXPECT_EQ(alerts,
            "error no checkpoint can be written: Permission denied\n"
            "warn u is silent\nwarn u doesn't change any more\n"
            "warn learning is frozen, as was asked\nwarn no model yet\n"
            "warn nothing can be recorded: No space left on device\n");
}

TEST_F(WebPage, ButtonsReachTheEngine) {
  for (const live::Request request :
       {live::Request::save, live::Request::freeze, live::Request::resume, live::Request::reset}) {
    const auto answer = client().post("/" + std::string(live::request_name(request)));
    EXPECT_EQ(answer.status, 202);
    EXPECT_EQ(requests_.pop(), request);
  }
  EXPECT_EQ(client().post("/save", {{"Origin", "http://evil.example"}}).status, 403);
  EXPECT_EQ(client().post("/save", {{"Sec-Fetch-Site", "cross-site"}}).status, 403);
  EXPECT_EQ(client().post("/save", {{"Host", "evil.example"}}).status, 403);
  EXPECT_EQ(client().get("/", {{"Host", "evil.example"}}).status, 403);
  EXPECT_EQ(requests_.pop(), std::nullopt);
}

TEST_F(WebPage, MetricsAreThoseOfTheLatestHealth) {
  EXPECT_EQ(client().get("/metrics").body, "");
  live::Health health;
  health.rows = 7;
  page_->health(health);
  EXPECT_NE(client().get("/metrics").body.find("\nkelpie_rows_total 7\n"), std::string::npos);
}

TEST_F(WebPage, NobodyWaitsForWhoDoesntRead) {
  const testing::Peer peer(port_, 2048);
  peer.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  for (int i = 0; i < 200'000; ++i) {  // more than is kept, and than any buffer holds
    learn(0.1 * i, i);
  }
  const std::string text =
      heard([](const std::string& so_far) { return so_far.ends_with("]]\n\n"); });
  EXPECT_EQ(nlohmann::json::parse(data_of(text, "samples")).size(), 3000U);
}

TEST_F(WebPage, ThereIsRoomForSoManyReadersAndForOthersBesides) {
  std::atomic<std::size_t> hearing{0};
  std::atomic<bool> is_over{false};
  std::vector<std::thread> readers;
  for (std::size_t i = 0; i < web::Server::kStreams; ++i) {
    readers.emplace_back([&] {
      bool is_first = true;
      heard([&](const std::string&) {
        hearing += is_first ? 1 : 0;
        is_first = false;
        return is_over.load();
      });
    });
  }
  while (hearing < web::Server::kStreams) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(client().get("/events").status, 503);
  EXPECT_EQ(client().get("/").status, 200);
  is_over = true;
  learn(1.0, 1.0);
  for (std::thread& reader : readers) {
    reader.join();
  }
}

TEST_F(WebPage, WhatIsNoRequestOrTooLongIsRefused) {
  for (const std::string& bytes :
       {std::string(40'000, 'x'), "GET /" + std::string(20'000, 'a') + " HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: localhost\r\nA: " + std::string(30'000, 'b') + "\r\n\r\n",
        "POST /save HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999\r\n\r\n" +
            std::string(30'000, 'c'),
        "POST /save HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nffffffff\r\n" +
            std::string(30'000, 'd'),
        std::string("\0\0 / HTTP/1.1\r\n\r\n", 17)}) {
    const testing::Peer peer(port_);
    peer.send(bytes);
    peer.end();
    std::string answer;
    peer.read(answer);
    EXPECT_FALSE(answer.starts_with("HTTP/1.1 2")) << bytes.substr(0, 50) << answer;
  }
  EXPECT_EQ(requests_.pop(), std::nullopt);
  EXPECT_EQ(client().get("/").status, 200);
}

std::string times(std::size_t count, const std::string& text) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) {
    all += text;
  }
  return all;
}

TEST_F(WebPage, RangesHaveNoEffect) {
  const std::string page = client().get("/").body;
  for (const std::string& ranges : {std::string("0-0"), "0-0" + times(1'000, ",0-"),
                                    "0-0" + times(1'500, ",-9"), std::string("99999999-")}) {
    const testing::Answered answer = client().get("/", {{"Range", "bytes=" + ranges}});
    EXPECT_EQ(answer.status, 200) << ranges.substr(0, 20);
    EXPECT_EQ(answer.body, page);
  }
  EXPECT_GE(client().get("/", {{"Range", "bytes=0-0" + times(9'000, ",0-")}}).status, 400);
}

TEST_F(WebPage, BodiesAreShortAndNotCoded) {
  for (const char* const coding : {"br", "gzip", "deflate", "gzip, br", "BR", "unknown"}) {
    EXPECT_EQ(client().post("/save", {{"Content-Encoding", coding}}, "abc").status, 415);
  }
  EXPECT_EQ(client().post("/save", {{"Expect", "100-continue"}}, std::string(5'000, 'x')).status,
            413);
  EXPECT_EQ(client().ask("GET", "/", {{"Transfer-Encoding", "chunked"}}).status, 411);
  EXPECT_EQ(requests_.pop(), std::nullopt);
  EXPECT_EQ(client().post("/save", {{"Content-Encoding", "identity"}}, "abc").status, 202);
  EXPECT_EQ(requests_.pop(), live::Request::save);
}

// Connections without a whole request, always more of them: each is closed by the later ones.
TEST_F(WebPage, SlowConnectionsHoldNobodyUp) {
  std::deque<testing::Peer> slow;
  for (std::size_t i = 0; i < 10 * web::kTuning.guests; ++i) {
    slow.emplace_back(port_).send("GET / HTTP/1.1\r\nHost: localhost\r\nA: ");
    if (i % 16 == 0) {
      EXPECT_EQ(client().get("/").status, 200);
    }
    if (slow.size() == 5 * web::kTuning.guests) {
      slow.pop_front();
    }
  }
  std::string text;
  EXPECT_FALSE(slow.front().read(text));
  EXPECT_EQ(client().get("/metrics").status, 200);
}

TEST_F(WebPage, APortThatIsTakenIsNamed) {
  const std::string message =
      testing::message_of<InputError>([&] { web::Page(configuration_, requests_); });
  EXPECT_NE(message.find("live.page: cannot listen on 127.0.0.1:" + std::to_string(port_)),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("in use"), std::string::npos) << message;
}

TEST_F(WebPage, ElsewhereItMakesATokenUp) {
  EXPECT_EQ(page_->address(), "http://127.0.0.1:" + std::to_string(port_) + "/");
  page_.reset();
  configuration_.live.page = "0.0.0.0:" + std::to_string(port_);
  page_ = std::make_unique<web::Page>(configuration_, requests_);
  EXPECT_EQ(client().get("/").status, 401);
  const std::string address = page_->address();
  const std::string path = address.substr(address.find("/?token="));
  EXPECT_EQ(path.size(), std::string("/?token=").size() + 32);
  EXPECT_EQ(client().get(path).status, 303);
}

TEST_F(WebPageWithToken, NothingIsSeenAndNoButtonWorksWithoutIt) {
  for (const char* const path : {"/", "/events", "/metrics", "/nothing"}) {
    EXPECT_EQ(client().get(path).status, 401) << path;
  }
  EXPECT_EQ(client().post("/reset").status, 401);
  EXPECT_EQ(requests_.pop(), std::nullopt);
  const auto first = client().get("/?token=0123456789abcdef");
  EXPECT_EQ(first.status, 303);
  EXPECT_EQ(first.header("Location"), "/");
  const std::string set = first.header("Set-Cookie");
  const testing::Client::Headers cookie{{"Cookie", set.substr(0, set.find(';'))}};
  EXPECT_EQ(client().get("/", cookie).status, 200);
  EXPECT_EQ(client().post("/save", cookie).status, 202);
  EXPECT_EQ(client().get("/metrics", {{"Authorization", "Bearer 0123456789abcdef"}}).status, 200);
}

}  // namespace
}  // namespace kelpie::server_test
