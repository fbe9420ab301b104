// SPDX-License-Identifier: Apache-2.0
#include "cli/options.hpp"

namespace kelpie::cli {

CLI::Option* add_file(CLI::App* command, const std::string& name, std::string& file,
                      const std::string& meaning) {
  return command->add_option(name, file, meaning)->type_name("FILE");
}

void add_files(CLI::App* command, const std::string& name, Words& files,
               const std::string& meaning) {
  command->add_option(name, files, meaning)->type_name("FILE");
}

void add_folder(CLI::App* command, const std::string& name, std::string& folder,
                const std::string& meaning) {
  command->add_option(name, folder, meaning)->type_name("FOLDER");
}

void add_out(CLI::App* command, std::string& folder, const std::string& meaning) {
  command->add_option("--out", folder, meaning)->capture_default_str()->type_name("FOLDER");
}

CLI::Option* add_list(CLI::App* command, const std::string& name, Words& words,
                      const std::string& meaning) {
  return command->add_option(name, words, meaning)->delimiter(',');
}

void add_set(CLI::App* command, Words& set, const std::string& meaning) {
  command->add_option("--set", set, meaning)->type_name("SETTING");
}

void add_seed(CLI::App* command, std::uint64_t& seed, const std::string& meaning) {
  command->add_option("--seed", seed, meaning)->capture_default_str();
}

void add_threads(CLI::App* command, std::size_t& threads) {
  command->add_option("--threads", threads, "0: one per core")->capture_default_str();
}

}  // namespace kelpie::cli
