// SPDX-License-Identifier: Apache-2.0
#include "web/page.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "chart/page.hpp"
#include "chart/page_assets.hpp"
#include "web/listener.hpp"
#include "web/tuning.hpp"

namespace kelpie::web {
namespace {

constexpr const char* kField = "live.page";

std::size_t rows_kept(double rate_hz) {
  return static_cast<std::size_t>(
      std::clamp(kTuning.window_s * rate_hz, 1.0, kTuning.most_samples));
}

std::string token_for(const live::LiveSettings& settings, const std::string& host) {
  return !settings.token.empty() || is_loopback(host, kField) ? settings.token : new_token();
}

// Each part that the script fills in has a place from the start: nothing moves later.
std::string page_html(const live::Configuration& configuration) {
  const std::string vehicle = std::filesystem::path(configuration.file).stem().string();
  return chart::live_page(
      "kelpie live: " + vehicle,
      R"(<div id="live"><p class="over">kelpie live · <span id="source">…</span></p>
)" + chart::heading(1, vehicle) +
          R"(<div id="alarm" role="alert" hidden=""></div>
<p class="lead" id="state" role="status">Connecting …</p>
<div class="columns"><div id="good"></div><div id="velocities"></div><div id="thrusters"></div></div>
<p class="buttons"><button type="button" id="save">Save</button>
<button type="button" id="freeze">Freeze learning</button>
<button type="button" id="reset">Reset …</button></p>
<dialog id="ask" aria-labelledby="question"><p id="question">Forget the model and begin anew? What
was learned stays in the checkpoint before, until the next one is written.</p>
<p class="buttons"><button type="button" id="no" autofocus>Keep it</button>
<button type="button" id="yes">Begin anew</button></p></dialog>
<section aria-label="curves"><div id="curves"></div></section>
<section id="known" hidden=""><h2>Parameters</h2><p id="countdown"></p>
<div id="parameters"></div></section>
<section><h2>What happened</h2><ol id="said" role="log" aria-live="polite"
aria-label="What happened" tabindex="0"></ol></section>
<section><h2>Signals</h2><div id="signals"></div></section>
<details class="section"><summary>Learners</summary><div id="learners"></div></details>
<details class="section"><summary>Coefficients</summary><div id="coefficients"></div></details>
<details class="section"><summary>Times and counts</summary><div id="facts"></div></details>
</div>
)",
      chart::kLiveScript);
}

}  // namespace

Page::Page(const live::Configuration& configuration, live::Requests& requests)
    : endpoint_(live::parse_endpoint(configuration.live.page, kField)),
      access_(token_for(configuration.live, endpoint_.host), endpoint_.port),
      feed_(configuration.plan.targets.size(), rows_kept(configuration.plan.rate_hz)),
      server_(endpoint_, kField,
              {.configuration = configuration,
               .feed = feed_,
               .requests = requests,
               .access = access_,
               .page = page_html(configuration)}) {}

std::string Page::address() const {
  std::string host = endpoint_.host;
  if (host == "0.0.0.0" || host == "::") {
    std::array<char, 256> name{};
    if (::gethostname(name.data(), name.size() - 1) == 0) {
      host = name.data();
    }
  } else if (host.find(':') != std::string::npos) {
    host = "[" + host + "]";
  }
  return fmt::format("http://{}:{}/{}{}", host, endpoint_.port,
                     access_.token().empty() ? "" : "?token=", access_.token());
}

}  // namespace kelpie::web
