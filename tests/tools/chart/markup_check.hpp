// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie {

/// An element of a page, in the order of their opening tags.
struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  ///< between its opening tag and the next tag

  std::string operator[](const std::string& attribute) const {
    const auto found = attributes.find(attribute);
    return found == attributes.end() ? "" : found->second;
  }
};

/// A page taken apart. `fault` is empty when tags nest, attributes are quoted, and no '<' or '&'
/// stands bare; else it says what is wrong.
struct Markup {
  std::vector<Element> elements;
  std::string fault;
};

inline bool has_bare_ampersand(std::string_view text) {
  constexpr std::array<std::string_view, 5> kEntities = {"&amp;", "&lt;", "&gt;", "&quot;",
                                                         "&#39;"};
  for (std::size_t at = text.find('&'); at != std::string_view::npos; at = text.find('&', at + 1)) {
    if (std::none_of(kEntities.begin(), kEntities.end(), [&](std::string_view entity) {
          return text.substr(at).starts_with(entity);
        })) {
      return true;
    }
  }
  return false;
}

/// `name a="..." b="..."` as an element; false when it isn't of that form.
inline bool read_tag(std::string_view tag, Element& element) {
  const std::size_t end = std::min(tag.find(' '), tag.size());
  element.name = tag.substr(0, end);
  for (tag.remove_prefix(end); !tag.empty();) {
    const std::size_t equals = tag.find("=\"");
    const std::size_t quote = tag.find('"', std::min(equals, tag.size() - 2) + 2);
    if (tag.front() != ' ' || equals == std::string_view::npos || quote == std::string_view::npos) {
      return false;
    }
    const std::string_view value = tag.substr(equals + 2, quote - equals - 2);
    element.attributes[std::string(tag.substr(1, equals - 1))] = value;
    tag.remove_prefix(quote + 1);
  }
  return !element.name.empty() && element.name.find_first_not_of(
                                      "abcdefghijklmnopqrstuvwxyz0123456789") == std::string::npos;
}

/// The page as markup alone: without what is in its style sheets and programs, which are no markup.
/// Figures' descriptions stay.
inline std::string without_programs(std::string page) {
  for (const std::string tag : {"<style>", "<script>"}) {
    const std::string end = "</" + tag.substr(1);
    for (std::size_t at = page.find(tag); at != std::string::npos; at = page.find(tag, at + 1)) {
      const std::size_t first = at + tag.size();
      page.erase(first, std::min(page.find(end, first), page.size()) - first);
    }
  }
  return page;
}

inline Markup take_apart(std::string_view whole) {
  const std::string kept = without_programs(std::string(whole));
  std::string_view page = kept;
  Markup markup;
  std::vector<std::string> open;
  while (!page.empty()) {
    const std::size_t end = page.find('>');
    if (page.front() != '<' || end == std::string_view::npos) {
      return {{}, "not a tag: " + std::string(page.substr(0, 60))};
    }
    std::string_view tag = page.substr(1, end - 1);
    const std::size_t next = std::min(page.find('<', 1), page.size());
    const std::string_view text = next > end ? page.substr(end + 1, next - end - 1) : "";
    Element element{"", {}, std::string(text)};
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1)) {
        return {{}, "closes what isn't open: " + std::string(tag)};
      }
      open.pop_back();
    } else if (tag != "!DOCTYPE html") {
      const bool closed = tag.ends_with('/');
      tag.remove_suffix(closed ? 1 : 0);
      if (next <= end || !read_tag(tag, element) || has_bare_ampersand(tag)) {
        return {{}, "broken tag: " + std::string(tag.substr(0, 60))};
      }
      if (!closed) {
        open.push_back(element.name);
      }
      markup.elements.push_back(element);
    }
    if (has_bare_ampersand(text) || text.find('>') != std::string_view::npos) {
      return {{}, "not escaped: " + std::string(text.substr(0, 60))};
    }
    page.remove_prefix(next);
  }
  markup.fault = open.empty() ? "" : "left open: " + open.back();
  return markup;
}

/// Elements of one class, or whose class starts with it and a blank.
inline std::vector<Element> of_class(const std::string& page, const std::string& name) {
  std::vector<Element> found;
  for (const Element& element : take_apart(page).elements) {
    if (element["class"] == name || element["class"].starts_with(name + " ")) {
      found.push_back(element);
    }
  }
  return found;
}

/// How often `part` occurs in `text`.
inline std::size_t occurrences(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos;
       at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

}  // namespace kelpie
