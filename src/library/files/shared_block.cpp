// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "files/model_block.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/model/shared_model.hpp"

namespace kelpie {

// In this room, because the room `model` knows no formats.
void SharedModel::serve(std::span<std::byte> block, std::span<const std::string> inputs,
                        std::span<const std::string> targets, const Alignment& alignment) {
  renew_block_ = nullptr;
  if (block.empty()) {
    return;
  }
  require_size("inputs", inputs.size(), model_.inputs());
  require_size("targets", targets.size(), model_.axes());
  const BlockLayout needed =
      BlockLayout::of(inputs, targets, *terms_, snapshots(0), ModelBlock::assesses(block));
  renew_block_ = [words = ModelBlock(block, needed),
                  names = std::vector<std::string>(inputs.begin(), inputs.end()),
                  alignment](std::span<const Snapshot> axes) mutable {
    words.publish(names, axes, alignment);
  };
  if (const std::ptrdiff_t latest = latest_.load(); latest >= 0) {
    renew_block_(snapshots(static_cast<std::size_t>(latest)));
  }
}

}  // namespace kelpie
