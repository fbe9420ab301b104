// SPDX-License-Identifier: Apache-2.0
// A model.json and inputs, in: predictions out. Needs the library alone.
#include <kelpie/core/error.hpp>
#include <kelpie/model/trained_model.hpp>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

int main(int argc, char** argv) try {
  std::ostringstream text;
  text << std::ifstream(argc > 1 ? argv[1] : "").rdbuf();
  const kelpie::TrainedModel model = kelpie::read_trained_model(text.str(), argv[1]);
  std::vector<double> x;
  for (int i = 2; i < argc; ++i) {
    x.push_back(std::strtod(argv[i], nullptr));
  }
  const std::vector<std::string> names = model.target_names();
  std::vector<double> y(names.size());
  model.predict(x, y);
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::printf("%s %.17g\n", names[i].c_str(), y[i]);
  }
} catch (const kelpie::InputError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
