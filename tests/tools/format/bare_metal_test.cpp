// SPDX-License-Identifier: Apache-2.0
// The exported file on a processor without an operating system: a Cortex-M4, which has single
// precision only. A double by mistake would be slow, and is refused here.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "format/c_text.hpp"
#include "format/model_c.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/random_model.hpp"
#include "model/snapshot.hpp"
#include "support.hpp"

namespace kelpie::bare_metal_test {
namespace {

using testing::ModelShape;
using testing::random_model;
using testing::TemporaryFolder;

const std::string kCompile =
    "arm-none-eabi-gcc -std=gnu99 -Wall -Wextra -Werror -Wdouble-promotion -mthumb "
    "-mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16 -O2 ";

bool runs(const std::string& command) {
  return std::system(command.c_str()) == 0;  // NOLINT: the command is the test's own
}

class BareMetal : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!runs("arm-none-eabi-gcc --version >/dev/null 2>&1")) {
      GTEST_SKIP() << "wants gcc-arm-none-eabi and libnewlib-arm-none-eabi";
    }
    options_.single = options_.assess = true;
    std::ofstream(folder_ / "model.c") << format::model_c(model_, options_);
    std::ofstream(folder_ / "model.h") << format::model_h(model_, options_);
  }

  std::string in_folder(const std::string& command) const {
    return "cd " + folder_.path().string() + " && " + command;
  }

  // The numbers of one line of `size`: text, data, bss.
  std::vector<int> sizes_of(const std::string& file) const {
    EXPECT_TRUE(runs(in_folder("arm-none-eabi-size " + file + " | tail -n 1 >size.txt")));
    std::vector<int> sizes(3);
    std::ifstream stream(folder_ / "size.txt");
    stream >> sizes[0] >> sizes[1] >> sizes[2];
    return sizes;
  }

  static TrainedModel model() {
    RandomStream random(7, "bare metal");
    ModelShape shape;
    shape.samples = 200;
    TrainedModel model = random_model(random, shape);
    for (TrainedModel::Axis& axis : model.axes) {
      axis.half_width = 0.25;
      axis.known = testing::random_places(random, 3, 100);
    }
    return model;
  }

  const TemporaryFolder folder_;
  const TrainedModel model_ = model();
  format::CodeOptions options_;
};

TEST_F(BareMetal, ItTakesWhatIsToldOfFlashAndNoMemory) {
  ASSERT_TRUE(runs(in_folder(kCompile + "-pedantic -c model.c")));
  const std::vector<int> sizes = sizes_of("model.o");
  const auto tables = static_cast<int>(format::table_bytes(model_, options_));
  EXPECT_GE(sizes[0], tables);
  EXPECT_LT(sizes[0], tables + 8000);
  EXPECT_EQ(sizes[1], 0);
  EXPECT_EQ(sizes[2], 0);
}

TEST_F(BareMetal, ThereItSaysWhatTheModelSays) {
  if (!runs("qemu-system-arm --version >/dev/null 2>&1")) {
    GTEST_SKIP() << "wants qemu-system-arm";
  }
  const std::vector<std::vector<double>> inputs{
      {0.0, 0.0, 0.0}, {0.5, -0.25, 1.0}, {-1.5, 0.75, 0.125}, {40.0, 40.0, 40.0}};
  const format::CText text(true);
  std::string rows;
  for (const std::vector<double>& x : inputs) {
    rows += text.list(x) + ",";
  }
  std::ofstream(folder_ / "inputs.h") << "static const float inputs[][3] = {" << rows << "};\n";
  const std::string sources = std::string(KELPIE_SOURCE_DIR) + "/tests/tools/format/bare_metal/";
  ASSERT_TRUE(runs(in_folder(kCompile + "-nostartfiles --specs=nosys.specs -I. -T " + sources +
                             "flash.ld " + sources + "caller.c model.c -lm -o model.elf")));
  ASSERT_TRUE(
      runs(in_folder("timeout 60 qemu-system-arm -M mps2-an386 -display none -monitor none "
                     "-serial none -semihosting-config enable=on,target=native "
                     "-kernel model.elf >said.txt 2>&1")));
  std::ifstream said(folder_ / "said.txt");
  const auto next = [&said] {
    std::uint32_t bits = 0;
    said >> std::hex >> bits;
    return static_cast<double>(std::bit_cast<float>(bits));
  };
  std::vector<Prediction> expected(model_.axes.size());
  for (const std::vector<double>& x : inputs) {
    model_.predict(x, expected);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const double scale = std::abs(expected[k].value) + model_.axes[k].scaling.target.scale;
      EXPECT_NEAR(next(), expected[k].value, 1e-4 * scale);
      EXPECT_NEAR(next(), expected[k].upper - expected[k].value, 1e-4 * scale);
      EXPECT_NEAR(next(), expected[k].novelty, 0.02);
    }
  }
  std::uint32_t stack = 0;
  said >> std::hex >> stack;
  EXPECT_GT(stack, 0U);
  EXPECT_LT(stack, 2048U);
  const std::vector<int> sizes = sizes_of("model.elf");
  std::cout << "Cortex-M4: flash " << sizes[0] << " bytes, " << stack << " bytes of stack\n";
  EXPECT_LT(sizes[0], static_cast<int>(format::table_bytes(model_, options_)) + 32000);
}

}  // namespace
}  // namespace kelpie::bare_metal_test
