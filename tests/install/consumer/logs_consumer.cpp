// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "bag/open_bag.hpp"

// Opening a bag needs every library that kelpie::logs links.
int main(int argc, char** argv) {
  const auto bag = kelpie::bag::open_bag(argc > 1 ? argv[1] : "");
  kelpie::bag::Message message;
  int messages = 0;
  while (bag->next(message)) {
    ++messages;
  }
  std::printf("%d messages\n", messages);
}
