// SPDX-License-Identifier: Apache-2.0
// A plug-in of another version than any.
extern "C" __attribute__((visibility("default"))) void* kelpie_open_rank_group(
    const char* /*version*/, const char** own) {
  *own = "0.0.9";
  return nullptr;
}
