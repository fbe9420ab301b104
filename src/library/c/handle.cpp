// SPDX-License-Identifier: Apache-2.0
#include "c/handle.hpp"

#include <cstdint>
#include <utility>

#include "core/text.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr const char* kSavedFormat = "kelpie model of version " KELPIE_VERSION;

ModelSettings settings_of(std::string_view text, std::size_t targets) {
  std::vector<std::pair<std::string, std::string>> values;
  std::string preset = "default";
  for (const std::string& line : split_text(text, '\n')) {
    const std::size_t equals = line.find('=');
    if (line.empty()) {
      continue;
    }
    require(equals != std::string::npos, "settings", "'" + line + "' is no line 'name = value'");
    const std::string name(trimmed(std::string_view(line).substr(0, equals)));
    const std::string value(trimmed(std::string_view(line).substr(equals + 1)));
    if (name == "preset") {
      preset = value;
    } else {
      values.emplace_back(name, value);
    }
  }
  ModelSettings settings = ModelSettings::from_preset(preset, targets);
  for (const auto& [name, value] : values) {
    settings.assign(name, value);
  }
  return settings;
}

// FNV-1a: finds what storage and transfers do to bytes; forgery it doesn't.
std::uint32_t checksum_of(std::string_view bytes) {
  std::uint32_t sum = 2166136261U;
  for (const char byte : bytes) {
    sum = (sum ^ static_cast<unsigned char>(byte)) * 16777619U;
  }
  return sum;
}

// What stands before the state of a saved model: all that a model is made of.
struct SavedFront {
  std::vector<std::string> inputs{};
  std::vector<std::string> targets{};
  std::string settings{};
  std::size_t state_bytes = 0;
  std::uint32_t checksum = 0;

  void visit(Archive& archive) {
    archive.same("version", kSavedFormat);
    const auto name = [&](std::string& text) { archive.text(text); };
    archive.list(inputs, KELPIE_MOST_INPUTS, name);
    archive.list(targets, KELPIE_MOST_TARGETS, name);
    archive.text(settings);
    archive.whole(state_bytes);
    archive.whole(checksum, 0, 0xFFFFFFFFU);
  }

  std::string bytes() const {
    SavedFront copy = *this;
    Archive archive;
    copy.visit(archive);
    return archive.bytes();
  }
};

}  // namespace

std::unique_ptr<kelpie_model> made(std::vector<std::string> inputs,
                                   std::vector<std::string> targets, std::string_view text) {
  const ModelSettings settings = settings_of(text, targets.size());
  std::string all;
  for (const auto& [name, value] : settings.values()) {
    all += name + " = " + value + "\n";
  }
  auto model = std::make_unique<DynamicsModel>(inputs, targets, settings);
  return std::make_unique<kelpie_model>(kelpie_model{.inputs = std::move(inputs),
                                                     .targets = std::move(targets),
                                                     .settings = std::move(all),
                                                     .own = std::move(model)});
}

std::string saved(const kelpie_model& from) {
  const std::string state = from.model().save();
  const SavedFront front{from.inputs, from.targets, from.settings, state.size(),
                         checksum_of(state)};
  return front.bytes() + state;
}

std::unique_ptr<kelpie_model> loaded(std::string_view bytes) {
  SavedFront front;
  Archive archive(bytes);
  front.visit(archive);
  const std::string_view state = bytes.substr(front.bytes().size());
  require(state.size() == front.state_bytes, "bytes",
          std::to_string(state.size()) + " of the state; there have to be " +
              std::to_string(front.state_bytes));
  require(checksum_of(state) == front.checksum, "bytes", "are damaged: their checksum doesn't fit");
  auto model = made(std::move(front.inputs), std::move(front.targets), front.settings);
  *model->own = DynamicsModel::resume(std::move(*model->own), state);
  return model;
}

}  // namespace kelpie
