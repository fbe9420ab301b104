// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

namespace kelpie {

/// "" when tags nest, attributes are quoted and no '<' or '&' stands bare; else what is wrong.
/// Style sheets and the document type are passed over.
inline std::string markup_fault(const std::string& text) {
  static const std::regex tag(R"re(^<(/?)([a-z][a-z0-9]*)((?: [a-zA-Z:-]+="[^"<]*")*)(/?)>)re");
  static const std::regex entity(R"(^&(amp|lt|gt|quot|#39);)");
  std::vector<std::string> open;
  for (std::size_t i = 0; i < text.size(); ++i) {
    // A tag with a long path is matched on its own characters only.
    const std::size_t end = std::min(text.find('>', i), text.size() - 1) + 1;
    if (text.compare(i, 10, "<!DOCTYPE ") == 0) {
      i = end - 1;
    } else if (text[i] == '&') {
      if (!std::regex_search(text.substr(i, 8), entity)) {
        return "bare & at: " + text.substr(i, 60);
      }
    } else if (text[i] == '<') {
      std::string one = text.substr(i, end - i);
      // std::regex recurses per character: a path of thousands would overflow its stack.
      if (const std::size_t d = one.find(" d=\""); d != std::string::npos) {
        one.erase(d, one.find('"', d + 4) + 1 - d);
      }
      std::smatch parts;
      if (!std::regex_search(one, parts, tag)) {
        return "not a tag: " + one.substr(0, 60);
      }
      if (parts[1].length() > 0) {
        if (open.empty() || open.back() != parts[2]) {
          return "closes what isn't open: " + one;
        }
        open.pop_back();
      } else if (parts[4].length() == 0) {
        open.push_back(parts[2]);
      }
      i = end - 1;
    }
  }
  return open.empty() ? "" : "left open: " + open.back();
}

/// Values of all attributes called `name`.
inline std::vector<std::string> attributes(const std::string& text, const std::string& name) {
  const std::string start = " " + name + "=\"";
  std::vector<std::string> values;
  for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at + 1)) {
    const std::size_t first = at + start.size();
    values.push_back(text.substr(first, text.find('"', first) - first));
  }
  return values;
}

/// How often `part` occurs in `text`.
inline std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

}  // namespace kelpie
