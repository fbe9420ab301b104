// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::file {

/// A value in a configuration file, with its place for messages. What isn't of the kind asked for
/// is an InputError (file, line, key).
struct TomlNode {
  const std::string& file;
  std::string key;
  const toml::node& node;

  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError({.file = file, .line = node.source().begin.line, .field = key}, message);
  }

  std::string text(const std::string& kind = "a text") const {
    if (!node.is_string()) {
      refuse("has to be " + kind);
    }
    return node.as_string()->get();
  }

  double number(const std::string& kind = "a number") const {
    if (!node.is_number()) {
      refuse("has to be " + kind);
    }
    return node.value_or(0.0);
  }

  std::vector<std::string> texts(const std::string& kind = "a list of column names") const {
    const auto* const list = node.as_array();
    if (list == nullptr || !list->is_homogeneous<std::string>()) {
      refuse("has to be " + kind);
    }
    std::vector<std::string> texts;
    for (const toml::node& item : *list) {
      texts.push_back(item.as_string()->get());
    }
    return texts;
  }

  const toml::table& table(const std::string& kind) const {
    if (!node.is_table()) {
      refuse("has to be " + kind);
    }
    return *node.as_table();
  }

  TomlNode child(const std::string& name, const toml::node& value) const {
    return {file, key + "." + name, value};
  }
};

}  // namespace kelpie::file
